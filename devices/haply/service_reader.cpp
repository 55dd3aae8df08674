#include <algorithm>
#include <bitset>
#include <cmath>

#include "pincer/devices/haply/haply_messages.h"
#include "pincer/devices/haply/json_walk.h"

namespace pincer::devices::haply {
namespace {

// In the order of DeviceFamily.
constexpr std::array<std::string_view, 3> kFamilies{"inverse3", "verse_grip", "wireless_verse_grip"};

// Slots of what is known of a device: numbers, then flags, then texts.
enum NumberSlot : std::size_t {
  kPlace = 0,
  kVelocity = 3,
  kForce = 6,
  kTurn = 9,
  kDamping = 13,
  kGate,
  kGravity,
  kNumbers
};
enum FlagSlot : std::size_t {
  kCalibrated,
  kInUse,
  kPower,
  kReady,
  kStarted,
  kConnected,
  kAwake,
  kButton,
  kA,
  kB,
  kC,
  kFlags
};
enum TextSlot : std::size_t { kId, kMode, kType, kPreset, kBasis, kHandedness, kTexts };

struct NumberRow {
  std::string_view path;
  std::size_t slot;
  double most;
};
// A number beyond `most`, of either sign, is no reading. The 1000 of gains and scales is chosen.
constexpr std::array kNumberRows{NumberRow{"state.cursor_position.x", kPlace, kFarthest},
                                 NumberRow{"state.cursor_position.y", kPlace + 1, kFarthest},
                                 NumberRow{"state.cursor_position.z", kPlace + 2, kFarthest},
                                 NumberRow{"state.cursor_velocity.x", kVelocity, kFastest},
                                 NumberRow{"state.cursor_velocity.y", kVelocity + 1, kFastest},
                                 NumberRow{"state.cursor_velocity.z", kVelocity + 2, kFastest},
                                 NumberRow{"state.current_cursor_force.x", kForce, kStrongest},
                                 NumberRow{"state.current_cursor_force.y", kForce + 1, kStrongest},
                                 NumberRow{"state.current_cursor_force.z", kForce + 2, kStrongest},
                                 NumberRow{"state.orientation.w", kTurn, 1 + kOffUnit},
                                 NumberRow{"state.orientation.x", kTurn + 1, 1 + kOffUnit},
                                 NumberRow{"state.orientation.y", kTurn + 2, 1 + kOffUnit},
                                 NumberRow{"state.orientation.z", kTurn + 3, 1 + kOffUnit},
                                 NumberRow{"config.filters.damping.scalar", kDamping, 1000},
                                 NumberRow{"config.filters.force_gate.gain", kGate, 1000},
                                 NumberRow{"config.gravity_compensation.scaling_factor", kGravity, 1000}};

struct NameRow {
  std::string_view path;
  std::size_t slot;
};
// Paths of all other values that are kept.
constexpr std::array kFlagRows{NameRow{"status.calibrated", kCalibrated},
                               NameRow{"status.in_use", kInUse},
                               NameRow{"status.power_supply", kPower},
                               NameRow{"status.ready", kReady},
                               NameRow{"status.started", kStarted},
                               NameRow{"status.connected", kConnected},
                               NameRow{"status.awake", kAwake},
                               NameRow{"state.button", kButton},
                               NameRow{"state.buttons.a", kA},
                               NameRow{"state.buttons.b", kB},
                               NameRow{"state.buttons.c", kC}};
constexpr std::array kTextRows{NameRow{"device_id", kId},
                               NameRow{"state.control_mode", kMode},
                               NameRow{"config.type", kType},
                               NameRow{"config.preset", kPreset},
                               NameRow{"config.handedness", kHandedness},
                               NameRow{"config.basis.permutation", kBasis}};

template <typename Rows>
auto rowOf(const Rows& rows, std::string_view path) {
  const auto found = std::find_if(rows.begin(), rows.end(), [&](const auto& row) { return row.path == path; });
  return found == rows.end() ? nullptr : &*found;
}

template <typename Rows>
bool leadsTo(const Rows& rows, std::string_view path) {
  return std::any_of(rows.begin(), rows.end(), [&](const auto& row) {
    return row.path.size() > path.size() && row.path[path.size()] == '.' && row.path.substr(0, path.size()) == path;
  });
}

// A known value of a device, and a group of them.
bool isValue(std::string_view path) {
  return rowOf(kNumberRows, path) || rowOf(kFlagRows, path) || rowOf(kTextRows, path);
}
bool isGroup(std::string_view path) {
  return leadsTo(kNumberRows, path) || leadsTo(kFlagRows, path) || leadsTo(kTextRows, path);
}

bool endsWith(std::string_view text, std::string_view end) {
  return text.size() >= end.size() && text.substr(text.size() - end.size()) == end;
}

// Of a mount or a transform: what the number at `path` is in the identity.
double inIdentity(std::string_view path) {
  return endsWith(path, "rotation.w") || path.find(".scale.") != std::string_view::npos ? 1 : 0;
}

// All that is told of one device, until its object ends.
struct Slots {
  std::array<double, kNumbers> numbers{};
  std::bitset<kNumbers> told_numbers;
  std::array<bool, kFlags> flags{};
  std::bitset<kFlags> told_flags;
  std::array<Label, kTexts> texts;
  std::bitset<kTexts> told_texts;
  bool mounted = false, transformed = false, configured = false;

