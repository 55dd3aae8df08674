// arc_trial: one trial of an experiment in the plane: a finger strokes one curve or two, one after the other, and somebody answers. The same
// code for simulated and real devices would be called by whoever owns the clock; here the devices are simulated and the cycle moves them.
//
//   prepare   the gate ramps up
//   interval  tone, strokes, reading; then the next
//   answer
//
// The set-up: an arm whose base frame D has x right, y up and z towards the operator (W: x right, y away, z up), the finger pointing away with its
// pad down, strokes along it (fore-aft), a 1-DOF contact location display whose roller moves distally for contacts on the distal side.
#pragma once
#include <optional>
#include <vector>

#include "pincer/devices/arm/sim_arm.h"
#include "pincer/devices/cld/sim_one_dof_cld.h"
#include "pincer/tasks/lab/experiments/study.h"
#include "pincer/tasks/lab/participants/one_finger.h"
#include "pincer/tasks/run/servo/servo.h"
#include "pincer/tasks/run/tick/planar_tick.h"

namespace pincer::tasks {

struct ArcInterval {
  PlanarStimulus shown;
  devices::VirtualTransmission transmission;
};

struct ArcTrialSetup {
  double finger_radius = 0.02;  // [m]
  double path_radius = 0.12;    // of the circle about B's origin on which the fingertip's centre goes [m]
  double start_angle = -0.4;    // where on it the finger waits, from +z towards +y [rad]
  double stiffness = 1000;      // of the surface [N/m]
  double timeout = 120;         // of a trial [s]
  // Of the tactor's travel from the side where a sweep began; there it freezes until the finger is over 10 mm up. 1: never.
  double freeze_share = 1;
  std::vector<ArcInterval> intervals;  // one or two
  std::int64_t trial = 0;
  int stride = 50;  // every stride-th tick is recorded
};

// Base of the arm whose fingertip, at the arm's reset place, is on top of the path.
Pose arcArmBase(double path_radius);

class ArcTrial final : public ServoCycle {
 public:
  // `observer` has begun, and outlives the trial.
  ArcTrial(const ArcTrialSetup& setup, OneFingerObserver& observer, StudySink& sink);

  bool tick(double now) override;
  void cutForces() noexcept override { cut_ = true; }

  // Once the servo has returned.
  bool answered() const { return answered_; }  // false after a fault or a time-out
  // The tactor's true place wherever Enter was pressed [m of arc].
  const std::vector<double>& enteredPlaces() const { return entered_places_; }
  // Outcome, duration, response time, share of contact and speeds.
  void measure(ResponseRecord& response) const;

 private:
  enum class Stage : std::uint8_t { kPrepare, kPause, kInterval, kAnswer, kOver };

  void advance(const OneFingerAction& action, double now);
  void freezeFrontEnd();
  void count(const devices::TactileSample& tactile, double dt);
  void record(const devices::TactileSample& tactile, double now, double took);
  void end(const char* outcome);
  const ArcInterval& interval() const { return setup_.intervals[static_cast<std::size_t>(shown_)]; }

  ArcTrialSetup setup_;
  OneFingerObserver& observer_;
  StudySink& sink_;
  PlanarTickModel model_;
  PlanarTickState state_;
  PlanarTickOutput out_;
  devices::SimArm arm_;
  devices::SimOneDofCld display_;
  Stage stage_ = Stage::kPrepare;
  Cue cue_ = Cue::kNone;
  int shown_ = 0;
  bool answered_ = false;
  double now_ = 0, entered_ = 0;              // [s]
  double shown_time_ = 0, contact_time_ = 0;  // [s]
  double answered_after_ = 0;                 // [s]
  double finger_way_ = 0, finger_time_ = 0;   // while it touched and moved [m], [s]
  double tactor_way_ = 0, tactor_time_ = 0;   // while it moved [m], [s]
  std::optional<double> tactor_mark_;         // its place some ticks ago [m]
  std::int64_t ticks_ = 0;
  int side_ = 0;                        // where the sweep began: -1, +1; 0: the finger is up
  bool frozen_ = false;                 // the tactor, of a front end
  std::vector<double> entered_places_;  // room for one per interval
  const char* outcome_ = "interrupted";
  std::atomic<bool> cut_{false};
};

}  // namespace pincer::tasks
