// haply_server: the emulated service behind real sockets of this computer, in real time: WebSocket and HTTP on one
// port, events on another.
//
// Its threads live as long as it does: one turns the devices, one per connection answers, in real-time priority where
// permitted: what else runs on this computer is no fault of a service. `live` is called every millisecond of the
// devices' time: there a simulated hand may hold the arms. Faults of the wire are done here, the others by the service.
#pragma once
#include <chrono>
#include <cstdint>
#include <functional>
#include <memory>
#include <string>

#include "pincer/devices/emulate/haply_service.h"

namespace pincer::devices::emulate {

class HaplyServer {
 public:
  // Ports 0 are free ones. Throws std::runtime_error where a port is taken.
  explicit HaplyServer(const HaplyServiceSettings& settings = {}, std::uint16_t port = 0, std::uint16_t events_port = 0,
                       std::function<void(HaplyService&)> live = {});
  ~HaplyServer();

  std::uint16_t port() const;
  std::uint16_t eventsPort() const;
  std::string place() const;  // as --service takes it
  // The service, alone for as long as `use` runs.
  void with(const std::function<void(HaplyService&)>& use);
  void setFault(HaplyFault fault);
  void setDelay(std::chrono::milliseconds delay);  // of an answer, with HaplyFault::kLate
  // Force on the arm's tip now [N], and when it became zero last (monotonic clock) [ns].
  double force(std::size_t arm);
  std::int64_t zeroSince(std::size_t arm);
  int connections() const;
  // Gives back what ended connections have left: their threads. While connections() is 0.
  void forget();

 private:
  struct Parts;
  std::unique_ptr<Parts> parts_;
};

}  // namespace pincer::devices::emulate
