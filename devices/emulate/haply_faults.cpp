#include "pincer/devices/emulate/haply_faults.h"

#include <fmt/format.h>

namespace pincer::devices::emulate {
namespace {

// In the order of HaplyFault.
constexpr std::array<std::string_view, kHaplyFaults> kNames{"none",
                                                            "no JSON",
                                                            "no UTF-8",
                                                            "too long",
                                                            "not a number",
                                                            "infinity",
                                                            "beyond a double",
                                                            "text for a number",
                                                            "a missing component",
                                                            "a key twice",
                                                            "an unknown key",
                                                            "a device twice",
                                                            "out of range",
                                                            "an empty object",
                                                            "answered twice",
                                                            "never answered",
                                                            "device gone",
                                                            "calibration lost",
                                                            "power lost",
                                                            "not ready",
                                                            "settings changed",
                                                            "transformed",
                                                            "echo doubled",
                                                            "echo too strong",
                                                            "place frozen",
                                                            "stays idle",
                                                            "deaf to forces",
                                                            "grip asleep",
                                                            "grip of zeros",
                                                            "busy",
                                                            "stall",
                                                            "stage changed",
                                                            "error",
                                                            "unreadable event",
                                                            "1-byte pieces",
                                                            "fragments",
                                                            "pings between",
                                                            "header of 16 MiB",
                                                            "reset",
                                                            "half-open",
                                                            "late",
                                                            "events closed"};

// The first number behind "cursor_position":{"x": becomes `value`; alphabetical order puts x first.
std::string withPlace(std::string text, std::string_view value) {
  const std::string_view key = R"("cursor_position":{"x":)";
  const std::size_t at = text.find(key);
  if (at == std::string::npos) return text;
  const std::size_t begin = at + key.size();
  return text.replace(begin, text.find(',', begin) - begin, value);
}

std::string replaced(std::string text, std::string_view old, std::string_view with) {
  const std::size_t at = text.find(old);
  return at == std::string::npos ? text : text.replace(at, old.size(), with);
}

}  // namespace

std::string_view nameOf(HaplyFault fault) { return kNames[static_cast<std::size_t>(fault)]; }

bool isHarmless(HaplyFault fault) {
  switch (fault) {
    case HaplyFault::kNone:
    case HaplyFault::kUnknownKey:
    case HaplyFault::kGripAsleep:
    case HaplyFault::kGripZero:
    case HaplyFault::kPieces:
    case HaplyFault::kFragments:
    case HaplyFault::kPings:
      return true;
    default:
      return false;
  }
}

std::string spoilt(HaplyFault fault, std::string text) {
  switch (fault) {
    case HaplyFault::kNoJson:
      return text.substr(0, text.size() / 2);
    case HaplyFault::kNoUtf8:
      return replaced(std::move(text), "cartesian", "c\xff\xfe");
    case HaplyFault::kTooLong:
      return text + std::string(65537, ' ');
    case HaplyFault::kNotANumber:
      return withPlace(std::move(text), "NaN");
    case HaplyFault::kInfinity:
      return withPlace(std::move(text), "-Infinity");
    case HaplyFault::kBeyondDouble:
      return withPlace(std::move(text), "1e999");
    case HaplyFault::kTextForNumber:
      return withPlace(std::move(text), "\"0.1\"");
    case HaplyFault::kMissingComponent:
      return replaced(std::move(text), R"("cursor_position":{"x":)", R"("cursor_position":{"u":)");
    case HaplyFault::kKeyTwice:
      return replaced(std::move(text), R"("cursor_position":{)", R"("cursor_position":{"x":0.0,)");
    case HaplyFault::kUnknownKey:
      return replaced(std::move(text), R"("cursor_position":{)",
                      R"("new":{"of":["3.6",{"x":null}]},"cursor_position":{)");
    case HaplyFault::kDeviceTwice:
      return replaced(std::move(text), R"("inverse3":[)",
                      R"("inverse3":[{"device_id":"049D","state":{},"status":{}},)");
    case HaplyFault::kOutOfRange:
      return withPlace(std::move(text), "2.5");
    case HaplyFault::kEmptyObject:
      return "{}";
    default:
      return text;
  }
}

std::string eventOf(HaplyFault fault, std::string_view id) {
  const auto event = [&](const char* name, const char* level, const char* safety, const char* words) {
    return fmt::format(
        R"({{"name":"{}","category":"device","level":"{}","data":{{"device_family":"inverse","device_id":"{}","safety_type":"{}"}},"message":"{}"}})",
        name, level, id, safety, words);
  };
  switch (fault) {
    case HaplyFault::kBusy:
      return event("device-busy", "notice", "none", "in use by another session");
    case HaplyFault::kStall:
      return event("device-safety-triggered", "warning", "stall_detected", "stall");
    case HaplyFault::kStageChanged:
      return event("device-safety-triggered", "warning", "fod_stage_changed", "FOD stage changed: guard -> hard");
    case HaplyFault::kError:
      return event("something-new", "error", "none", "it broke");
    case HaplyFault::kUnreadableEvent:
      return R"({"name":)";
    default:
      return "";
  }
}

}  // namespace pincer::devices::emulate