  // All `n` numbers from `first` on are there, or none.
  bool whole(std::size_t first, std::size_t n) const {
    for (std::size_t i = 1; i < n; ++i) {
      if (told_numbers[first + i] != told_numbers[first]) return false;
    }
    return true;
  }
  std::optional<Vec3> vector(std::size_t first) const {
    if (!told_numbers[first]) return std::nullopt;
    return Vec3(numbers[first], numbers[first + 1], numbers[first + 2]);
  }
  std::optional<double> number(std::size_t slot) const {
    return told_numbers[slot] ? std::optional(numbers[slot]) : std::nullopt;
  }
  std::optional<bool> flag(std::size_t slot) const {
    return told_flags[slot] ? std::optional(flags[slot]) : std::nullopt;
  }
  bool pressed(std::size_t slot) const { return flags[slot]; }
};

void takeStatus(const Slots& slots, DeviceReport& device) {
  device.calibrated = slots.flag(kCalibrated);
  device.in_use = slots.flag(kInUse);
  device.power = slots.flag(kPower);
  device.ready = slots.flag(kReady);
  device.started = slots.flag(kStarted);
  device.connected = slots.flag(kConnected);
  device.awake = slots.flag(kAwake);
  device.buttons = (slots.pressed(kButton) || slots.pressed(kA) ? 1u : 0u) | (slots.pressed(kB) ? 2u : 0u) |
                   (slots.pressed(kC) ? 4u : 0u);
}

DeviceConfig configIn(const Slots& slots) {
  DeviceConfig config;
  config.type = slots.texts[kType];
  config.preset = slots.texts[kPreset];
  config.basis = slots.texts[kBasis];
  config.handedness = slots.texts[kHandedness];
  config.damping = slots.number(kDamping);
  config.gate_gain = slots.number(kGate);
  config.gravity_scale = slots.number(kGravity);
  config.mounted = slots.mounted;
  return config;
}

class ServiceSink final : public JsonSink {
 public:
  explicit ServiceSink(ServiceMessage& message) : message_(message) {}
  ReadError error() const { return error_; }
  bool sawFamily() const { return families_.any(); }

  bool begin(std::string_view path, bool array) override {
    if (skipped_ > 0) return ++skipped_, true;
    if (path.empty()) return array ? fail(ReadError::kWrongType) : true;
    if (in_device_) return beginInDevice(path.substr(prefix_), array);
    const auto family = std::find(kFamilies.begin(), kFamilies.end(), path);
    if (family == kFamilies.end()) return ++skipped_, true;
    return array ? beginFamily(static_cast<std::size_t>(family - kFamilies.begin())) : beginDevice();
  }
  bool end(std::string_view path, bool array) override {
    if (skipped_ > 0) return --skipped_, true;
    if (in_device_ && !array && path.size() + 1 == prefix_) return endDevice();
    if (array && !in_device_) family_.reset();
    return true;
  }
  bool value(std::string_view path, const JsonScalar& value) override {
    if (skipped_ > 0) return true;
    if (in_device_) return deviceValue(path.substr(prefix_), value);
    if (path.empty() || family_) return fail(ReadError::kWrongType);
    if (std::find(kFamilies.begin(), kFamilies.end(), path) != kFamilies.end()) return fail(ReadError::kWrongType);
    if (path == "session_id" && std::holds_alternative<double>(value)) {
      if (message_.session) return fail(ReadError::kTwice);
      message_.session = std::get<double>(value);
    }
    return true;
  }

