#include "pincer/devices/weart/weart_messages.h"

#include <fmt/format.h>

#include <algorithm>
#include <variant>

#include "pincer/devices/haply/json_walk.h"

namespace pincer::devices::weart {
namespace {

std::string_view nameOf(HandSide hand) { return hand == HandSide::kRight ? "RIGHT" : "LEFT"; }

std::string_view nameOf(Thimble thimble) {
  constexpr std::array<std::string_view, 3> kNames{"THUMB", "INDEX", "MIDDLE"};  // in the order of Thimble
  return kNames[static_cast<std::size_t>(thimble)];
}

// The few values of a status that count.
class StatusSink final : public haply::JsonSink {
 public:
  bool value(std::string_view path, const haply::JsonScalar& value) override {
    const auto* const text = std::get_if<std::string_view>(&value);
    const auto* const truth = std::get_if<bool>(&value);
    if (path == "type" && text) is_status = *text == "MW_STATUS";
    if (path == "data.status" && text) status.running = *text == "RUNNING";
    if (path == "data.actuationsEnabled" && truth) status.actuates = *truth;
    return true;
  }
  bool begin(std::string_view, bool) override { return true; }
  bool end(std::string_view, bool) override { return true; }

  bool is_status = false;
  MiddlewareStatus status;
};

}  // namespace

std::string_view writeForce(TextBuffer& buffer, double level, HandSide hand, Thimble thimble) {
  const double sound = level > 0 ? std::min(level, 1.0) : 0;
  const auto end = fmt::format_to_n(buffer.data(), buffer.size(), "force:{:.6f}:0.000000:0.000000:{}:{}~", sound,
                                    nameOf(hand), nameOf(thimble));
  return {buffer.data(), end.size};
}

std::string_view writeStopForce(TextBuffer& buffer, HandSide hand, Thimble thimble) {
  const auto end = fmt::format_to_n(buffer.data(), buffer.size(), "stopForce:{}:{}~", nameOf(hand), nameOf(thimble));
  return {buffer.data(), end.size};
}

std::optional<MiddlewareStatus> readStatus(std::string_view message) {
  StatusSink sink;
  if (!haply::walkJson(message, sink) || !sink.is_status) return std::nullopt;
  return sink.status;
}

}  // namespace pincer::devices::weart
