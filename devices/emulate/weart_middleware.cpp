#include "pincer/devices/emulate/weart_middleware.h"

#include <arpa/inet.h>
#include <fmt/format.h>
#include <netinet/in.h>
#include <netinet/tcp.h>
#include <poll.h>
#include <sys/socket.h>
#include <unistd.h>

#include <algorithm>
#include <array>
#include <atomic>
#include <cstdlib>
#include <mutex>
#include <sstream>
#include <stdexcept>
#include <thread>
#include <vector>

#include "pincer/devices/usb/usb_bus.h"

namespace pincer::devices::emulate {
namespace {

constexpr int kLook = 5;             // [ms]
constexpr std::int64_t kTells = 20;  // its status once in so many looks

std::vector<std::string> fieldsOf(const std::string& text) {
  std::vector<std::string> fields;
  std::istringstream stream(text);
  for (std::string field; std::getline(stream, field, ':');) fields.push_back(field);
  return fields;
}

}  // namespace

struct WeartMiddleware::Parts {
  struct Press {
    double level = 0;
    std::int64_t ns = 0;
  };
  mutable std::mutex one;  // of all below
  std::map<std::string, Press> presses;
  std::int64_t commands = 0, unknown = 0;
  bool started = false;
  WeartFault fault = WeartFault::kNone;
  std::atomic<bool> end{false};
  int listener = -1;
  std::uint16_t port = 0;
  std::thread thread;

  void listen(std::uint16_t wanted) {
    listener = ::socket(AF_INET, SOCK_STREAM | SOCK_CLOEXEC, 0);
    const int one_more = 1;
    ::setsockopt(listener, SOL_SOCKET, SO_REUSEADDR, &one_more, sizeof one_more);
    sockaddr_in place{};
    place.sin_family = AF_INET;
    place.sin_port = htons(wanted);
    place.sin_addr.s_addr = htonl(INADDR_LOOPBACK);
    socklen_t size = sizeof place;
    if (::bind(listener, reinterpret_cast<sockaddr*>(&place), size) != 0 || ::listen(listener, 1) != 0) {
      ::close(listener);
      throw std::runtime_error(fmt::format(
          "The emulator can't listen at port {}. Does WEART's Middleware run here? Another port: --port.", wanted));
    }
    ::getsockname(listener, reinterpret_cast<sockaddr*>(&place), &size);
    port = ntohs(place.sin_port);
  }

  void run() {
    while (!end) {
      pollfd watched{listener, POLLIN, 0};
      if (::poll(&watched, 1, kLook) != 1) continue;
      const int client = ::accept4(listener, nullptr, nullptr, SOCK_CLOEXEC);
      if (client < 0) continue;
      const int at_once = 1;
      ::setsockopt(client, IPPROTO_TCP, TCP_NODELAY, &at_once, sizeof at_once);
      serve(client);
      ::close(client);
      const std::lock_guard lock(one);
      for (auto& [name, press] : presses) set(press, 0);
      started = false;
    }
  }
  void serve(int client) {
    std::string text;
    for (std::int64_t look = 0; !end; ++look) {
      pollfd watched{client, POLLIN, 0};
      if (::poll(&watched, 1, kLook) == 1) {
        std::array<char, 4096> bytes;
        const ssize_t count = ::recv(client, bytes.data(), bytes.size(), 0);
        if (count <= 0) return;
        text.append(bytes.data(), static_cast<std::size_t>(count));
        take(text);
      }
      const std::lock_guard lock(one);
      if (fault == WeartFault::kHangsUp) return;
      if (started && look % kTells == 0) tell(client);
    }
  }
  // All whole messages of `text`, which are taken out of it.
  void take(std::string& text) {
    const std::lock_guard lock(one);
    for (std::size_t end_of = text.find('~'); end_of != std::string::npos; end_of = text.find('~')) {
      obey(text.substr(0, end_of));
      text.erase(0, end_of + 1);
    }
  }
  void obey(const std::string& message) {
    const std::vector<std::string> fields = fieldsOf(message);
    const std::string verb = fields.empty() ? "" : fields[0];
    if (verb == "StartFromClient") {
      started = true;
    } else if (verb == "StopFromClient") {
      started = false;
    } else if (verb == "force" && fields.size() == 6) {
      ++commands;
      set(presses[fields[4] + ":" + fields[5]], std::strtod(fields[1].c_str(), nullptr));
    } else if (verb == "stopForce" && fields.size() == 3) {
      ++commands;
      set(presses[fields[1] + ":" + fields[2]], 0);
    } else {
      ++unknown;
    }
  }
  static void set(Press& press, double level) {
    if (press.level != level) press.ns = usb::monotonicNs();
    press.level = level;
  }
  void tell(int client) const {
    const bool runs = fault != WeartFault::kNotRunning && fault != WeartFault::kStops;
    std::string text = fmt::format(
        R"({{"type":"MW_STATUS","ts":1,"data":{{"status":"{}","version":"2.0.0","statusCode":0,"errorDesc":"","actuationsEnabled":{},"connectedDevices":[{{"macAddress":"00:11","handSide":"RIGHT"}}]}}}}~)",
        runs ? "RUNNING" : "IDLE", fault != WeartFault::kPassesNothingOn);
    if (fault == WeartFault::kGlued)
      text = "Tracking:TrackType1:0.1:0.2~{\"type\":\"NEW\",\"data\":[1,{}]}~~" + text + "Tracking:~";
    if (fault == WeartFault::kOverlong) text = std::string(100'000, 'x') + "~" + text;
    const std::size_t piece = fault == WeartFault::kPieces ? 1 : text.size();
    for (std::size_t at = 0; at < text.size(); at += piece) {
      if (::send(client, text.data() + at, std::min(piece, text.size() - at), MSG_NOSIGNAL) < 0) return;
    }
  }
};

WeartMiddleware::WeartMiddleware(std::uint16_t port) : parts_(std::make_unique<Parts>()) {
  parts_->listen(port);
  parts_->thread = std::thread([this] { parts_->run(); });
}

WeartMiddleware::~WeartMiddleware() {
  parts_->end = true;
  parts_->thread.join();
  ::close(parts_->listener);
}

std::uint16_t WeartMiddleware::port() const { return parts_->port; }

void WeartMiddleware::setFault(WeartFault fault) {
  const std::lock_guard lock(parts_->one);
  parts_->fault = fault;
}

double WeartMiddleware::level(const std::string& thimble) const {
  const std::lock_guard lock(parts_->one);
  return parts_->presses[thimble].level;
}

double WeartMiddleware::levelOf(const std::string& thimble) const {
  return std::max(level("RIGHT:" + thimble), level("LEFT:" + thimble));
}

std::int64_t WeartMiddleware::since(const std::string& thimble) const {
  const std::lock_guard lock(parts_->one);
  return parts_->presses[thimble].ns;
}

std::int64_t WeartMiddleware::commands() const {
  const std::lock_guard lock(parts_->one);
  return parts_->commands;
}

std::int64_t WeartMiddleware::unknown() const {
  const std::lock_guard lock(parts_->one);
  return parts_->unknown;
}

bool WeartMiddleware::started() const {
  const std::lock_guard lock(parts_->one);
  return parts_->started;
}

}  // namespace pincer::devices::emulate
