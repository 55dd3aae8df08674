#include "pincer/devices/haply/haply_host.h"

#include <fmt/format.h>
#include <poll.h>
#include <sys/eventfd.h>
#include <unistd.h>

#include <algorithm>
#include <cmath>
#include <stdexcept>

#include "pincer/devices/haply/last_zero.h"
#include "pincer/devices/hurry.h"
#include "pincer/devices/usb/usb_bus.h"

namespace pincer::devices::haply {
namespace {

constexpr std::int64_t kLeaving = 100 * kMillisecond;  // for zeros to arrive at the end
constexpr std::int64_t kShortestPause = 250 * kMillisecond, kLongestPause = 2000 * kMillisecond;  // between attempts

DeviceState stateOf(const HaplySession& session) {
  switch (session.phase()) {
    case SessionPhase::kHoming:
      return DeviceState::kHoming;
    case SessionPhase::kReady:
      return session.doubted() ? DeviceState::kFaulted : DeviceState::kReady;
    case SessionPhase::kRefused:
      return DeviceState::kFaulted;
    default:
      return DeviceState::kConnecting;
  }
}

}  // namespace

ServiceCheck checkService(const ServicePlace& place, double timeout) {
  const auto refuse = [&](const std::string& why) { return ServiceCheck{why, {}}; };
  const std::string where = fmt::format("{}:{}", place.host, place.port);
  const auto answer = httpGet(place, "/version", timeout);
  if (!answer)
    return refuse(
        fmt::format("Nobody answers as Haply's service at {}. Start it: systemctl start haply-inverse-service.service; "
                    "another port: "
                    "--service HOST:PORT (docs/devices/haply.md).",
                    where));
  const auto version = answer->status == 200 ? readVersion(answer->body) : std::nullopt;
  if (!version)
    return refuse(fmt::format(
        "The program at {} doesn't tell its version as Haply's service does (HTTP {}). Is another program on the port?",
        where, answer->status));
  if (version->major != 3 || version->minor < 1)
    return refuse(fmt::format(
        "Haply's service at {} is {}.{}; pincer knows 3.1 and later ones of 3. Install one: docs/devices/haply.md.",
        where, version->major, version->minor));
  const auto scale = httpGet(place, "/settings/devices/force_scale", timeout);
  const auto factor = scale && scale->status == 200 ? readNumber(scale->body) : std::nullopt;
  if (factor && *factor != 1)
    return refuse(
        fmt::format("Haply's service scales every force by {} (settings/devices/force_scale). Set it to 1 in Haply "
                    "Hub: pincer never "
                    "changes what counts for all programs.",
                    *factor));
  if (!factor && version->minor >= 5)
    return refuse(fmt::format("Haply's service at {} doesn't tell its force scale (HTTP {}). Restart it.", where,
                              scale ? scale->status : 0));
  return {"", *version};
}

// Hands all that comes in during one connection to its session, with the time.
class HaplyHost::Life final : public PortSink {
 public:
  Life(HaplyPort& port, HaplySession& session) : port_(port), session_(session) {}
  void received(std::string_view text) override { session_.received(text, usb::monotonicNs()); }
  void heard(std::string_view event) override { session_.heard(event, usb::monotonicNs()); }
  // Sends what is due.
  void speak(std::int64_t now) {
    for (auto text = session_.next(now); !text.empty(); text = session_.next(now)) {
      last_.writing(true);
      if (!LastZero::isLast()) port_.send(text);
      last_.writing(false);
    }
    const bool commands = session_.phase() == SessionPhase::kReady;
    if (commands == ready_ && session_.spelling() == spelling_) return;
    ready_ = commands;
    spelling_ = session_.spelling();
    last_.set(commands ? port_.descriptor() : -1, session_.zeros());
  }

