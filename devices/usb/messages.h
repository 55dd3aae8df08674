// messages: what the payload of a frame says, in SI units; each encode / decode pair
// follows docs/usb-protocol.md byte by byte.
//
// On the wire: lengths in nm, forces in uN, speeds in um/s, times in 0.1 ms, as integers, so that nothing that
// isn't a number can arrive. decode: absent unless the type is right, every value is in its range, and every
// byte that the message doesn't use is zero.
#pragma once
#include <cstdint>
#include <optional>
#include <string>

#include "pincer/devices/arm/arm.h"
#include "pincer/devices/cld/tactile_display.h"
#include "pincer/devices/math.h"
#include "pincer/devices/usb/frame.h"

namespace pincer::devices::usb {

enum class DeviceKind : std::uint8_t { kArm = 1, kDisplay = 2 };
std::string nameOf(DeviceKind kind);  // "arm", "display"

// Sounds or lights that pace a trial, for devices that have them.
enum class Signal : std::uint8_t { kNone = 0, kStart = 1, kSuccess = 2, kEnd = 3 };

// How an arm's joints move its tip, so that the torques of a force are known.
enum class Linkage : std::uint8_t { kNotTold = 0, kPremium = 1 };  // kPremium: devices/arm/premium_kinematics.h

struct Identity {
  DeviceKind kind = DeviceKind::kArm;
  std::uint16_t firmware = 1;  // version
  std::uint16_t rate = 1000;   // of state frames [Hz], 1 .. 8000
  std::string model;           // 1 .. 16 printable ASCII characters
  std::string serial;          // 1 .. 12
  Linkage linkage = Linkage::kNotTold;
  std::optional<double> tip_mass = {};  // of an arm: the least felt at its tip [kg], 0.0001 .. 6.5
  double tip_damping = 0;  // of an arm: the least viscous friction at its tip [N s/m], 0 .. 65; 0: not told
  bool operator==(const Identity&) const = default;
};

inline constexpr double kDeadlineStep = 1e-4;  // of deadlines on the wire [s]

struct ArmCommand {
  Vec3 f_D = Vec3::Zero();   // [N], each component within +-100
  double deadline = 0.004;   // after which the arm goes limp unless a newer command came [s], (0, 0.1]
  std::uint16_t arming = 0;  // counts the operator's armings; a limp arm takes force only with a count it hasn't seen
  Signal signal = Signal::kNone;
};

struct ArmState {
  bool valid = false;                     // the position may be used
  bool limp = true;                       // takes no force until a new arming
  Vec3 p_DF = Vec3::Zero();               // [m], each within +-2
  std::optional<Vec3> v_DF;               // [m/s], each within +-50
  std::optional<Quat> q_DF;               // gimbal
  std::optional<std::uint16_t> switches;  // bit per button
  std::uint16_t arming = 0;               // of the last command taken
  std::uint32_t answers = 0;              // sequence of the last command taken
};

struct DisplayCommand {
  Vec2 place_L = Vec2::Zero();  // [m], each within +-0.1
  bool parked = false;
  double deadline = 0.05;  // after which the tactor parks [s], (0, 1]
  Signal signal = Signal::kNone;
};

struct DisplayState {
  bool valid = false;
  bool parked = true;
  std::optional<Vec2> place_L;  // [m]
  std::uint32_t answers = 0;
};

// One of a device's calibration values.
struct CalibrationEntry {
  std::uint8_t index = 0, count = 0;  // index < count; a request has count 0
  std::string name;                   // 1 .. 20 printable characters; empty in a request to read
  double value = 0;                   // finite
};

struct Status {
  DeviceState state = DeviceState::kHoming;  // kHoming, kReady or kFaulted
  std::uint32_t faults = 0;                  // bits, 0: none (StatusFault)
  std::uint32_t bad_frames = 0;              // commands refused: length, magic, version, checksum, type, range
  std::uint32_t missed_deadlines = 0;
};
enum StatusFault : std::uint32_t { kOverTemperature = 1, kSensorFault = 2, kSupplyFault = 4, kEmergencyStop = 8 };
std::string describeFaults(std::uint32_t faults);  // "emergency stop, supply"; empty for 0

// A frame of the message; sequence and time are the caller's.
Frame toFrame(const Identity& m);
Frame toFrame(const ArmCommand& m);
Frame toFrame(const ArmState& m);
Frame toFrame(const DisplayCommand& m);
Frame toFrame(const DisplayState& m);
Frame toFrame(const Status& m);
Frame toFrame(const ArmCapabilities& m);
Frame toFrame(const TactileCapabilities& m);
Frame toFrame(const CalibrationEntry& m, FrameType type);  // kReadCalibration, kWriteCalibration or kCalibration

std::optional<Identity> identityIn(const Frame& frame);
std::optional<ArmCommand> armCommandIn(const Frame& frame);
std::optional<ArmState> armStateIn(const Frame& frame);
std::optional<DisplayCommand> displayCommandIn(const Frame& frame);
std::optional<DisplayState> displayStateIn(const Frame& frame);
std::optional<Status> statusIn(const Frame& frame);
// Without what `Identity` tells of an arm.
std::optional<ArmCapabilities> armCapabilitiesIn(const Frame& frame);
std::optional<TactileCapabilities> displayCapabilitiesIn(const Frame& frame);
std::optional<CalibrationEntry> calibrationIn(const Frame& frame);

}  // namespace pincer::devices::usb
