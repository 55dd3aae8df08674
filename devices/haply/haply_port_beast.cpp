#include <fmt/format.h>
#include <poll.h>

#include <algorithm>
#include <array>
#include <boost/asio/io_context.hpp>
#include <boost/asio/ip/tcp.hpp>
#include <boost/beast/core.hpp>
#include <boost/beast/http.hpp>
#include <boost/beast/websocket.hpp>
#include <chrono>
#include <stdexcept>
#include <utility>

#include "pincer/devices/haply/haply_messages.h"
#include "pincer/devices/haply/haply_port.h"
#include "pincer/devices/usb/usb_bus.h"

namespace pincer::devices::haply {
namespace {

namespace beast = boost::beast;
namespace websocket = beast::websocket;
using boost::asio::ip::tcp;
using Error = beast::error_code;

constexpr std::size_t kQueue = 9;                           // messages: the 8 that may be unanswered, and one
constexpr auto kCloseTime = std::chrono::milliseconds(50);  // for the other side's close frame

tcp::endpoint endpointOf(std::uint16_t port) { return {boost::asio::ip::address_v4::loopback(), port}; }

std::chrono::nanoseconds nanoseconds(double s) { return std::chrono::nanoseconds(static_cast<std::int64_t>(1e9 * s)); }

// One WebSocket. Its text goes to `take` as it comes.
class Channel {
 public:
  using Take = void (PortSink::*)(std::string_view);

  Channel(boost::asio::io_context& io, Take take) : io_(io), socket_(io), take_(take) {
    socket_.read_message_max(kMostMessage);
    socket_.auto_fragment(false);
    socket_.text(true);
  }

  // The error's text, empty where the handshake was done in time.
  std::string open(std::uint16_t port, std::chrono::nanoseconds timeout) {
    Error result;
    bool done = false;
    const auto finish = [&](Error error) { result = error, done = true; };
    auto& tcp_socket = socket_.next_layer();
    tcp_socket.async_connect(endpointOf(port), [&](Error error) {
      if (!error) tcp_socket.set_option(tcp::no_delay(true), error);
      if (error) return finish(error);
      socket_.async_handshake(fmt::format("localhost:{}", port), "/", finish);
    });
    io_.restart();
    for (const auto until = std::chrono::steady_clock::now() + timeout; !done && io_.run_one_until(until) > 0;) {
    }
    const bool in_time = done;
    if (!in_time) {
      Error ignored;
      tcp_socket.close(ignored);
      while (!done && io_.run_one() > 0) {  // what hangs there ends before its variables do
      }
    }
    open_ = in_time && !result;
    listen();
    return open_ ? "" : in_time ? result.message() : "no answer in time";
  }
  bool isOpen() const { return open_; }
  int descriptor() const { return open_ ? const_cast<Channel*>(this)->socket_.next_layer().native_handle() : -1; }
  short interest() const { return static_cast<short>(queued_ > 0 ? POLLIN | POLLOUT : POLLIN); }

  void send(std::string_view text) {
    if (!open_ || queued_ == kQueue || text.size() > kMostCommand) return;
    Slot& slot = slots_[(first_ + queued_) % kQueue];
    text.copy(slot.bytes.data(), text.size());
    slot.size = text.size();
    if (++queued_ == 1) write();
  }
  void deliver(PortSink& sink) {
    if (!arrived_) return;
    arrived_ = false;
    const auto data = in_.cdata();
    (sink.*take_)({static_cast<const char*>(data.data()), data.size()});
    in_.consume(in_.size());
    listen();
  }
  bool arrived() const { return arrived_; }
  void close() {
    if (!open_) return;
    bool done = false;
    socket_.async_close(websocket::close_code::normal, [&](Error) { done = true; });
    const auto until = std::chrono::steady_clock::now() + kCloseTime;
    io_.restart();
    while (!done && io_.run_one_until(until) > 0) {
    }
    Error ignored;
    socket_.next_layer().close(ignored);
    open_ = false;
    io_.restart();
    io_.run_for(kCloseTime);
  }

