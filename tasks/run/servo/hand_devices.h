// hand_devices: the arms and displays that a person's fingers wear in a session,
// whatever drives them: an explicit factory.
//
// All clocks are made the servo's: samples carry times in seconds since begin().
#pragma once
#include <memory>
#include <optional>
#include <stdexcept>
#include <string>
#include <vector>

#include "pincer/devices/arm/arm.h"
#include "pincer/devices/cld/tactile_display.h"
#include "pincer/devices/weart/pressure_display.h"
#include "pincer/tasks/run/servo/device_calibration.h"

namespace pincer::tasks {

// A device that is missing, can't be opened or failed; what() is a sentence with the remedy (exit code 4).
class DeviceError : public std::runtime_error {
 public:
  using std::runtime_error::runtime_error;
};

// Tones for a person, on devices that have a buzzer or a lamp.
enum class DeviceTone { kStart, kSuccess, kEnd };

// Of the time that the loop may stall (--watchdog): so old may a sample be, and after
// so long does a USB arm go limp by itself.
inline constexpr double kOldestSample = 0.6, kArmDeadline = 0.8;

class HandDevices {
 public:
  virtual ~HandDevices() = default;
  virtual devices::Arm& arm(int finger) = 0;
  // Null where the finger wears none.
  virtual devices::TactileDisplay* display(int finger) = 0;
  // Likewise; beside a tactile display or without.
  virtual devices::PressureDisplay* pressure(int) { return nullptr; }
  // The zero of the samples' times, on the system's monotonic clock [ns].
  virtual void setEpoch(std::int64_t ns) = 0;
  // Moves what has no clock of its own to `now` [s since the epoch].
  virtual void advanceTo(double) {}
  virtual void sound(DeviceTone) {}
  // By how much the finger's arm stands off its place in the scene, from its calibration file.
  virtual ArmBase base(int) const { return {}; }
  // Where the finger's arm stands in the world; for what was recorded there.
  virtual void setBase(int, const Vec3&, const Quat&) {}
  // Fault that a device, or its service, reports: a sentence with the remedy; empty: nothing.
  virtual std::string complaint() { return {}; }
  // One line per device, for a person.
  virtual std::vector<std::string> describe() = 0;
};

enum class DeviceChoice { kSim, kUsb, kFalcon, kHaply, kMouse, kReplay };
DeviceChoice deviceChoiceOf(const std::string& name);  // throws InputError for any other name
// True if somebody may feel forces of these devices: then the session's time is the wall
// clock's, and a watchdog guards the motors.
bool hasMotors(DeviceChoice choice);

struct DeviceOptions {
  DeviceChoice choice = DeviceChoice::kSim;
  int fingers = 2;
  std::vector<std::string> arms, displays;  // serial numbers, per finger; empty: in the order of the serial numbers
  bool needs_displays = true;               // false: a finger may go without
  double timeout = 3;                       // for devices that are plugged in to become ready [s]
  double watchdog = 5e-3;                   // so long may the program stall before forces are cut [s]
  std::vector<std::string> calibrations;    // files of arms (device_calibration.h)
  std::string recording;                    // replay: a session's store, or a CSV file of samples (pincer export)
  std::string firmware;                     // falcon: the maker's image
  std::vector<std::string> grips;  // haply: ids of VerseGrips, per finger; empty: the finger's turn isn't measured
  std::string service = "127.0.0.1:10001";  // haply: where its service is, HOST:PORT or HOST:PORT:EVENTS
  std::optional<double> force_gate;         // haply: gain of its force gate; absent: left as it is
  std::string pressure;  // HOST:PORT of WEART's Middleware, whose TouchDIVER the fingers wear besides; empty: none
  std::string pressure_hand = "right";  // which it is on: right or left
  double full_pressure = 5;             // force of its highest level [N]
};

// Throws DeviceError. `kSim` and `kMouse` aren't opened here: a simulated participant brings its own
// devices, the mouse belongs to the viewer.
std::unique_ptr<HandDevices> openHandDevices(const DeviceOptions& options);

}  // namespace pincer::tasks
