#include "pincer/devices/haply/haply_port.h"

#include <charconv>

namespace pincer::devices::haply {
namespace {

std::optional<std::uint16_t> portIn(std::string_view text) {
  std::uint16_t port = 0;
  const auto [end, error] = std::from_chars(text.data(), text.data() + text.size(), port);
  if (error != std::errc{} || end != text.data() + text.size() || port == 0) return std::nullopt;
  return port;
}

}  // namespace

std::optional<ServicePlace> servicePlaceOf(std::string_view text) {
  const std::size_t colon = text.find(':');
  if (colon == std::string_view::npos) return std::nullopt;
  ServicePlace place;
  const std::string_view host = text.substr(0, colon);
  if (host != "localhost" && host != "127.0.0.1") return std::nullopt;
  std::string_view ports = text.substr(colon + 1);
  const std::size_t second = ports.find(':');
  if (second != std::string_view::npos) {
    const auto events = portIn(ports.substr(second + 1));
    if (!events) return std::nullopt;
    place.events_port = *events;
    ports = ports.substr(0, second);
  }
  const auto port = portIn(ports);
  if (!port) return std::nullopt;
  place.port = *port;
  return place;
}

}  // namespace pincer::devices::haply
