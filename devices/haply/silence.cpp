#include "pincer/devices/haply/silence.h"

#include <fmt/format.h>

#include <cmath>
#include <memory>
#include <optional>
#include <stdexcept>
#include <string>
#include <utility>

#include "pincer/devices/haply/haply_session.h"
#include "pincer/devices/haply/last_zero.h"
#include "pincer/devices/usb/usb_bus.h"

namespace pincer::devices::haply {
namespace {

constexpr double kGentle = 0.2;                          // up [N]
constexpr double kFar = 0.03;                            // [m]
constexpr std::int64_t kPatience = 2000 * kMillisecond;  // for the arm to move away
constexpr std::int64_t kReadyIn = 10000 * kMillisecond;  // from connecting to commanding
// after arming, the echo's test included; else this computer is too busy
constexpr std::int64_t kPushesIn = 3000 * kMillisecond;
constexpr std::int64_t kPushes = 100 * kMillisecond;  // a push that is well established
constexpr std::int64_t kLookPeriod = 2 * kMillisecond;
constexpr std::int64_t kBlind = 250 * kMillisecond;  // a second session that isn't told of the arm by then never is
constexpr int kNobody = -1;                          // no descriptor wakes the wait

// The session that commands.
class Pusher final : public PortSink {
 public:
  Pusher(const ServicePlace& place, const std::string& arm, const ServiceVersion& version)
      : id_(arm),
        port_(openHaplyPort(place, version.minor >= 4, 2)),
        session_(optionsOf(arm, version), usb::monotonicNs()) {}
  ~Pusher() override {
    if (!port_) return;
    session_.disarm(0);
    turn(100 * kMillisecond, [] { return false; });
    port_->close();
  }
  Pusher(const Pusher&) = delete;
  Pusher& operator=(const Pusher&) = delete;

  void received(std::string_view text) override {
    session_.received(text, usb::monotonicNs());
    if (readService(text, *message_) != ReadError::kNone) return;
    const DeviceReport* arm = message_->find(id_);
    pushes_ = arm != nullptr && arm->f_H && arm->f_H->norm() > 0.9 * kGentle;
  }
  void heard(std::string_view event) override { session_.heard(event, usb::monotonicNs()); }

  void push(const std::atomic<bool>& interrupted) {
    turn(kReadyIn, [&] {
      return session_.phase() == SessionPhase::kReady || session_.phase() == SessionPhase::kRefused || interrupted;
    });
    if (session_.phase() != SessionPhase::kReady) complain();
    session_.arm(0, usb::monotonicNs());
    session_.want(0, Vec3(0, 0, kGentle));
    turn(kPushesIn, [&] { return pushes_ || session_.doubted() || interrupted; });
    turn(kPushes, [&] { return session_.doubted() || interrupted; });
    if (session_.doubted()) complain();
    if (!pushes_ && !interrupted)
      throw std::runtime_error(
          "The arm doesn't push within 3 s: this computer is too busy to tell. Close other programs, then measure "
          "again.");
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
    for (const std::int64_t until = usb::monotonicNs() + time;
         port_->open() && usb::monotonicNs() < until && !done();) {
      const std::int64_t now = usb::monotonicNs();
      for (auto text = session_.next(now); !text.empty(); text = session_.next(now)) port_->send(text);
      port_->wait(now + kSendPeriod, kNobody, *this);
    }
  }

  std::string id_;
  std::unique_ptr<HaplyPort> port_;
  HaplySession session_;
  std::unique_ptr<ServiceMessage> message_ = std::make_unique<ServiceMessage>();
  bool pushes_ = false;  // the service says that it does
};

// The session that looks.
class Watcher final : public PortSink {
 public:
  Watcher(const ServicePlace& place, const std::string& arm) : port_(openHaplyPort(place, false, 2)) {
    device_.id = *Label::of(arm);
  }
  void received(std::string_view text) override {
    ServiceMessage& message = *message_;
    if (readService(text, message) != ReadError::kNone) return;
    if (std::exchange(has_inventory_, true)) ++answered_;
    const DeviceReport* arm = message.find(device_.id.view());
    if (arm == nullptr) return;
    sees_ |= answered_ >= believed_from_;
    idle_ = arm->mode.view() == "idle" || (arm->f_H && arm->f_H->norm() < 0.5 * kGentle);
    if (arm->p_H) place_ = arm->p_H;
    if (!begin_) begin_ = place_;
  }
  void heard(std::string_view) override {}
  void look() {
    const std::int64_t now = usb::monotonicNs();
    port_->send(writeProbes(buffer_, std::span<const ForceCommand>(&device_, 1)));
    ++sent_;
    while (port_->open() && usb::monotonicNs() < now + kLookPeriod) port_->wait(now + kLookPeriod, kNobody, *this);
  }
  // From now on idleness counts: the inventory is older, and an answer may be one message old.
  void begin() {
    believed_from_ = sent_ + 2;
    sees_ = false;
  }
  // It is told of the arm, although another session commands it.
  bool sees() const { return sees_; }
  bool idle() const { return idle_ && answered_ >= believed_from_; }
  double moved() const { return place_ && begin_ ? (*place_ - *begin_).norm() : 0; }

 private:
  std::unique_ptr<HaplyPort> port_;
  ForceCommand device_;
  std::unique_ptr<ServiceMessage> message_ = std::make_unique<ServiceMessage>();
  std::array<char, kMostCommand> buffer_{};
  std::optional<Vec3> begin_, place_;
  bool idle_ = false, has_inventory_ = false, sees_ = false;
  std::int64_t sent_ = 0, answered_ = 0, believed_from_ = 0;
};

}  // namespace

SilenceFinding measureSilence(const ServicePlace& place, const std::string& arm, const ServiceVersion& version,
                              Ending ending, const std::atomic<bool>& interrupted) {
  if (!Label::of(arm)) throw std::runtime_error("That isn't the id of an Inverse3, as 049D.");
  LastZero::install();
  Pusher pusher(place, arm, version);
  Watcher watcher(place, arm);
  pusher.push(interrupted);
  watcher.look();
  watcher.begin();
  SilenceFinding finding;
  const std::int64_t begin = usb::monotonicNs();
  const auto within = [&](std::int64_t time) { return usb::monotonicNs() - begin < time; };
  if (ending == Ending::kClose) pusher.vanish();
  while (!finding.went_idle && watcher.moved() < kFar && within(watcher.sees() ? kPatience : kBlind) && !interrupted) {
    watcher.look();
    finding.went_idle = watcher.idle();
  }
  finding.seconds = 1e-9 * static_cast<double>(usb::monotonicNs() - begin);
  finding.moved = watcher.moved();
  // takes it back, and lets it go with zeros
  if (ending == Ending::kClose) Pusher(place, arm, version).push(interrupted);
  if (!watcher.sees() && !interrupted)
    throw std::runtime_error(
        "The service tells a second session nothing of an arm that is in use, so nobody can see when it lets go. Leave "
        "idle_after unset: "
        "sessions keep to 2 N.");
  return finding;
}

}  // namespace pincer::devices::haply
