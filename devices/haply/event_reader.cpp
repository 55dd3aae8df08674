#include <algorithm>
#include <cmath>
#include <cstdlib>

#include "pincer/devices/haply/haply_messages.h"
#include "pincer/devices/haply/json_walk.h"

namespace pincer::devices::haply {
namespace {

EventLevel levelOf(std::string_view name) {
  // In the order of EventLevel, mildest first.
  constexpr std::array<std::string_view, 6> kNames{"info", "notice", "warning", "error", "critical", "panic"};
  const auto found = std::find(kNames.begin(), kNames.end(), name);
  return found == kNames.end() ? EventLevel::kError : static_cast<EventLevel>(found - kNames.begin());
}

class EventSink final : public JsonSink {
 public:
  explicit EventSink(ServiceEvent& event) : event_(event) {}
  ReadError error() const { return error_; }
  bool named() const { return name_ && level_; }

  bool begin(std::string_view path, bool array) override {
    return !(path.empty() && array) || fail(ReadError::kWrongType);
  }
  bool end(std::string_view, bool) override { return true; }
  bool value(std::string_view path, const JsonScalar& value) override {
    const auto* text = std::get_if<std::string_view>(&value);
    if (path == "name") return text != nullptr ? takeName(*text) : fail(ReadError::kWrongType);
    if (path == "level") return text != nullptr ? takeLevel(*text) : fail(ReadError::kWrongType);
    if (text == nullptr) return true;
    if (path == "data.device_id") event_.device = Label::of(*text);
    if (path == "data.safety_type") event_.safety = Label::of(*text).value_or(*Label::of("unreadable"));
    if (path == "message") keepWords(*text);
    return true;
  }

 private:
  bool fail(ReadError error) {
    error_ = error;
    return false;
  }
  bool takeName(std::string_view text) {
    const auto label = Label::of(text);
    if (!label) return fail(ReadError::kWrongType);
    if (name_) return fail(ReadError::kTwice);
    event_.name = *label;
    return name_ = true;
  }
  bool takeLevel(std::string_view text) {
    if (level_) return fail(ReadError::kTwice);
    event_.level = levelOf(text);
    return level_ = true;
  }
  // Printable ASCII only; the rest becomes '?'.
  void keepWords(std::string_view text) {
    const std::size_t n = std::min(text.size(), event_.words.size() - 1);
    std::transform(text.begin(), text.begin() + static_cast<std::ptrdiff_t>(n), event_.words.begin(),
                   [](char c) { return c >= ' ' && c <= '~' ? c : '?'; });
    event_.words[n] = '\0';
  }

  ServiceEvent& event_;
  ReadError error_ = ReadError::kNotJson;
  bool name_ = false, level_ = false;
};

// "3.5.1", "v3.5", "Inverse 3.5.1 (..)": the first number with a dot behind it.
std::optional<ServiceVersion> versionIn(std::string_view text) {
  const auto digit = [](char c) { return c >= '0' && c <= '9'; };
  const auto first = std::find_if(text.begin(), text.end(), digit);
  const std::string rest(first, text.end());
  char* end = nullptr;
  const long major = std::strtol(rest.c_str(), &end, 10);
  if (end == rest.c_str() || *end != '.' || !digit(end[1])) return std::nullopt;
  const long minor = std::strtol(end + 1, nullptr, 10);
  if (major > 1000 || minor > 1000) return std::nullopt;
  return ServiceVersion{static_cast<int>(major), static_cast<int>(minor)};
}

class VersionSink final : public JsonSink {
 public:
  bool begin(std::string_view, bool) override { return true; }
  bool end(std::string_view, bool) override { return true; }
  bool value(std::string_view path, const JsonScalar& value) override {
    const bool refused = path == "ok" && std::holds_alternative<bool>(value) && !std::get<bool>(value);
    const auto* text = std::get_if<std::string_view>(&value);
    const bool named = path.empty() || path == "data" || path.find("version") != std::string_view::npos;
    if (text != nullptr && named && !found) found = versionIn(*text);
    return !refused;
  }
  std::optional<ServiceVersion> found;
};

class NumberSink final : public JsonSink {
 public:
  bool begin(std::string_view, bool) override { return true; }
  bool end(std::string_view, bool) override { return true; }
  bool value(std::string_view, const JsonScalar& value) override {
    const auto* number = std::get_if<double>(&value);
    if (number != nullptr && found) return false;  // which one is meant?
    if (number != nullptr) found = *number;
    return true;
  }
  std::optional<double> found;
};

class IdSink final : public JsonSink {
 public:
  bool begin(std::string_view, bool) override { return true; }
  bool end(std::string_view, bool) override { return true; }
  bool value(std::string_view path, const JsonScalar& value) override {
    const auto* text = std::get_if<std::string_view>(&value);
    const bool named = path == "device_id" || (path.size() > 10 && path.substr(path.size() - 10) == ".device_id");
    const auto id = text != nullptr && named ? Label::of(*text) : std::nullopt;
    if (id && found.count < found.ids.size()) found.ids[found.count++] = *id;
    return true;
  }
  DeviceIds found;
};

}  // namespace

DeviceIds readDeviceIds(std::string_view body) noexcept {
  IdSink sink;
  return walkJson(body, sink) ? sink.found : DeviceIds{};
}

ReadError readEvent(std::string_view text, ServiceEvent& event) noexcept {
  event = ServiceEvent{};
  if (text.size() > kMostMessage) return ReadError::kTooLong;
  EventSink sink(event);
  if (!walkJson(text, sink)) return sink.error();
  return sink.named() ? ReadError::kNone : ReadError::kNotJson;
}

std::optional<ServiceVersion> readVersion(std::string_view body) noexcept {
  try {
    VersionSink sink;
    if (walkJson(body, sink)) return sink.found;
    // plain text
    return body.size() < 100 && body.find('{') == std::string_view::npos ? versionIn(body) : std::nullopt;
  } catch (...) {  // out of memory
    return std::nullopt;
  }
}

std::optional<double> readNumber(std::string_view body) noexcept {
  NumberSink sink;
  return walkJson(body, sink) ? sink.found : std::nullopt;
}

}  // namespace pincer::devices::haply
