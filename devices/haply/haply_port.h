// haply_port: the connection to Haply's service: one WebSocket for commands and states, one for its
// events, and HTTP. Implemented by haply_port_beast.cpp; nobody else names a network library. Loopback
// only: forces over a network aren't safe.
#pragma once
#include <cstdint>
#include <functional>
#include <memory>
#include <optional>
#include <string>
#include <string_view>

namespace pincer::devices::haply {

struct ServicePlace {
  std::string host = "127.0.0.1";
  std::uint16_t port = 10001, events_port = 10020;
};
// "127.0.0.1:10001", "127.0.0.1:10001:10020" with the event channel's port.
// Absent: it is none, or isn't on this computer.
std::optional<ServicePlace> servicePlaceOf(std::string_view text);

// Takes all that comes in; called from wait().
class PortSink {
 public:
  virtual ~PortSink() = default;
  virtual void received(std::string_view text) = 0;
  virtual void heard(std::string_view event) = 0;
};

class HaplyPort {
 public:
  virtual ~HaplyPort() = default;
  // Both are true from the start, until the connection is lost.
  virtual bool open() const = 0;
  virtual bool eventsOpen() const = 0;
  // Queues a text, kMostCommand bytes at the most, and sends it; dropped where
  // the connection is closed, or 8 are queued.
  virtual void send(std::string_view text) = 0;
  // Gives `sink` all that came, then waits until `until` of the monotonic clock [ns],
  // something comes or `wake_fd` can be read.
  virtual void wait(std::int64_t until, int wake_fd, PortSink& sink) = 0;
  // The close frame; waits for the other's at most 50 ms.
  virtual void close() = 0;
  // The descriptor of the command channel, -1 when closed; for a handler of signals (last_zero.h).
  virtual int descriptor() const = 0;
};

// Throws std::runtime_error with a sentence and the remedy where nobody answers as a WebSocket within `timeout` [s].
std::unique_ptr<HaplyPort> openHaplyPort(const ServicePlace& place, bool events, double timeout);
using OpenHaplyPort = std::function<std::unique_ptr<HaplyPort>(const ServicePlace&, bool events, double timeout)>;

struct HttpAnswer {
  int status = 0;
  std::string body;
};
// GET. Absent: nobody answers as HTTP within `timeout` [s].
std::optional<HttpAnswer> httpGet(const ServicePlace& place, const std::string& target, double timeout);

}  // namespace pincer::devices::haply
