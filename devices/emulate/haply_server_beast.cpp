#include <fmt/format.h>
#include <sys/socket.h>

#include <algorithm>
#include <array>
#include <atomic>
#include <boost/asio/io_context.hpp>
#include <boost/asio/ip/tcp.hpp>
#include <boost/beast/core.hpp>
#include <boost/beast/http.hpp>
#include <boost/beast/websocket.hpp>
#include <list>
#include <mutex>
#include <stdexcept>
#include <thread>
#include <utility>

#include "pincer/devices/emulate/haply_server.h"
#include "pincer/devices/hurry.h"
#include "pincer/devices/usb/usb_bus.h"

namespace pincer::devices::emulate {
namespace {

namespace beast = boost::beast;
namespace http = beast::http;
namespace websocket = beast::websocket;
using boost::asio::ip::tcp;
using Error = beast::error_code;
using Socket = websocket::stream<tcp::socket>;

constexpr auto kTurn = std::chrono::microseconds(500);  // of the devices' time
constexpr auto kLook = std::chrono::microseconds(200);  // at sockets
constexpr double kLongestTurn = 0.02;  // the devices stand still while this computer is away for longer [s]

// One text as a server's frame by hand, for what Beast won't do.
std::string frameOf(std::string_view text) {
  std::string frame = "\x81";
  if (text.size() < 126) {
    frame += static_cast<char>(text.size());
  } else {
    frame += {'\x7e', static_cast<char>(text.size() >> 8), static_cast<char>(text.size() & 255)};
  }
  return frame.append(text);
}

// The header and what follows it byte by byte; all of it would take longer than a session waits.
void writeInPieces(tcp::socket& socket, const std::string& frame) {
  constexpr std::size_t kSingly = 40;  // [bytes], chosen: the header and some of the text
  const std::size_t singly = std::min(frame.size(), kSingly);
  for (std::size_t i = 0; i < singly; ++i) boost::asio::write(socket, boost::asio::buffer(&frame[i], 1));
  boost::asio::write(socket, boost::asio::buffer(frame.data() + singly, frame.size() - singly));
}

void writeFragments(Socket& socket, std::string_view text) {
  for (std::size_t at = 0; at < text.size(); at += 100) {
    const auto piece = text.substr(at, 100);
    socket.write_some(at + 100 >= text.size(), boost::asio::buffer(piece.data(), piece.size()));
  }
}

}  // namespace

struct HaplyServer::Parts {
  explicit Parts(const HaplyServiceSettings& settings) : service(settings) {}

  boost::asio::io_context io;
  tcp::acceptor states{io}, events{io};
  std::mutex one;  // of all below
  HaplyService service;
  std::function<void(HaplyService&)> live;
  std::vector<std::int64_t> zero_since;
  std::list<tcp::socket*> sockets;
  std::vector<std::string> told;                                                  // events, all of them
  std::chrono::steady_clock::time_point last = std::chrono::steady_clock::now();  // of catchUp()
  double lived = 0;                                                               // of it, not yet told to `live` [s]
  std::atomic<bool> end{false};
  std::atomic<std::int64_t> delay_ms{0};
  std::atomic<int> connections{0};
  std::list<std::thread> threads;
  std::list<std::thread> clients;

  void open(tcp::acceptor& acceptor, std::uint16_t port) {
    const tcp::endpoint place(boost::asio::ip::address_v4::loopback(), port);
    acceptor.open(place.protocol());
    acceptor.set_option(tcp::acceptor::reuse_address(true));
    acceptor.bind(place);
    acceptor.listen();
  }

  void turn() {
    while (!end) {
      std::this_thread::sleep_for(kTurn);
      const std::lock_guard lock(one);
      catchUp();
    }
  }
  // The devices, to now; under the lock. Before each answer as well: a busy machine may leave turn() out for long,
  // and a place that stands still although the force changed looks like a frozen encoder.
  void catchUp() {
    const auto now = std::chrono::steady_clock::now();
    const double dt = std::min(kLongestTurn, std::chrono::duration<double>(now - last).count());
    last = now;
    service.advance(dt);
    for (lived += dt; lived >= 1e-3; lived -= 1e-3) {
      if (live) live(service);
    }
    watch();
  }
  // Under the lock, whenever a force may have changed.
  void watch() {
    for (std::size_t i = 0; i < service.arms(); ++i) {
      const bool zero = service.plant(i).force_D().isZero(0);
      if (!zero) zero_since[i] = 0;
      if (zero && zero_since[i] == 0) zero_since[i] = usb::monotonicNs();
    }
  }