 private:
  HaplyPort& port_;
  HaplySession& session_;
  LastZero last_;
  bool ready_ = false;
  ForceSpelling spelling_ = ForceSpelling::kVector;
};

HaplyHost::HaplyHost(HaplyHostOptions options, const OpenHaplyPort& open)
    : options_(std::move(options)), open_(open), wake_fd_(-1) {
  const ServiceCheck check = checkService(options_.service, options_.timeout);
  if (!check.problem.empty()) throw std::runtime_error(check.problem);
  version_ = check.version;
  for (const HaplyArmSettings& arm : options_.arms)
    arms_.push_back(std::make_unique<HaplyArm>(arm, [this] { wake(); }));
  auto port = open_(options_.service, version_.minor >= 4, options_.timeout);
  wake_fd_ = ::eventfd(0, EFD_NONBLOCK | EFD_CLOEXEC);
  if (wake_fd_ < 0) throw std::runtime_error("No file descriptor is free. Close programs, or raise `ulimit -n`.");
  thread_ = std::thread([this, port = std::move(port)]() mutable { run(std::move(port)); });
}

HaplyHost::~HaplyHost() {
  end_ = true;
  wake();
  thread_.join();
  ::close(wake_fd_);
}

void HaplyHost::wake() const noexcept {
  const std::uint64_t one = 1;
  [[maybe_unused]] const auto written = ::write(wake_fd_, &one, sizeof one);
}

void HaplyHost::setEpoch(std::int64_t ns) {
  for (const auto& arm : arms_) arm->setEpoch(ns);
}

std::string HaplyHost::complaint() {
  const std::lock_guard lock(slow_);
  return complaint_;
}

SessionCounts HaplyHost::counts() {
  const std::lock_guard lock(slow_);
  return counts_;
}

void HaplyHost::waitReady(double timeout) {
  const std::int64_t until = usb::monotonicNs() + static_cast<std::int64_t>(1e9 * timeout);
  const auto all = [&](DeviceState state) {
    return std::all_of(arms_.begin(), arms_.end(), [&](const auto& a) { return a->state() == state; });
  };
  while (!all(DeviceState::kReady)) {
    const std::string why = complaint();
    if (!why.empty() && all(DeviceState::kFaulted)) throw std::runtime_error(why);
    if (usb::monotonicNs() > until)
      throw std::runtime_error(
          why.empty()
              ? "The Inverse3 didn't become ready. Calibrate it: hold the grip's magnet to the mark until its light is "
                "white."
              : why);
    std::this_thread::sleep_for(std::chrono::milliseconds(2));
  }
}

bool HaplyHost::anyArmed() const {
  return std::any_of(arms_.begin(), arms_.end(), [](const auto& arm) { return !arm->stopped(); });
}

SessionOptions HaplyHost::sessionOptions() {
  SessionOptions session;
  for (const HaplyArmSettings& arm : options_.arms) session.arms.push_back({arm.id, arm.grip});
  session.version = version_;
  session.trips = &trips_;
  session.gate_gain = options_.gate_gain;
  session.profile = fmt::format("org.pincer:{:08x}", static_cast<std::uint32_t>(usb::monotonicNs() / 1000) ^
                                                         static_cast<std::uint32_t>(::getpid()));
  return session;
}

void HaplyHost::note(const std::string& complaint) {
  const std::lock_guard lock(slow_);
  complaint_ = complaint;
}

void HaplyHost::tell(const HaplySession& session, bool open) {
  for (std::size_t i = 0; i < arms_.size(); ++i) {
    arms_[i]->publish(open ? session.reading(i) : ArmReading{}, open ? stateOf(session) : DeviceState::kFaulted);
  }
}

void HaplyHost::run(std::unique_ptr<HaplyPort> port) {
  hurryThisThread(kServicePriority);
  while (port) {
    live(*port);
    port.reset();
    if (!end_) port = reconnect();
  }
}

void HaplyHost::live(HaplyPort& port) {
  HaplySession session(sessionOptions(), usb::monotonicNs());
  Life life(port, session);
  std::string told;
  while (!end_ && port.open() && session.phase() != SessionPhase::kRefused) {
    std::int64_t now = usb::monotonicNs();
    if (version_.minor >= 4) session.eventsAre(port.eventsOpen(), now);
    for (std::size_t i = 0; i < arms_.size(); ++i) arms_[i]->bring(session, i, now);
    life.speak(now);
    tell(session, true);
    if (session.complaint() != told && !session.complaint().empty()) note(session.complaint());
    told = session.complaint();
    sleepUntilWoken(0);
    port.wait(usb::monotonicNs() + kSendPeriod / 2, wake_fd_, life);
    now = usb::monotonicNs();
    const std::unique_lock lock(slow_, std::try_to_lock);
    if (lock.owns_lock()) counts_ = session.counts();
  }
  if (!port.open())
    note("The connection to Haply's service is lost. Is it running? systemctl status haply-inverse-service.service");
  if (session.phase() == SessionPhase::kRefused) note(session.complaint());
  tell(session, false);
  leave(port, session, life);
}

// Zeros, each answered, then the close frame.
void HaplyHost::leave(HaplyPort& port, HaplySession& session, Life& life) {
  for (std::size_t i = 0; i < arms_.size(); ++i) session.disarm(i);
  const std::int64_t until = usb::monotonicNs() + kLeaving;
  for (std::int64_t now = usb::monotonicNs(); port.open() && now < until; now = usb::monotonicNs()) {
    life.speak(now);
    sleepUntilWoken(0);
    port.wait(now + kSendPeriod, wake_fd_, life);
  }
  port.close();
}

// Reads the wake-up away; waits for one until `until` [ns].
void HaplyHost::sleepUntilWoken(std::int64_t until) {
  const std::int64_t left = std::max<std::int64_t>(0, until - usb::monotonicNs());
  pollfd watched{wake_fd_, POLLIN, 0};
  std::uint64_t count = 0;
  if (left > 0) ::poll(&watched, 1, static_cast<int>(left / kMillisecond + 1));
  [[maybe_unused]] const auto got = ::read(wake_fd_, &count, sizeof count);
}

// Only while no arm is armed: whoever is in a device has to see that it ended first. Null at the end of the host.
std::unique_ptr<HaplyPort> HaplyHost::reconnect() {
  for (std::int64_t pause = kShortestPause; !end_; pause = std::min(2 * pause, kLongestPause)) {
    const std::int64_t until = usb::monotonicNs() + pause;
    while (!end_ && usb::monotonicNs() < until) sleepUntilWoken(until);
    if (end_ || anyArmed()) continue;
    const ServiceCheck check = checkService(options_.service, options_.timeout);
    if (!check.problem.empty()) {
      note(check.problem);
      continue;
    }
    try {
      version_ = check.version;
      return open_(options_.service, version_.minor >= 4, options_.timeout);
    } catch (const std::runtime_error& error) {
      note(error.what());
    }
  }
  return nullptr;
}

}  // namespace pincer::devices::haply
