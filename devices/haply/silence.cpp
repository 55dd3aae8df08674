#include "pincer/devices/haply/silence.h"

#include <fmt/format.h>

#include <cmath>
#include <memory>
#include <optional>
#include <stdexcept>

#include "pincer/devices/haply/haply_session.h"
#include "pincer/devices/haply/last_zero.h"
#include "pincer/devices/usb/usb_bus.h"

namespace pincer::devices::haply {
namespace {

constexpr double kGentle = 0.2;  // up [N]
constexpr double kFar = 0.03;    // [m]
constexpr std::int64_t kPatience = 2000 * kMillisecond;
constexpr std::int64_t kReadyIn = 10000 * kMillisecond;
constexpr std::int64_t kPushes = 300 * kMillisecond;  // after arming: the echo's test, and a push that is well established
constexpr std::int64_t kLookPeriod = 2 * kMillisecond;
constexpr int kNobody = -1;  // no descriptor wakes the wait

// The session that commands.
class Pusher final : public PortSink {
 public:
  Pusher(const ServicePlace& place, const std::string& arm, const ServiceVersion& version)
      : port_(openHaplyPort(place, version.minor >= 4, 2)), session_(optionsOf(arm, version), usb::monotonicNs()) {}
  ~Pusher() override {
    if (!port_) return;
    session_.disarm(0);
    turn(100 * kMillisecond, [] { return false; });
    port_->close();
  }
  Pusher(const Pusher&) = delete;
  Pusher& operator=(const Pusher&) = delete;

  void received(std::string_view text) override { session_.received(text, usb::monotonicNs()); }
  void heard(std::string_view event) override { session_.heard(event, usb::monotonicNs()); }

  void push(const std::atomic<bool>& interrupted) {
    turn(kReadyIn, [&] { return session_.phase() == SessionPhase::kReady || session_.phase() == SessionPhase::kRefused || interrupted; });
    if (session_.phase() != SessionPhase::kReady) complain();
    session_.arm(0, usb::monotonicNs());
    session_.want(0, Vec3(0, 0, kGentle));
    turn(kPushes, [&] { return session_.doubted() || interrupted; });
    if (session_.doubted()) complain();
  }
  // Gone without a word.
  void vanish() { port_.reset(); }

 private:
  static SessionOptions optionsOf(const std::string& arm, const ServiceVersion& version) {
    SessionOptions options;
    options.arms = {{arm, ""}};
    options.version = version;
    options.profile = fmt::format("org.pincer:silence{}", usb::monotonicNs() % 100'000'000);
    return options;
  }
  [[noreturn]] void complain() const {
    throw std::runtime_error(session_.complaint().empty() ? "The Inverse3 didn't become ready." : session_.complaint());
  }
  template <typename Done>
  void turn(std::int64_t time, Done done) {
    for (const std::int64_t until = usb::monotonicNs() + time; port_->open() && usb::monotonicNs() < until && !done();) {
      const std::int64_t now = usb::monotonicNs();
      for (auto text = session_.next(now); !text.empty(); text = session_.next(now)) port_->send(text);
      port_->wait(now + kSendPeriod, kNobody, *this);
    }
  }

  std::unique_ptr<HaplyPort> port_;
  HaplySession session_;
};

// The session that looks.
class Watcher final : public PortSink {
 public:
  Watcher(const ServicePlace& place, const std::string& arm) : port_(openHaplyPort(place, false, 2)) { device_.id = *Label::of(arm); }
  void received(std::string_view text) override {
    ServiceMessage& message = *message_;
    if (readService(text, message) != ReadError::kNone) return;
    const DeviceReport* arm = message.find(device_.id.view());
    if (arm == nullptr) return;
    idle_ = arm->mode.view() == "idle" || (arm->f_H && arm->f_H->norm() < 0.5 * kGentle);
    if (arm->p_H) place_ = arm->p_H;
    if (!begin_) begin_ = place_;
  }
  void heard(std::string_view) override {}
  void look() {
    const std::int64_t now = usb::monotonicNs();
    port_->send(writeProbes(buffer_, std::span<const ForceCommand>(&device_, 1)));
    while (port_->open() && usb::monotonicNs() < now + kLookPeriod) port_->wait(now + kLookPeriod, kNobody, *this);
  }
  bool idle() const { return idle_; }
  double moved() const { return place_ && begin_ ? (*place_ - *begin_).norm() : 0; }

 private:
  std::unique_ptr<HaplyPort> port_;
  ForceCommand device_;
  std::unique_ptr<ServiceMessage> message_ = std::make_unique<ServiceMessage>();
  std::array<char, kMostCommand> buffer_{};
  std::optional<Vec3> begin_, place_;
  bool idle_ = false;
};

}  // namespace

SilenceFinding measureSilence(const ServicePlace& place, const std::string& arm, const ServiceVersion& version, Ending ending,
                              const std::atomic<bool>& interrupted) {
  if (!Label::of(arm)) throw std::runtime_error("That isn't the id of an Inverse3, as 049D.");
  LastZero::install();
  Pusher pusher(place, arm, version);
  Watcher watcher(place, arm);
  pusher.push(interrupted);
  watcher.look();
  SilenceFinding finding;
  const std::int64_t begin = usb::monotonicNs();
  if (ending == Ending::kClose) pusher.vanish();
  while (!finding.went_idle && watcher.moved() < kFar && usb::monotonicNs() - begin < kPatience && !interrupted) {
    watcher.look();
    finding.went_idle = watcher.idle();
  }
  finding.seconds = 1e-9 * static_cast<double>(usb::monotonicNs() - begin);
  finding.moved = watcher.moved();
  if (ending == Ending::kSilence) return finding;
  Pusher(place, arm, version).push(interrupted);  // takes it back, and lets it go with zeros
  return finding;
}

}  // namespace pincer::devices::haply
