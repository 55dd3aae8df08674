#include "pincer/devices/weart/weart_host.h"

#include <fmt/format.h>
#include <netdb.h>
#include <netinet/in.h>
#include <netinet/tcp.h>
#include <poll.h>
#include <sys/socket.h>
#include <unistd.h>

#include <algorithm>
#include <cerrno>
#include <cmath>
#include <stdexcept>

#include "pincer/devices/usb/usb_bus.h"

namespace pincer::devices::weart {
namespace {

constexpr std::int64_t kMs = 1'000'000;          // [ns]
constexpr std::int64_t kPressLives = 100 * kMs;  // without a tick: then zero
constexpr int kPeriod = 10;                      // between two levels [ms]

// Connected within `timeout` [s], or -1.
int connected(const addrinfo& place, double timeout) {
  const int fd = ::socket(place.ai_family, SOCK_STREAM | SOCK_CLOEXEC | SOCK_NONBLOCK, 0);
  if (fd < 0) return -1;
  const int one = 1;
  ::setsockopt(fd, IPPROTO_TCP, TCP_NODELAY, &one, sizeof one);
  int error = ::connect(fd, place.ai_addr, place.ai_addrlen) == 0 ? 0 : errno;
  if (error == EINPROGRESS) {
    pollfd ready{fd, POLLOUT, 0};
    socklen_t size = sizeof error;
    if (::poll(&ready, 1, static_cast<int>(1e3 * timeout)) != 1)
      error = ETIMEDOUT;
    else
      ::getsockopt(fd, SOL_SOCKET, SO_ERROR, &error, &size);
  }
  if (error == 0) return fd;
  ::close(fd);
  return -1;
}

int openSocket(const WeartOptions& options) {
  addrinfo wanted{};
  wanted.ai_family = AF_UNSPEC;
  wanted.ai_socktype = SOCK_STREAM;
  addrinfo* places = nullptr;
  int fd = -1;
  if (::getaddrinfo(options.host.c_str(), fmt::format("{}", options.port).c_str(), &wanted, &places) == 0) {
    for (const addrinfo* place = places; place != nullptr && fd < 0; place = place->ai_next)
      fd = connected(*place, options.timeout);
    ::freeaddrinfo(places);
  }
  if (fd >= 0) return fd;
  throw std::runtime_error(
      fmt::format("Nobody answers as WEART's Middleware at {}:{}. Start it (or WEART-App) there, permit its port in "
                  "the firewall; another "
                  "place: --pressure "
                  "HOST:PORT.",
                  options.host, options.port));
}

}  // namespace

class WeartHost::Display final : public PressureDisplay {
 public:
  Display(const WeartHost& host, Thimble thimble) : thimble(thimble), host_(host) {}

  std::string identity() const override { return "WEART TouchDIVER"; }
  DeviceState state() const override { return host_.running_ ? DeviceState::kReady : DeviceState::kFaulted; }
  void press(double normal_force) noexcept override {
    force_.store(std::isfinite(normal_force) ? normal_force : 0, std::memory_order_relaxed);
    ns_.store(usb::monotonicNs(), std::memory_order_release);
  }
  void stop() noexcept override { press(0); }

  double forceAt(std::int64_t now) const {
    return now - ns_.load(std::memory_order_acquire) > kPressLives ? 0 : force_.load(std::memory_order_relaxed);
  }
  const Thimble thimble;
  bool presses = false;  // the last level wasn't 0; the host's thread

 private:
  const WeartHost& host_;
  std::atomic<double> force_{0};
  std::atomic<std::int64_t> ns_{0};
};

WeartHost::WeartHost(const WeartOptions& options) : options_(options) {
  if (!(options_.full_force > 0)) throw std::runtime_error("The force of WEART's level 1 must be above 0 N.");
  for (const Thimble thimble : options_.thimbles) displays_.push_back(std::make_unique<Display>(*this, thimble));
  socket_ = openSocket(options_);
  bool there = say(kStart);
  const std::int64_t until = usb::monotonicNs() + static_cast<std::int64_t>(1e9 * options_.timeout);
  while (there && !running_ && usb::monotonicNs() < until) there = hear(kPeriod);
  if (!running_) {
    ::close(socket_);
    throw std::runtime_error(
        fmt::format("The program at {}:{} doesn't say that it runs, as WEART's Middleware does. Is the TouchDIVER "
                    "connected and calibrated there?",
                    options_.host, options_.port));
  }
  begun_ = true;
  thread_ = std::thread([this] { run(); });
}

WeartHost::~WeartHost() {
  end_ = true;
  thread_.join();
  ::close(socket_);
}

PressureDisplay& WeartHost::display(std::size_t i) { return *displays_[i]; }

std::string WeartHost::complaint() {
  const std::lock_guard lock(slow_);
  return complaint_;
}

void WeartHost::doubt(const std::string& why) {
  running_ = false;
  const std::lock_guard lock(slow_);
  if (complaint_.empty()) complaint_ = why;
}

void WeartHost::run() {
  while (!end_) {
    if (!pressAll(usb::monotonicNs()) || !hear(kPeriod)) {
      doubt("The connection to WEART's Middleware is lost, and with it the pressure. Start the session again.");
      return;
    }
    if (!running_)
      doubt("WEART's Middleware doesn't run any more, or passes nothing on. Look at it, then start the session again.");
  }
  pressAll(0);
  say(kStop);
}

// `now` 0: the last word.
bool WeartHost::pressAll(std::int64_t now) {
  TextBuffer buffer;
  bool well = true;
  for (const auto& display : displays_) {
    const double level = now == 0 || !running_ ? 0 : display->forceAt(now) / options_.full_force;
    if (level > 0) {
      well &= say(writeForce(buffer, level, options_.hand, display->thimble));
    } else if (display->presses || now == 0) {
      well &= say(writeForce(buffer, 0, options_.hand, display->thimble)) &&
              say(writeStopForce(buffer, options_.hand, display->thimble));
    }
    display->presses = level > 0;
  }
  return well;
}

// A level that the network doesn't take at once is old when it does: a full queue counts as a lost connection.
bool WeartHost::say(std::string_view text) {
  return ::send(socket_, text.data(), text.size(), MSG_NOSIGNAL | MSG_DONTWAIT) == static_cast<ssize_t>(text.size());
}

bool WeartHost::hear(int milliseconds) {
  const std::int64_t until = usb::monotonicNs() + milliseconds * kMs;
  for (std::int64_t left = milliseconds; left >= 0; left = (until - usb::monotonicNs()) / kMs) {
    pollfd watched{socket_, POLLIN, 0};
    if (::poll(&watched, 1, static_cast<int>(left)) == 0) return true;
    std::array<char, 4096> bytes;
    const ssize_t count = ::recv(socket_, bytes.data(), bytes.size(), MSG_DONTWAIT);
    if (count == 0 || (count < 0 && errno != EAGAIN && errno != EINTR)) return false;
    if (count < 0) continue;
    cutter_.add({bytes.data(), static_cast<std::size_t>(count)}, [&](std::string_view message) {
      if (const auto status = readStatus(message))
        running_ = (running_ || !begun_) && status->running && status->actuates;
    });
  }
  return true;
}

}  // namespace pincer::devices::weart
