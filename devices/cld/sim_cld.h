// sim_cld: a 2-DOF contact location display in virtual time (per axis: a driven,
// rate-limited second-order actuator, then play).
//
//   a'' = w^2 (u - a) - 2 zeta w a',    |a'| <= speed;        y = clamp(y, a - play/2, a + play/2)
//
// u way commanded (held between commands), a way of the actuators, which the potentiometers measure, y way of the
// tactor [m]: first along the finger (plate, then ring: two_dof_kinematics.h), second round it (carriage, r b). Places
// in L come from ways and back by the kinematics; a place that can't be reached is replaced by the nearest that can.
// The firmware takes the latest command every 2 ms, the command then travels for `delay`, and now and then for `jitter`
// more (drawn, always in the same way); the actuators run at 2 kHz.
// Figures: A. J. Doxon, doctoral dissertation, University of Utah (2014), ch. 4: resolution 53
// um at the tactor, more than 5 Hz, backlash
// 1.13 mm proximal-distal (0.51 mm of it the plate's) and 0.42 mm radial-ulnar, 500 Hz, <= 2 ms. Damping, reach and
// speed are ours (he asks for 20 mm/s, better 74).
#pragma once
#include <cstdint>
#include <limits>
#include <optional>
#include <string>

#include "pincer/devices/cld/tactile_display.h"
#include "pincer/devices/cld/two_dof_kinematics.h"
#include "pincer/devices/math.h"
#include "pincer/devices/sim_fault.h"

namespace pincer::devices {

struct SimCldSettings {
  std::string serial = "sim";  // tells two displays apart
  TwoDofGeometry geometry = {};
  FingerProfile profile = FingerProfile::capsule(0.008);
  double speed = 0.1;            // of an actuator [m/s]
  double natural_frequency = 8;  // w / 2 pi [Hz]
  double damping_ratio = 0.8;    // zeta [-]; -3 dB at 0.87 of the natural frequency
  Vec2 play{1.13e-3, 0.42e-3};   // backlash, from stop to stop [m]
  double resolution = 53e-6;     // of the potentiometers [m]
  double delay = 1.5e-3;         // of a command [s], 0..2 ms, a multiple of 0.5 ms
  double jitter = 0;             // of the delay [s], 0 .. 2 ms - delay, a multiple of 0.5 ms
};

class SimCld final : public TactileDisplay {
 public:
  // Throws std::invalid_argument for settings out of range.
  explicit SimCld(const SimCldSettings& settings = {});

  std::string identity() const override;
  const TactileCapabilities& capabilities() const override { return capabilities_; }
  DeviceState state() const override;
  TactileSample sample() override;
  // A place that isn't finite is refused: the tactor keeps its last target, and the answer is true.
  bool command(const TactileCommand& command) override;

  // Time moves only here. `dt` > 0 [s].
  void advance(double dt);
  void setFault(SimFault fault);

  // The truth, for records and tests; no participant may see it.
  double time() const { return time_; }
  Vec2 trueTactor_L() const { return placeOf(tactor_); }      // [m]
  Vec2 trueActuator_L() const { return placeOf(actuator_); }  // [m]
  // Plate [m], ring [rad], carriage [rad].
  Vec3 trueActuators() const {
    return kinematics_.actuatorsAt({actuator_.x(), actuator_.y() / settings_.profile.radius});
  }
  const TwoDofKinematics& kinematics() const { return kinematics_; }

 private:
  static constexpr double kNotRead = std::numeric_limits<double>::quiet_NaN();  // [m]: differs from every first reading

  void tick();
  Vec2 waysTo(const Vec2& place_L) const;
  void arrive();
  void moveAxis(int axis);
  void takeSample();
  Vec2 placeOf(const Vec2& way) const { return kinematics_.placeAt({way.x(), way.y() / settings_.profile.radius}); }

  SimCldSettings settings_;
  TwoDofKinematics kinematics_;
  TactileCapabilities capabilities_;
  SimFault fault_ = SimFault::kNone;
  double time_ = 0;                                  // [s]
  double owed_ = 0;                                  // time passed since the last tick of the firmware [s]
  int frame_tick_ = 0;                               // ticks since the last frame
  int delay_ticks_ = 0, jitter_ticks_ = 0;           // that a command travels
  std::uint64_t draw_ = 0;                           // of the jitter
  Vec2 most_ = Vec2::Zero(), least_ = Vec2::Zero();  // stops of the actuators [m]
  int hops_left_ = 0;                                // of the command in flight [ticks]
  std::optional<Vec2> mailbox_;                      // place of the latest command, not yet fetched [m]
  std::optional<Vec2> in_flight_;                    // u, fetched, not yet in effect [m]
  Vec2 target_ = Vec2::Zero();                       // u [m]
  Vec2 actuator_ = Vec2::Zero();                     // a [m]
  Vec2 actuator_speed_ = Vec2::Zero();               // a' [m/s]
  Vec2 tactor_ = Vec2::Zero();                       // y [m]
  double a11_ = 0, a12_ = 0, a21_ = 0, a22_ = 0;     // exact motion of (a - u, a') over one tick
  Vec2 read_ = Vec2::Constant(kNotRead);             // a as measured [m], and the place that it stands for:
  Vec2 read_place_L_ = Vec2::Zero();                 // found anew only when a has moved on [m]
  TactileSample sample_;
};

}  // namespace pincer::devices
