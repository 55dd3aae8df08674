// haply_session: what is said to Haply's service over one connection, and what makes it
// doubtful; without socket, thread or clock.
//
//   inventory -> (homing) -> configuring -> settling -> ready          any of them -> refused, with a sentence
//
// The service is a program on the desktop: it is assumed to keep the last force for ever. So zeros are sent, never just
// silence, and any doubt is zero, latched until the operator arms again. One message is under way at a time; zeros that
// can't wait go out at once, up to 8. Replies carry neither number nor time: they are matched by order, and a sample's
// time is when the message before the answered one was sent, because a reply may be one message old.
// After arming the service has to echo +-0.05 N, in the spelling of its version or the other one: an arm deaf to that
// is deaf to a zero. The thresholds are ours (docs/devices/haply.md); none of them has met hardware.
#pragma once
#include <array>
#include <atomic>
#include <cstdint>
#include <string>
#include <vector>

#include "pincer/devices/haply/haply_messages.h"

namespace pincer::devices::haply {

inline constexpr std::size_t kMostArms = 2;                    // chosen; a session with more is refused
inline constexpr std::int64_t kMillisecond = 1'000'000;        // [ns]
inline constexpr std::int64_t kSendPeriod = kMillisecond / 2;  // twice per tick
inline constexpr std::size_t kMostUnderWay = 8;                // messages without their answer
inline constexpr double kEchoForce = 0.05;                     // [N]

// Round trips in steps of 10 us; the last one holds all longer ones. Read from any thread.
inline constexpr std::int64_t kTripStep = 10'000;
using RoundTrips = std::array<std::atomic<std::uint32_t>, 1001>;

struct ArmPlan {
  std::string arm, grip;  // ids; no grip: the finger's turn isn't measured
};

struct SessionOptions {
  std::vector<ArmPlan> arms;     // 1 or 2
  ServiceVersion version{3, 5};  // decides the spelling that is tried first, and which settings the service has to tell
  std::string profile = "org.pincer:0";  // new in every run, so that Haply Hub has no tweaks for it
  std::optional<double> gate_gain = {};  // of the force gate; absent: left as it is
  RoundTrips* trips = nullptr;           // counted there, if anywhere
};

enum class SessionPhase : std::uint8_t { kInventory, kHoming, kConfiguring, kSettling, kReady, kRefused };

struct ArmReading {
  bool valid = false;
  std::int64_t ns = 0;  // no older than this [ns]
  Vec3 p_H = Vec3::Zero();
  std::optional<Vec3> v_H;
  std::optional<Quat> q_H;  // of its grip; a grip that sleeps keeps its turn
  std::optional<std::uint32_t> buttons;
};

struct SessionCounts {
  std::int64_t sent = 0, answered = 0, unsound = 0, attenuated = 0, grip_asleep = 0;
};

class HaplySession {
 public:
  // All times are `now` [ns] of one monotonic clock.
  HaplySession(SessionOptions options, std::int64_t now);

  void received(std::string_view text, std::int64_t now);
  void heard(std::string_view event, std::int64_t now);
  // The event channel is there, or lost; of services that have one.
  void eventsAre(bool up, std::int64_t now);
  // The operator armed: a doubt is forgiven, the echo is tested again.
  void arm(std::size_t arm, std::int64_t now);
  void disarm(std::size_t arm);  // zero at once
  // The force that the servo wants now, and zero as soon as that is too old [N].
  void want(std::size_t arm, const Vec3& f_H);

  // The message that is due, empty if none is; call it again until then. Watches the deadlines too.
  std::string_view next(std::int64_t now);

  // Zeros for all arms, in the spelling of now; for who says the last word.
  std::string_view zeros();

  SessionPhase phase() const { return phase_; }
  // Why it was refused, or why its forces are latched at zero; empty: neither. Sentences with a remedy.
  const std::string& complaint() const { return complaint_; }
  bool doubted() const { return doubted_; }
  const ArmReading& reading(std::size_t arm) const { return arms_[arm].reading; }
  const SessionCounts& counts() const { return counts_; }
  ForceSpelling spelling() const { return spelling_; }
  const std::optional<DeviceConfig>& config(std::size_t arm) const { return arms_[arm].config; }
  std::size_t underWay() const { return under_way_; }

 private:
  enum class Echo : std::uint8_t { kUntested, kPlus, kMinus, kGood };
  struct ArmState {
    Label id;
    ArmReading reading;
    std::optional<Vec3> echo;  // force that the service says it applies
    std::optional<DeviceConfig> config;
    bool armed = false;
    Vec3 wish = Vec3::Zero();
    Echo test = Echo::kUntested;
    std::int64_t test_began = 0;
    std::int64_t echo_ns = 0;         // no older than this is the echo [ns]
    std::int64_t pushing_since = -1;  // of an unbroken run of forces [ns]
    std::int64_t deaf_since = -1;     // nothing of a force comes back since [ns]
    std::int64_t still_since = 0;     // the place is equal to the bit since, or since the force changed [ns]
    Vec3 f_when_still = Vec3::Zero();
    bool pushed_when_still = false;
    std::array<double, 64> sizes{};  // of the last forces sent
    std::array<std::int64_t, 64> sent_at{};
    std::size_t next_size = 0;
  };
  struct UnderWay {
    std::int64_t ns = 0;
    bool full = false;
  };

  void refuse(std::string why);
  void doubt(std::string why);
  void takeInventory(const ServiceMessage& message, std::int64_t now);
  bool identifies(const ServiceMessage& message);
  void takeState(const ServiceMessage& message, const UnderWay& question, std::int64_t now);
  void takeArm(std::size_t arm, const DeviceReport& report, const UnderWay& question, std::int64_t now);
  void takeGrip(std::size_t arm, const ServiceMessage& message);
  void checkFlags(const DeviceReport& report);
  void checkForce(ArmState& arm, const DeviceReport& report);
  void checkPlace(ArmState& arm, const DeviceReport& report, std::int64_t now);
  void checkConfig(ArmState& arm, const DeviceReport& report, std::int64_t now);
  std::string oddIn(const DeviceConfig& config, const Label& id) const;
  void advance(std::int64_t now);
  void testEcho(ArmState& arm, std::int64_t now);
  void judgeEcho(ArmState& arm, bool follows, std::int64_t now);
  Vec3 forceNow(const ArmState& arm) const;
  std::string_view writeNow(std::int64_t now);
  void remember(std::int64_t now, bool full);
  void invalidate();

  SessionOptions options_;
  SessionPhase phase_ = SessionPhase::kInventory;
  std::int64_t began_;  // the phase [ns]
  std::string complaint_;
  bool doubted_ = false, commanded_ = false, zero_now_ = false;
  ForceSpelling spelling_;
  bool spelling_proven_ = false, spelling_changed_ = false;
  std::array<ArmState, kMostArms> arms_;
  std::array<ForceCommand, kMostArms> commands_;
  std::array<UnderWay, kMostUnderWay> questions_{};
  std::size_t first_question_ = 0, under_way_ = 0;
  std::int64_t last_sent_ = 0, before_answered_ = -1, last_full_ = 0;
  std::int64_t events_lost_ = -1;  // [ns]
  int unsound_in_a_row_ = 0;
  SessionCounts counts_;
  ServiceMessage message_;
  std::array<char, kMostCommand> buffer_{};
};

}  // namespace pincer::devices::haply