  template <typename Serve>
  void accept(tcp::acceptor& acceptor, Serve serve) {
    while (!end) {
      auto socket = std::make_shared<tcp::socket>(io);
      Error error;
      acceptor.accept(*socket, error);
      if (error || end) return;
      const std::lock_guard lock(one);
      sockets.push_back(socket.get());
      clients.emplace_back([this, socket, serve] {
        hurryThisThread(kEmulatorPriority);
        ++connections;
        try {
          serve(*socket);
        } catch (const std::exception&) {  // the client went, or sent what no service understands
        }
        --connections;
        const std::lock_guard gone(one);
        sockets.remove(socket.get());
      });
    }
  }

  void serveStates(tcp::socket& tcp_socket) {
    tcp_socket.set_option(tcp::no_delay(true));
    beast::flat_buffer buffer;
    http::request<http::string_body> request;
    http::read(tcp_socket, buffer, request);
    if (!websocket::is_upgrade(request)) return answerHttp(tcp_socket, request);
    Socket socket(std::move(tcp_socket));
    socket.accept(request);
    socket.text(true);
    const Connected session(*this, socket);
    while (!end) serveOne(socket, session.number, buffer);
  }
  // A session of the service for as long as its connection lives.
  struct Connected {
    Connected(Parts& all, Socket& socket) : parts(all), socket_now(&socket.next_layer()) {
      std::string inventory;
      {
        const std::lock_guard lock(parts.one);
        parts.sockets.push_back(socket_now);
        number = parts.service.connected(inventory);
      }
      parts.say(socket, inventory);
    }
    ~Connected() {
      const std::lock_guard lock(parts.one);
      parts.sockets.remove(socket_now);
      parts.service.disconnected(number);
    }
    Connected(const Connected&) = delete;
    Connected& operator=(const Connected&) = delete;
    Parts& parts;
    tcp::socket* socket_now;
    int number = 0;
  };

