// sim_one_dof_cld: a 1-DOF contact location display in virtual time: a roller that
// moves along the finger, under PID, with play.
//
//   c = travel / arc * s,   |c| <= travel / 2                                                      kinematics
//   u = Kp e + Ki sum(e) dt - Kd v,   e = c_wanted - c_measured;   c'' = u, |u| <= acceleration, |c'| <= speed
//   y = clamp(y, c - play/2, c + play/2)
//
// s place on the pad along the finger [m of arc, distal positive], c place of the carriage [m], y of the roller [m].
// The pole of the loop is triple: Kd = 3 w, Kp = 3 w^2, Ki = w^3. The firmware runs at 1 kHz; a command travels for 1
// or 2 ms (which of the two is drawn, always the same way), and never overtakes another. Between the command and the
// carriage lies the experimenter's virtual transmission, if any. Figures: A. J. Doxon, doctoral dissertation,
// University of Utah (2014), ch. 2 and 3: roller 1 cm, travel about 2 cm, resolution 0.8 um (0.4 um in ch. 3), more
// than 5 Hz, backlash 0.23 mm, PID at 1 kHz, delay 1-2 ms, 16 mm of arc on a finger of 20 mm (or 13 mm) mapped to 16 mm
// of travel. Loop frequency, speed and acceleration are ours.
#pragma once
#include <array>
#include <cstdint>
#include <string>

#include "pincer/devices/cld/tactile_display.h"
#include "pincer/devices/cld/virtual_transmission.h"
#include "pincer/devices/math.h"
#include "pincer/devices/sim_fault.h"

namespace pincer::devices {

// How the roller's way and the finger's skin belong together.
struct OneDofMap {
  double arc = 0.016;              // of the pad that is shown [m], > 0
  double travel = 0.016;           // of the carriage that shows it [m], > 0
  double finger_diameter = 0.020;  // [m], 0.020 or 0.013; arc / (finger_diameter / 2) is the angle shown

  double carriageOf(double place) const { return place * travel / arc; }  // [m]
  double placeOf(double carriage) const { return carriage * arc / travel; }
  // on the finger, from the pad's centre [rad]
  double angleOf(double place) const { return 2 * place / finger_diameter; }
};

struct SimOneDofCldSettings {
  std::string serial = "sim";
  OneDofMap map = {};
  double loop_frequency = 4;   // w / 2 pi [Hz]
  double speed = 0.25;         // of the carriage [m/s]
  double acceleration = 20;    // [m/s^2]
  double play = 0.23e-3;       // backlash, from stop to stop [m]
  double resolution = 0.8e-6;  // of the encoder [m]
};

class SimOneDofCld final : public TactileDisplay {
 public:
  // Throws std::invalid_argument for settings out of range.
  explicit SimOneDofCld(const SimOneDofCldSettings& settings = {});

  std::string identity() const override;
  const TactileCapabilities& capabilities() const override { return capabilities_; }
  DeviceState state() const override;
  TactileSample sample() override;
  // The roller shows the first component; a second one that isn't zero is out of its reach.
  bool command(const TactileCommand& command) override;

  // In effect from the next firmware tick on. Throws std::invalid_argument for one out of range.
  void setTransmission(const VirtualTransmission& transmission);
  // Time moves only here. `dt` > 0 [s].
  void advance(double dt);
  void setFault(SimFault fault);

  // The truth, for records and tests; no participant may see it.
  double time() const { return time_; }
  double trueRoller() const { return settings_.map.placeOf(roller_); }      // place on the pad [m]
  double trueCarriage() const { return settings_.map.placeOf(carriage_); }  // the same before the play [m]

 private:
  void tick();
  void drive(double target);
  void takeSample();

  SimOneDofCldSettings settings_;
  TactileCapabilities capabilities_;
  VirtualTransmission transmission_;
  TransmissionState transmission_state_;
  SimFault fault_ = SimFault::kNone;
  double time_ = 0, owed_ = 0;          // [s]
  double wanted_ = 0;                   // carriage [m]
  std::array<double, 3> travelling_{};  // commands of the last ticks, newest first [m]
  int travelled_ = 1;                   // ticks that the one in effect has travelled
  std::uint64_t draw_ = 0;              // of the jitter
  double integral_ = 0;                 // of the error [m s]
  double carriage_ = 0, velocity_ = 0;  // [m], [m/s]
  double roller_ = 0;                   // [m]
  TactileSample sample_;
};

}  // namespace pincer::devices
