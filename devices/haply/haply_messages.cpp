#include "pincer/devices/haply/haply_messages.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

namespace pincer::devices::haply {
namespace {

bool isPlain(char c) {
  return (c >= 'a' && c <= 'z') || (c >= 'A' && c <= 'Z') || (c >= '0' && c <= '9') || c == '_' || c == '-' ||
         c == '.' || c == ':' || c == ' ';
}

// Text into a buffer that never grows.
class Writer {
 public:
  explicit Writer(std::span<char> buffer) : buffer_(buffer) {}
  Writer& operator<<(std::string_view text) {
    const std::size_t n = std::min(text.size(), buffer_.size() - size_);
    std::copy_n(text.begin(), n, buffer_.begin() + static_cast<std::ptrdiff_t>(size_));
    size_ += n;
    return *this;
  }
  // To a millionth, as JSON wants it: "0.0", "1.5".
  Writer& operator<<(double value) {
    std::array<char, 32> digits{};
    const double sound = std::isfinite(value) && std::abs(value) <= kStrongest ? value : 0;
    const auto end = fmt::format_to_n(digits.data(), digits.size(), "{:.6f}", sound).out;
    std::string_view text(digits.data(), static_cast<std::size_t>(end - digits.data()));
    while (text.back() == '0' && text[text.size() - 2] != '.') text.remove_suffix(1);
    return *this << (text == "-0.0" ? std::string_view("0.0") : text);
  }
  std::string_view text() const { return {buffer_.data(), size_}; }

 private:
  std::span<char> buffer_;
  std::size_t size_ = 0;
};

void writeForce(Writer& out, const ForceCommand& command, ForceSpelling spelling) {
  out << R"({"device_id":")" << command.id.view() << "\",";
  if (command.configure) {
    out << R"("configure":{"preset":{"preset":"defaults"},"damping":{"scalar":0.0})";
    if (command.gate_gain) out << R"(,"force_gate":{"gain":)" << *command.gate_gain << "}";
    out << "},";
  }
  out << R"("commands":{"set_cursor_force":{")" << (spelling == ForceSpelling::kVector ? "vector" : "values")
      << R"(":{"x":)" << command.f_H.x() << R"(,"y":)" << command.f_H.y() << R"(,"z":)" << command.f_H.z() << "}}}}";
}

}  // namespace

std::optional<Label> Label::of(std::string_view text) {
  Label label;
  if (text.empty() || text.size() > label.text_.size() || !std::all_of(text.begin(), text.end(), isPlain))
    return std::nullopt;
  std::copy(text.begin(), text.end(), label.text_.begin());
  label.size_ = static_cast<std::uint8_t>(text.size());
  return label;
}

const DeviceReport* ServiceMessage::find(std::string_view id) const {
  const auto end = devices.begin() + static_cast<std::ptrdiff_t>(count);
  const auto found =
      std::find_if(devices.begin(), end, [&](const DeviceReport& device) { return device.id.view() == id; });
  return found == end ? nullptr : &*found;
}

const char* describe(ReadError error) {
  switch (error) {
    case ReadError::kNone:
      return "nothing is wrong";
    case ReadError::kTooLong:
      return "it is longer than 64 KiB";
    case ReadError::kNotJson:
      return "it isn't JSON, or nests deeper than 8";
    case ReadError::kWrongType:
      return "a value has the wrong type";
    case ReadError::kOutOfRange:
      return "a number is out of range";
    case ReadError::kMissingComponent:
      return "a vector lacks a component";
    case ReadError::kTwice:
      return "a key or a device comes twice";
    case ReadError::kTooManyDevices:
      return "it has more than 16 devices";
    case ReadError::kNoId:
      return "a device has no id";
  }
  return "unknown";
}

std::string_view writeForces(std::span<char, kMostCommand> buffer, std::span<const ForceCommand> commands,
                             ForceSpelling spelling, std::string_view profile, bool full_state) {
  Writer out(buffer);
  out << "{";
  if (!profile.empty() || full_state) out << R"("session":{)";
  if (!profile.empty()) out << R"("configure":{"profile":{"name":")" << profile << "\"}}";
  if (!profile.empty() && full_state) out << ",";
  if (full_state) out << R"("force_render_full_state":{})";
  if (!profile.empty() || full_state) out << "},";
  out << R"("inverse3":[)";
  for (std::size_t i = 0; i < commands.size(); ++i) {
    if (i > 0) out << ",";
    writeForce(out, commands[i], spelling);
  }
  out << "]}";
  return out.text();
}

std::string_view writeProbes(std::span<char, kMostCommand> buffer, std::span<const ForceCommand> devices) {
  Writer out(buffer);
  out << R"({"inverse3":[)";
  for (std::size_t i = 0; i < devices.size(); ++i) {
    out << (i > 0 ? "," : "") << R"({"device_id":")" << devices[i].id.view()
        << R"(","commands":{"probe_position":{}}})";
  }
  out << "]}";
  return out.text();
}

}  // namespace pincer::devices::haply
