// shape_trial: one trial of shape identification: a finger on its arm, wearing a 1-DOF contact location display, feels a solid that stands still,
// through the tick of tasks/run/tick/tick.h; at the end the participant names it.
//
//   s = r a,  a the fore-aft angle of the contact on the finger, |s| <= reach        place of the roller; left-right isn't shown
//
// The finger waits a second above the solid, then a tone; time and contact are counted from the first touch to the answer. The arm's base frame D
// has x right, y up and z towards the operator (W: x right, y away, z up); the solid's middle is W's origin, the finger points away (+y).
#pragma once
#include "pincer/devices/arm/sim_arm.h"
#include "pincer/devices/cld/sim_one_dof_cld.h"
#include "pincer/tasks/lab/experiments/study.h"
#include "pincer/tasks/lab/participants/shape_explorer.h"
#include "pincer/tasks/run/servo/servo.h"
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
  double timeout = 120;         // [s]
  std::int64_t trial = 0;
  std::uint64_t seed = 0;
  int stride = 50;  // every stride-th tick is recorded
};

// The roller's command for a place on the pad (devices/cld/tactile_display.h) of a finger of radius `r` [m].
devices::TactileCommand onRoller(const devices::TactileCommand& command, double r, double reach);

class ShapeTrial final : public ServoCycle {
 public:
  ShapeTrial(const ShapeTrialSetup& setup, ShapeExplorer& explorer, StudySink& sink);

  bool tick(double now) override;
  void cutForces() noexcept override { cut_ = true; }

  // Once the servo has returned.
  bool answered() const { return answered_; }
  const devices::GateLimits& gate() const { return model_.mounts[0].gate; }
  void measure(ResponseRecord& response) const;

 private:
  enum class Stage : std::uint8_t { kPrepare, kFeel, kAnswer, kOver };
  void advance(const ShapeAction& action, double now);
  void count(double dt);
  void record(double now, double took, std::uint32_t status);

  ShapeTrialSetup setup_;
  ShapeExplorer& explorer_;
  StudySink& sink_;
  TickModel model_;
  TickState state_;
  TickScratch scratch_;
  devices::SimArm arm_;
  devices::SimOneDofCld display_;
  std::vector<FingerInputs> inputs_;
  Stage stage_ = Stage::kPrepare;
  Cue cue_ = Cue::kNone;
  bool answered_ = false, has_touched_ = false;
  double now_ = 0, entered_ = 0;                                                // [s]
  double shown_time_ = 0, contact_time_ = 0, answered_after_ = 0;               // [s]
  double finger_way_ = 0, finger_time_ = 0, tactor_way_ = 0, tactor_time_ = 0;  // [m], [s]
  std::optional<double> tactor_mark_;                                           // its place some ticks ago [m]
  std::int64_t ticks_ = 0;
  const char* outcome_ = "interrupted";
  std::atomic<bool> cut_{false};
};

}  // namespace pincer::tasks