 private:
  struct Slot {
    std::array<char, kMostCommand> bytes;
    std::size_t size = 0;
  };
  void listen() {
    if (!open_) return;
    socket_.async_read(in_, [this](Error error, std::size_t) {
      arrived_ = !error;
      open_ = open_ && !error;
    });
  }
  void write() {
    const Slot& slot = slots_[first_];
    socket_.async_write(boost::asio::buffer(slot.bytes.data(), slot.size), [this](Error error, std::size_t) {
      first_ = (first_ + 1) % kQueue;
      --queued_;
      open_ = open_ && !error;
      if (open_ && queued_ > 0) write();
    });
  }

  boost::asio::io_context& io_;
  websocket::stream<tcp::socket> socket_;
  Take take_;
  beast::flat_buffer in_{kMostMessage + 64};
  std::array<Slot, kQueue> slots_;
  std::size_t first_ = 0, queued_ = 0;
  bool open_ = false, arrived_ = false;
};

class BeastPort final : public HaplyPort {
 public:
  BeastPort(const ServicePlace& place, bool events, double timeout) {
    const std::string why = states_.open(place.port, nanoseconds(timeout));
    if (!why.empty()) {
      throw std::runtime_error(
          fmt::format("Nobody answers as Haply's service at {}:{} ({}). Start it: systemctl start "
                      "haply-inverse-service.service; another "
                      "port: --service HOST:PORT (docs/devices/haply.md).",
                      place.host, place.port, why));
    }
    const std::string deaf = events ? events_.open(place.events_port, nanoseconds(timeout)) : "";
    if (!deaf.empty()) {
      throw std::runtime_error(fmt::format(
          "Haply's service doesn't tell its safety events at {}:{} ({}). Restart it; another port: --service "
          "HOST:PORT:EVENTS.",
          place.host, place.events_port, deaf));
    }
  }
  bool open() const override { return states_.isOpen(); }
  bool eventsOpen() const override { return events_.isOpen(); }
  void send(std::string_view text) override {
    states_.send(text);
    turn();
  }
  void wait(std::int64_t until, int wake_fd, PortSink& sink) override {
    turn();
    if (deliver(sink)) return;
    const std::int64_t left = std::max<std::int64_t>(0, until - usb::monotonicNs());
    const timespec time{left / 1'000'000'000, left % 1'000'000'000};
    std::array<pollfd, 3> watched{pollfd{wake_fd, POLLIN, 0}, pollfd{states_.descriptor(), states_.interest(), 0},
                                  pollfd{events_.descriptor(), events_.interest(), 0}};
    ::ppoll(watched.data(), watched.size(), &time, nullptr);
    turn();
    deliver(sink);
  }
  void close() override {
    states_.close();
    events_.close();
  }
  int descriptor() const override { return states_.descriptor(); }

 private:
  void turn() {
    io_.restart();
    io_.poll();
  }
  bool deliver(PortSink& sink) {
    bool any = false;
    while (states_.arrived() || events_.arrived()) {
      any = true;
      events_.deliver(sink);
      states_.deliver(sink);
      turn();
    }
    return any;
  }

  boost::asio::io_context io_{1};
  Channel states_{io_, &PortSink::received}, events_{io_, &PortSink::heard};
};

}  // namespace

std::unique_ptr<HaplyPort> openHaplyPort(const ServicePlace& place, bool events, double timeout) {
  return std::make_unique<BeastPort>(place, events, timeout);
}

std::optional<HttpAnswer> httpGet(const ServicePlace& place, const std::string& target, double timeout) {
  namespace http = beast::http;
  boost::asio::io_context io{1};
  beast::tcp_stream stream(io);
  beast::flat_buffer buffer(kMostMessage);
  http::request<http::empty_body> request{http::verb::get, target, 11};
  request.set(http::field::host, "localhost");
  request.set(http::field::connection, "close");
  http::response_parser<http::string_body> parser;
  parser.body_limit(kMostMessage);
  bool done = false;
  const auto read = [&](Error error, std::size_t) {
    if (!error) http::async_read(stream, buffer, parser, [&](Error end, std::size_t) { done = !end; });
  };
  stream.async_connect(endpointOf(place.port), [&](Error error) {
    if (!error) http::async_write(stream, request, read);
  });
  io.run_for(nanoseconds(timeout));
  if (!done) return std::nullopt;
  return HttpAnswer{static_cast<int>(parser.get().result_int()), parser.get().body()};
}

}  // namespace pincer::devices::haply
