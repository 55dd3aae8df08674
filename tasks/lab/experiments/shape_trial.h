// shape_trial: one trial of shape identification (tasks/lab/finger/finger_trial.h): a finger on its arm,
// wearing a 1-DOF contact location display, feels a solid that stands still, through the tick of
// tasks/run/tick/tick.h; at the end it is named.
//
//   s = r a,  a the fore-aft angle of the contact on the finger, |s| <= reach
//             place of the roller; left-right isn't shown
//
// The finger waits a second above the solid, then a tone; time and contact are counted from the first touch to the
// answer. The arm's base frame D has x right, y up and z towards the operator (W: x right, y away, z up); the solid's
// middle is W's origin, the finger points away (+y).
#pragma once
#include "pincer/tasks/lab/finger/finger_trial.h"
#include "pincer/tasks/lab/participants/shape_explorer.h"
#include "pincer/tasks/run/tick/tick.h"

namespace pincer::tasks {

struct ShapeTrialSetup {
  std::shared_ptr<const contact::SmoothMesh> solid;
  bool display_tactile = true;  // false: the tactor is parked
  double friction = 0.1;        // of the solid [-]
  double finger_radius = 0.02;  // [m]
  double tactor_reach = 8e-3;   // either way [m]
  double stiffness = 1000;      // of the coupling [N/m]
  double damping = 2;           // [N s/m]
  FingerTrialSetup asked = {.wait = 1, .counts_from_touch = true, .question = TrialQuestion::kName, .choices = kSolids};
};

// The roller's command for a place on the pad (devices/cld/tactile_display.h) of a finger of radius `r` [m].
devices::TactileCommand onRoller(const devices::TactileCommand& command, double r, double reach);

FingerPlace shapePlace(const ShapeTrialSetup& setup);
// Facts that a participant is told of the trial.
ShapeCues shapeCues(const ShapeTrialSetup& setup, std::uint64_t seed);

class ShapeTrial final : public FingerTrial {
 public:
  // `finger` wears shapePlace(setup); it and `sink` outlive the trial.
  ShapeTrial(const ShapeTrialSetup& setup, WornFinger& finger, StudySink& sink);

  const grasp::GraspModel& pictured() override { return model_.grasp; }
  void fill(Snapshot& snapshot) const override;
  const devices::GateLimits& gateLimits() const override { return model_.mounts[0].gate; }

 private:
  FingerOutputs step(const FingerInputs& inputs, double now, double dt) override;
  Felt felt() const override;
  void startInterval(int) override {}
  devices::GateState& gate() override { return state_.mounts[0].gate; }
  void fill(SampleRecord& sample) const override;

  double finger_radius_, tactor_reach_;  // [m]
  TickModel model_;
  TickState state_;
  TickScratch scratch_;
  std::vector<FingerInputs> samples_;
  std::uint32_t status_ = 0;
};

}  // namespace pincer::tasks