 private:
  bool fail(ReadError error) {
    error_ = error;
    return false;
  }
  bool beginFamily(std::size_t family) {
    if (family_) return fail(ReadError::kWrongType);  // an array in the array
    if (families_[family]) return fail(ReadError::kTwice);
    families_.set(family);
    family_ = family;
    return true;
  }
  bool beginDevice() {
    if (!family_) return fail(ReadError::kWrongType);  // devices in an object: 3.0
    if (message_.count == kMostDevices) return fail(ReadError::kTooManyDevices);
    slots_ = Slots{};
    prefix_ = kFamilies[*family_].size() + 1;
    in_device_ = true;
    return true;
  }
  bool beginInDevice(std::string_view path, bool array) {
    if (isValue(path) || (array && isGroup(path))) return fail(ReadError::kWrongType);
    if (array) ++skipped_;
    slots_.configured |= path == "config";
    return true;
  }
  bool deviceValue(std::string_view path, const JsonScalar& value) {
    if (const auto* number = rowOf(kNumberRows, path)) return takeNumber(*number, value);
    if (const auto* flag = rowOf(kFlagRows, path)) return take<bool>(*flag, value, slots_.flags, slots_.told_flags);
    if (const auto* text = rowOf(kTextRows, path)) return takeText(*text, value);
    if (isGroup(path)) return fail(ReadError::kWrongType);
    if (const auto* number = std::get_if<double>(&value)) {
      const bool other = !(std::abs(*number - inIdentity(path)) <= 1e-6);
      slots_.mounted |= other && path.substr(0, 13) == "config.mount.";
      slots_.transformed |= other && path.substr(0, 16) == "state.transform.";
    }
    return true;
  }
  template <typename T, typename Values, typename Told>
  bool take(const NameRow& row, const JsonScalar& value, Values& values, Told& told) {
    if (!std::holds_alternative<T>(value)) return fail(ReadError::kWrongType);
    if (told[row.slot]) return fail(ReadError::kTwice);
    told.set(row.slot);
    values[row.slot] = std::get<T>(value);
    return true;
  }
  bool takeNumber(const NumberRow& row, const JsonScalar& value) {
    if (!take<double>({row.path, row.slot}, value, slots_.numbers, slots_.told_numbers)) return false;
    return std::abs(slots_.numbers[row.slot]) <= row.most || fail(ReadError::kOutOfRange);
  }
  bool takeText(const NameRow& row, const JsonScalar& value) {
    const auto* text = std::get_if<std::string_view>(&value);
    const auto label = text != nullptr ? Label::of(*text) : std::nullopt;
    if (!label) return fail(ReadError::kWrongType);
    if (slots_.told_texts[row.slot]) return fail(ReadError::kTwice);
    slots_.told_texts.set(row.slot);
    slots_.texts[row.slot] = *label;
    return true;
  }
  bool endDevice() {
    in_device_ = false;
    if (!slots_.told_texts[kId]) return fail(ReadError::kNoId);
    if (message_.find(slots_.texts[kId].view()) != nullptr) return fail(ReadError::kTwice);
    if (!slots_.whole(kPlace, 3) || !slots_.whole(kVelocity, 3) || !slots_.whole(kForce, 3) ||
        !slots_.whole(kTurn, 4)) {
      return fail(ReadError::kMissingComponent);
    }
    DeviceReport& device = message_.devices[message_.count];
    device = DeviceReport{};
    device.family = static_cast<DeviceFamily>(*family_);
    device.id = slots_.texts[kId];
    device.mode = slots_.texts[kMode];
    device.transformed = slots_.transformed;
    device.p_H = slots_.vector(kPlace);
    device.v_H = slots_.vector(kVelocity);
    device.f_H = slots_.vector(kForce);
    takeStatus(slots_, device);
    if (slots_.configured) device.config = configIn(slots_);
    if (!takeTurn(device)) return fail(ReadError::kOutOfRange);
    ++message_.count;
    return true;
  }
  // A grip that lost its orientation may tell four zeros: then it has none. Any other that is off unit is unsound.
  bool takeTurn(DeviceReport& device) const {
    if (!slots_.told_numbers[kTurn]) return true;
    const auto& n = slots_.numbers;
    const Quat q(n[kTurn], n[kTurn + 1], n[kTurn + 2], n[kTurn + 3]);
    const double norm = q.norm();
    if (norm == 0) return true;
    if (!(std::abs(norm - 1) <= kOffUnit)) return false;
    device.q_H = q.normalized();
    return true;
  }

  ServiceMessage& message_;
  ReadError error_ = ReadError::kNotJson;
  std::bitset<kFamilies.size()> families_;
  std::optional<std::size_t> family_;
  bool in_device_ = false;
  std::size_t prefix_ = 0;
  int skipped_ = 0;  // levels below something unknown
  Slots slots_;
};

}  // namespace

ReadError readService(std::string_view text, ServiceMessage& message) noexcept {
  message.session.reset();
  message.count = 0;
  if (text.size() > kMostMessage) return ReadError::kTooLong;
  ServiceSink sink(message);
  const bool whole = walkJson(text, sink) && sink.sawFamily();
  if (!whole) message.count = 0;
  return whole ? ReadError::kNone : sink.error();
}

}  // namespace pincer::devices::haply