  void serveOne(Socket& socket, int session, beast::flat_buffer& buffer) {
    buffer.clear();
    socket.read(buffer);
    std::vector<std::string> answers;
    {
      const std::lock_guard lock(one);
      catchUp();
      answers = service.answer(session, {static_cast<const char*>(buffer.cdata().data()), buffer.size()});
      watch();
    }
    for (const std::string& answer : answers) say(socket, answer);
    while (faultNow() == HaplyFault::kHalfOpen && !end) std::this_thread::sleep_for(kLook);
  }
  HaplyFault faultNow() {
    const std::lock_guard lock(one);
    return service.fault();
  }
  void say(Socket& socket, const std::string& text) {
    switch (faultNow()) {
      case HaplyFault::kPieces:
        return writeInPieces(socket.next_layer(), frameOf(text));
      case HaplyFault::kFragments:
        return writeFragments(socket, text);
      case HaplyFault::kPings:
        socket.ping("pincer");
        break;
      case HaplyFault::kNoUtf8:
        boost::asio::write(socket.next_layer(), boost::asio::buffer(frameOf(text)));
        return;
      case HaplyFault::kHugeHeader:
        boost::asio::write(socket.next_layer(), boost::asio::buffer(std::string("\x81\x7f\0\0\0\0\1\0\0\0abc", 13)));
        return;
      case HaplyFault::kReset:
        socket.next_layer().set_option(boost::asio::socket_base::linger(true, 0));
        socket.next_layer().close();
        throw std::runtime_error("reset");
      case HaplyFault::kLate:
        std::this_thread::sleep_for(std::chrono::milliseconds(delay_ms));
        break;
      default:
        break;
    }
    socket.write(boost::asio::buffer(text));
  }
  void answerHttp(tcp::socket& socket, const http::request<http::string_body>& request) {
    http::response<http::string_body> response{http::status::ok, request.version()};
    {
      const std::lock_guard lock(one);
      response.body() = service.get({request.target().data(), request.target().size()});
    }
    if (response.body().empty()) response.result(http::status::not_found);
    response.keep_alive(false);
    response.prepare_payload();
    http::write(socket, response);
  }
  void serveEvents(tcp::socket& tcp_socket) {
    Socket socket(std::move(tcp_socket));
    socket.accept();
    socket.text(true);
    std::size_t next = 0;
    {
      const std::lock_guard lock(one);
      next = told.size();
    }
    while (!end && faultNow() != HaplyFault::kEventsClosed) {
      std::string event;
      {
        const std::lock_guard lock(one);
        for (std::string& fresh : service.takeEvents()) told.push_back(std::move(fresh));
        if (next < told.size()) event = told[next++];
      }
      if (event.empty()) {
        std::this_thread::sleep_for(kLook);
      } else {
        socket.write(boost::asio::buffer(event));
      }
      char byte = 0;
      const auto got = ::recv(socket.next_layer().native_handle(), &byte, 1, MSG_PEEK | MSG_DONTWAIT);
      if (got == 0 || (got > 0 && static_cast<unsigned char>(byte) == 0x88)) return;  // a client that closes
    }
  }
};

HaplyServer::HaplyServer(const HaplyServiceSettings& settings, std::uint16_t port, std::uint16_t events_port,
                         std::function<void(HaplyService&)> live)
    : parts_(std::make_unique<Parts>(settings)) {
  Parts& p = *parts_;
  p.live = std::move(live);
  p.zero_since.assign(settings.arms.size(), usb::monotonicNs());
  try {
    p.open(p.states, port);
    p.open(p.events, events_port);
  } catch (const boost::system::system_error& error) {
    throw std::runtime_error(
        fmt::format("The emulator can't listen at ports {} and {} ({}). Does Haply's service run here? Other ports: "
                    "--port, --events-port.",
                    port, events_port, error.code().message()));
  }
  p.threads.emplace_back([&p] {
    hurryThisThread(kEmulatorPriority);
    p.turn();
  });
  p.threads.emplace_back([&p] { p.accept(p.states, [&p](tcp::socket& socket) { p.serveStates(socket); }); });
  p.threads.emplace_back([&p] { p.accept(p.events, [&p](tcp::socket& socket) { p.serveEvents(socket); }); });
}

HaplyServer::~HaplyServer() {
  Parts& p = *parts_;
  p.end = true;
  for (tcp::acceptor* acceptor : {&p.states, &p.events}) ::shutdown(acceptor->native_handle(), SHUT_RDWR);
  for (std::thread& thread : p.threads) thread.join();
  {
    const std::lock_guard lock(p.one);
    for (tcp::socket* socket : p.sockets) {
      if (socket->is_open()) ::shutdown(socket->native_handle(), SHUT_RDWR);
    }
  }
  for (std::thread& thread : p.clients) thread.join();
}

std::uint16_t HaplyServer::port() const { return parts_->states.local_endpoint().port(); }

std::uint16_t HaplyServer::eventsPort() const { return parts_->events.local_endpoint().port(); }

std::string HaplyServer::place() const { return fmt::format("127.0.0.1:{}:{}", port(), eventsPort()); }

void HaplyServer::with(const std::function<void(HaplyService&)>& use) {
  const std::lock_guard lock(parts_->one);
  use(parts_->service);
  parts_->watch();
}

void HaplyServer::setFault(HaplyFault fault) {
  with([&](HaplyService& service) { service.setFault(fault); });
}

void HaplyServer::setDelay(std::chrono::milliseconds delay) { parts_->delay_ms = delay.count(); }

double HaplyServer::force(std::size_t arm) {
  const std::lock_guard lock(parts_->one);
  return parts_->service.plant(arm).force_D().norm();
}

std::int64_t HaplyServer::zeroSince(std::size_t arm) {
  const std::lock_guard lock(parts_->one);
  return parts_->zero_since[arm];
}

int HaplyServer::connections() const { return parts_->connections; }

void HaplyServer::forget() {
  std::list<std::thread> ended;
  {
    const std::lock_guard lock(parts_->one);
    ended.swap(parts_->clients);
  }
  for (std::thread& thread : ended) thread.join();
}

}  // namespace pincer::devices::emulate
