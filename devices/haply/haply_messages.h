// haply_messages: texts of Haply's service (Inverse SDK 3.1 to 3.5, docs/devices/haply.md) to plain values and back.
//
// One WebSocket text frame is one JSON object. The service sends the inventory once, then one state message per
// message of ours. Reading refuses and never mends: an unsound message gives an error, and nothing of it is
// used. Unknown keys are left alone. A missing component of a vector is an error; a vector that isn't there at
// all is absent, never zero. Frames: the service's application space H: right-handed, z up, x right, the arm
// reaches to -y. Units: m, m/s, N. Sources: docs.haply.co, pages WebSocket Protocol, Simulation Channel, Control
// Commands, Events & Monitoring, HTTP (2025).
#pragma once
#include <array>
#include <cstdint>
#include <optional>
#include <span>
#include <string>
#include <string_view>

#include "pincer/devices/math.h"

namespace pincer::devices::haply {

inline constexpr std::size_t kMostDevices = 16;     // chosen; a message with more is refused
inline constexpr std::size_t kMostMessage = 65536;  // that is read [bytes]
inline constexpr std::size_t kMostCommand = 1024;   // that is written [bytes]
inline constexpr double kFarthest = 2;              // a place further from the device's origin isn't one [m]
inline constexpr double kFastest = 20;              // [m/s]
inline constexpr double kStrongest = 100;           // [N]
inline constexpr double kOffUnit = 0.01;            // a quaternion's norm may be off 1 by as much

// A short text in place: an id, a mode. Letters, digits and "_-.: ", 31 at the most.
class Label {
 public:
  Label() = default;
  // Absent where `text` is too long, empty or has another character.
  static std::optional<Label> of(std::string_view text);
  std::string_view view() const { return {text_.data(), size_}; }
  bool operator==(const Label&) const = default;

 private:
  std::array<char, 31> text_{};
  std::uint8_t size_ = 0;
};

enum class DeviceFamily : std::uint8_t { kInverse3, kGrip, kWirelessGrip };

// The settings of a device as the service tells them, in the inventory and in a full state.
struct DeviceConfig {
  Label type;  // "inverse3", "inverse3x", "minverse", ..
  Label preset, basis, handedness;
  std::optional<double> damping, gate_gain, gravity_scale;
  bool mounted = false;  // a mount that isn't the identity
  bool operator==(const DeviceConfig&) const = default;
};

struct DeviceReport {
  DeviceFamily family = DeviceFamily::kInverse3;
  Label id;
  std::optional<Vec3> p_H, v_H, f_H;  // cursor: place, velocity, current force
  std::optional<Quat> q_H;            // of a grip
  std::uint32_t buttons = 0;          // bit 0: a, or a wired grip's only one; 1: b; 2: c
  Label mode;                         // "idle", ..; empty: not told
  bool transformed = false;           // a transform that isn't the identity
  std::optional<bool> calibrated, in_use, power, ready, started, connected, awake;
  std::optional<DeviceConfig> config;
};

struct ServiceMessage {
  std::optional<double> session;  // its number, in the inventory of 3.5
  std::size_t count = 0;
  std::array<DeviceReport, kMostDevices> devices;
  const DeviceReport* find(std::string_view id) const;
};

enum class ReadError : std::uint8_t {
  kNone,
  kTooLong,
  kNotJson,
  kWrongType,
  kOutOfRange,
  kMissingComponent,
  kTwice,
  kTooManyDevices,
  kNoId
};
const char* describe(ReadError error);  // a phrase: "a number is out of range"

// kNone: `message` is sound. Otherwise `message` holds nothing to be used. Any bytes; never throws.
ReadError readService(std::string_view text, ServiceMessage& message) noexcept;

// An event, as far as it matters here.
enum class EventLevel : std::uint8_t { kInfo, kNotice, kWarning, kError, kCritical, kPanic };
struct ServiceEvent {
  Label name;                            // "device-safety-triggered", ..
  EventLevel level = EventLevel::kInfo;  // one that isn't known is an error's
  std::optional<Label> device;           // absent: of the whole service
  Label safety;                          // "stall_detected", ..; empty: none
  std::array<char, 120> words{};         // for a person, cut off
};
ReadError readEvent(std::string_view text, ServiceEvent& event) noexcept;

// The service's version in the answer to GET /version: bare or in "data". Absent: there is none in it.
struct ServiceVersion {
  int major = 0, minor = 0;
};
std::optional<ServiceVersion> readVersion(std::string_view body) noexcept;
// The one number in an answer of HTTP, bare or in "data".
std::optional<double> readNumber(std::string_view body) noexcept;

// Ids in the answer to GET /devices: every "device_id" in it that is one, 16 at the most.
struct DeviceIds {
  std::size_t count = 0;
  std::array<Label, kMostDevices> ids;
};
DeviceIds readDeviceIds(std::string_view body) noexcept;

// How a force's components are spelled: 3.5's pages say "vector", known clients of 3.1 to 3.4
// "values". The service ignores the other one.
enum class ForceSpelling : std::uint8_t { kVector, kValues };

struct ForceCommand {
  Label id;
  Vec3 f_H = Vec3::Zero();               // [N]; what isn't finite is written as zero
  bool configure = false;                // preset and damping too, in the session's first message
  std::optional<double> gate_gain = {};  // the force gate's, where it is set
};

// A message, written into `buffer`.
//   profile     of the session's first message; empty in all others
//   full_state  asks for config in the answer
std::string_view writeForces(std::span<char, kMostCommand> buffer, std::span<const ForceCommand> commands,
                             ForceSpelling spelling, std::string_view profile = {}, bool full_state = false);
// Asks for states without commanding anything.
std::string_view writeProbes(std::span<char, kMostCommand> buffer, std::span<const ForceCommand> devices);

}  // namespace pincer::devices::haply
