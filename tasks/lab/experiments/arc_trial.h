// arc_trial: one trial of an experiment in the plane (tasks/lab/finger/finger_trial.h): a finger
// strokes one curve or two, one after the other.
//
// The set-up: an arm whose base frame D has x right, y up and z towards the operator (W: x right, y away, z up), the
// finger pointing away with its pad down, strokes along it (fore-aft), a 1-DOF contact location display whose roller
// moves distally for contacts on the distal side.
#pragma once
#include <optional>
#include <vector>

#include "pincer/contact/shape.h"
#include "pincer/tasks/lab/finger/finger_trial.h"
#include "pincer/tasks/run/tick/planar_tick.h"

namespace pincer::tasks {

// A solid that looks like what a curve stands for.
struct ArcPicture {
  contact::Shape shape = contact::Cylinder{0.1, 0.03};
  Pose X_WB;
};

struct ArcInterval {
  PlanarStimulus shown;
  devices::VirtualTransmission transmission;
  ArcPicture picture = {};
};

struct ArcTrialSetup {
  double finger_radius = 0.02;  // [m]
  double path_radius = 0.12;    // of the circle about B's origin on which the fingertip's centre goes [m]
  double start_angle = -0.4;    // where on it the finger waits, from +z towards +y [rad]
  double stiffness = 1000;      // of the surface [N/m]
  // Of the tactor's travel from the side where a sweep began; there it freezes
  // until the finger is over 10 mm up. 1: never.
  double freeze_share = 1;
  std::vector<ArcInterval> intervals;  // one or two
  FingerTrialSetup asked;              // but for how many intervals
};

// Base of the arm whose fingertip, at the arm's reset place, is on top of the path.
Pose arcArmBase(double path_radius);
FingerPlace arcPlace(const ArcTrialSetup& setup);

class ArcTrial final : public FingerTrial {
 public:
  // `finger` wears arcPlace(setup); it and `sink` outlive the trial.
  ArcTrial(const ArcTrialSetup& setup, WornFinger& finger, StudySink& sink);

  const grasp::GraspModel& pictured() override;
  void fill(Snapshot& snapshot) const override;

 private:
  FingerOutputs step(const FingerInputs& inputs, double now, double dt) override;
  Felt felt() const override;
  void startInterval(int interval) override;
  const devices::GateLimits& gateLimits() const override { return model_.gate; }
  devices::GateState& gate() override { return state_.gate; }
  void fill(SampleRecord& sample) const override;
  void freezeFrontEnd();
  const ArcInterval& shown() const { return setup_.intervals[static_cast<std::size_t>(interval())]; }
  Vec3 proxy_W() const;

  ArcTrialSetup setup_;
  PlanarTickModel model_;
  PlanarTickState state_;
  PlanarTickOutput out_;
  int side_ = 0;         // where the sweep began: -1, +1; 0: the finger is up
  bool frozen_ = false;  // the tactor, of a front end
  std::optional<grasp::GraspModel> picture_;
};

}  // namespace pincer::tasks
