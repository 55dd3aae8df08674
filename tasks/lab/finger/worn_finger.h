// worn_finger: whoever wears the one finger of a trial, and the devices on it: a simulated participant, a person on a
// mouse or on real devices, a recording of one.
#pragma once
#include "pincer/devices/cld/virtual_transmission.h"
#include "pincer/tasks/lab/participants/one_finger.h"
#include "pincer/tasks/run/servo/device_calibration.h"
#include "pincer/tasks/run/tick/tick.h"

namespace pincer::tasks {

// Where a trial puts the arm, and the finger that waits on it.
struct FingerPlace {
  Pose X_WD;                      // of the arm's base
  Vec3 start_W = Vec3::Zero();    // of the fingertip [m]
  double finger_radius = 0.02;    // [m]
  std::optional<Quat> q_WF = {};  // how the finger is held, of a trial that asks; absent: the arm needn't tell
};

// All that a trial has to know of them before its first tick.
struct FingerWear {
  devices::ArmCapabilities arm;
  ArmBase base;                           // how far the arm stands off its place
  std::optional<double> oldest_sample{};  // that is still trusted [s]
  bool has_motors = false;                // somebody feels them: the finger is kept passive
  bool is_person = false;                 // answers by keys, and takes any time
  bool draws_touch = false;               // a drawn pad stands in for touch: the finger is on a mouse
};

// A tick of it.
struct FingerDeed {
  OneFingerAction action;  // of a simulated participant
  int key = 0;             // that a person pressed: its character, or devices::Key; 0: none
};

class WornFinger {
 public:
  virtual ~WornFinger() = default;
  virtual const FingerWear& wear() const = 0;
  // Moves what has no clock of its own to `now` [s]; time never goes back.
  virtual void advanceTo(double now) = 0;
  // The tick's time [s], which the servo says is `now`: another one where it was recorded.
  virtual double time(double now) const { return now; }
  // Why the forces were cut from outside before this tick; kNone: they weren't.
  virtual devices::Trip cut() const { return devices::Trip::kNone; }
  virtual const FingerInputs& sample() = 0;
  // Commands of this tick to the devices, its tone to whoever wears them; and what is done then.
  virtual FingerDeed apply(const FingerOutputs& outputs, Cue cue, double now) = 0;
  // Lies between the place wanted and the place commanded, from the next tick on.
  virtual void setTransmission(const devices::VirtualTransmission& transmission) = 0;
  // The tactor's place along the finger [m of arc]: the true one, of a simulated
  // participant; the measured one, of a person.
  virtual double tactorPlace() const = 0;
  // False: nothing more will come, the trial ends here.
  virtual bool more() const { return true; }
  // Zero force at once, past the trial's own gate; from any thread.
  virtual void stop() noexcept {}
};

}  // namespace pincer::tasks
