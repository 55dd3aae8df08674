#include "pincer/devices/haply/haply_session.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <utility>

namespace pincer::devices::haply {
namespace {

constexpr std::int64_t kInventoryTime = 2000 * kMillisecond;    // for the first full message
constexpr std::int64_t kSettleTime = 500 * kMillisecond;        // of zeros
constexpr std::int64_t kEchoStep = 50 * kMillisecond;           // of each sign
constexpr std::int64_t kSilence = 250 * kMillisecond;           // without an answer
constexpr std::int64_t kFullPeriod = 250 * kMillisecond;        // between two looks at the settings
constexpr std::int64_t kHomingPeriod = 10 * kMillisecond;       // between two probes
constexpr std::int64_t kEventsMayBeLost = 1000 * kMillisecond;  // then the arms are doubted
constexpr std::int64_t kEchoComes = 20 * kMillisecond;          // after the force, as the service tells it
constexpr double kEchoError = 0.02;                             // of the echo of kEchoForce [N]
constexpr int kMostUnsound = 3;                                 // in a row

}  // namespace

HaplySession::HaplySession(SessionOptions options, std::int64_t now)
    : options_(std::move(options)),
      began_(now),
      spelling_(options_.version.minor >= 5 ? ForceSpelling::kVector : ForceSpelling::kValues) {
  for (std::size_t i = 0; i < options_.arms.size(); ++i) {
    const auto id = Label::of(options_.arms[i].arm);
    if (!id || i >= kMostArms) {
      refuse("One or two arms; the id of an Inverse3 is at most 31 letters and digits, as on its label.");
      break;
    }
    arms_[i].id = *id;
  }
}

void HaplySession::invalidate() {
  for (ArmState& arm : arms_) arm.reading.valid = false;
}

void HaplySession::refuse(std::string why) {
  if (phase_ == SessionPhase::kRefused) return;
  phase_ = SessionPhase::kRefused;
  complaint_ = std::move(why);
  zero_now_ = commanded_;
  invalidate();
}

// The first doubt stays until the operator arms. Before the session is ready, it refuses it.
void HaplySession::doubt(std::string why) {
  if (phase_ != SessionPhase::kReady) return refuse(std::move(why));
  if (doubted_) return;
  doubted_ = zero_now_ = true;
  complaint_ = std::move(why);
  for (ArmState& arm : arms_) arm.armed = false;
  invalidate();
}

void HaplySession::arm(std::size_t arm, std::int64_t now) {
  if (phase_ != SessionPhase::kReady) return;
  doubted_ = false;
  complaint_.clear();
  unsound_in_a_row_ = 0;
  ArmState& a = arms_[arm];
  a.armed = true;
  a.wish = Vec3::Zero();
  a.test = Echo::kPlus;
  a.test_began = a.still_since = now;
  a.pushed_when_still = false;
}

void HaplySession::disarm(std::size_t arm) {
  if (!arms_[arm].armed) return;
  arms_[arm].armed = false;
  zero_now_ = true;
}

void HaplySession::want(std::size_t arm, const Vec3& f_H) {
  const bool sound = f_H.allFinite();
  zero_now_ |= arms_[arm].armed && (!sound || f_H.isZero(0)) && !arms_[arm].wish.isZero(0);
  arms_[arm].wish = sound ? f_H : Vec3::Zero();
}

Vec3 HaplySession::forceNow(const ArmState& arm) const {
  if (!arm.armed || doubted_ || phase_ != SessionPhase::kReady) return Vec3::Zero();
  if (arm.test == Echo::kGood) return arm.wish;
  return Vec3(0, 0, arm.test == Echo::kPlus ? kEchoForce : -kEchoForce);
}

// Both signs have to come back; the other spelling gets one try of each.
void HaplySession::testEcho(ArmState& arm, std::int64_t now) {
  if (!arm.armed || arm.test == Echo::kGood || arm.test == Echo::kUntested || now - arm.test_began < kEchoStep) return;
  // a service that is late isn't deaf
  if (arm.echo_ns < arm.test_began + kEchoComes && now - arm.test_began < kSilence) return;
  const Vec3 wanted(0, 0, arm.test == Echo::kPlus ? kEchoForce : -kEchoForce);
  judgeEcho(arm, arm.echo && (*arm.echo - wanted).norm() <= kEchoError, now);
}

void HaplySession::judgeEcho(ArmState& arm, bool follows, std::int64_t now) {
  arm.test_began = now;
  if (follows && arm.test == Echo::kPlus) {
    arm.test = Echo::kMinus;
  } else if (follows) {
    arm.test = Echo::kGood;
    spelling_proven_ = true;
  } else if (!spelling_proven_ && !spelling_changed_) {
    spelling_changed_ = true;
    spelling_ = spelling_ == ForceSpelling::kVector ? ForceSpelling::kValues : ForceSpelling::kVector;
    for (ArmState& other : arms_) {
      if (other.armed) other.test = Echo::kPlus, other.test_began = now;
    }
  } else {
    doubt(
        fmt::format("Inverse3 {}: the service doesn't echo a force of {} N, in either spelling: it may be deaf to a "
                    "zero, too. Switch the "
                    "device off and on, look at its light; its force gate may swallow what changes sign: --force-gate "
                    "GAIN. See `pincer "
                    "devices test --devices haply`.",
                    arm.id.view(), kEchoForce));
  }
}

void HaplySession::advance(std::int64_t now) {
  if (phase_ == SessionPhase::kInventory && now - began_ > kInventoryTime)
    refuse(
        "The program at that port doesn't tell which devices it has, as Haply's service does. Is another program on "
        "the port (--service)?");
  if (phase_ == SessionPhase::kSettling && now - began_ > kSettleTime) phase_ = SessionPhase::kReady;
  if (under_way_ > 0 && now - questions_[first_question_].ns > kSilence)
    doubt(
        "Haply's service didn't answer for 250 ms. Is it running (systemctl status haply-inverse-service)? Is the "
        "computer busy?");
  if (events_lost_ >= 0 && now - events_lost_ > kEventsMayBeLost && phase_ != SessionPhase::kRefused)
    doubt(
        "The service's event channel is lost: its safety events can't be heard. Restart the service, then begin "
        "again.");
  for (ArmState& arm : arms_) testEcho(arm, now);
}

std::string_view HaplySession::next(std::int64_t now) {
  advance(now);
  const bool urgent = std::exchange(zero_now_, false);
  if (under_way_ == kMostUnderWay) return zero_now_ = urgent, std::string_view{};
  if (urgent) return writeNow(now);
  const std::int64_t period = phase_ == SessionPhase::kHoming ? kHomingPeriod : kSendPeriod;
  if (under_way_ > 0 || now - last_sent_ < period) return {};
  if (phase_ == SessionPhase::kInventory || (phase_ == SessionPhase::kRefused && !commanded_)) return {};
  return writeNow(now);
}

std::string_view HaplySession::writeNow(std::int64_t now) {
  const std::size_t count = options_.arms.size();
  for (std::size_t i = 0; i < count; ++i) commands_[i] = {.id = arms_[i].id, .f_H = forceNow(arms_[i])};
  const std::span<const ForceCommand> commands(commands_.data(), count);
  if (phase_ == SessionPhase::kHoming) {
    remember(now, false);
    return writeProbes(buffer_, commands);
  }
  const bool first = !commanded_;
  const bool full = phase_ == SessionPhase::kConfiguring || now - last_full_ > kFullPeriod;
  for (std::size_t i = 0; first && i < count; ++i) {
    commands_[i].configure = true;
    commands_[i].gate_gain = options_.gate_gain;
  }
  commanded_ = true;
  remember(now, full);
  return writeForces(buffer_, commands, spelling_, first ? std::string_view(options_.profile) : std::string_view{},
                     full);
}

std::string_view HaplySession::zeros() {
  for (std::size_t i = 0; i < options_.arms.size(); ++i) commands_[i] = {.id = arms_[i].id, .f_H = Vec3::Zero()};
  return writeForces(buffer_, std::span<const ForceCommand>(commands_.data(), options_.arms.size()), spelling_);
}

void HaplySession::remember(std::int64_t now, bool full) {
  questions_[(first_question_ + under_way_++) % kMostUnderWay] = {now, full};
  last_sent_ = now;
  if (full) last_full_ = now;
  ++counts_.sent;
  for (std::size_t i = 0; i < options_.arms.size(); ++i) {
    ArmState& arm = arms_[i];
    const double size = commands_[i].f_H.norm();
    arm.sizes[arm.next_size] = size;
    arm.sent_at[arm.next_size] = now;
    arm.next_size = (arm.next_size + 1) % arm.sizes.size();
    arm.pushing_since = size == 0 ? -1 : arm.pushing_since < 0 ? now : arm.pushing_since;
  }
}

void HaplySession::received(std::string_view text, std::int64_t now) {
  const ReadError error = readService(text, message_);
  if (phase_ == SessionPhase::kRefused) {  // answers to zeros on the way out
    if (under_way_ > 0) first_question_ = (first_question_ + 1) % kMostUnderWay, --under_way_;
    return;
  }
  if (phase_ == SessionPhase::kInventory) {
    if (error == ReadError::kNone) return takeInventory(message_, now);
    return refuse(fmt::format(
        "The program at that port sends what Haply's service doesn't: {}. Is another program on the port, or a "
        "service older than 3.1 or newer than 3.5?",
        describe(error)));
  }
  if (under_way_ == 0)
    return doubt(
        "Haply's service sent a state that nobody asked for: what answers what isn't certain any more. Restart it.");
  const UnderWay question = questions_[first_question_];
  first_question_ = (first_question_ + 1) % kMostUnderWay;
  --under_way_;
  const auto step = static_cast<std::size_t>((now - question.ns) / kTripStep);
  if (options_.trips != nullptr)
    (*options_.trips)[std::min(step, options_.trips->size() - 1)].fetch_add(1, std::memory_order_relaxed);
  ++counts_.answered;
  if (error == ReadError::kNone) {
    unsound_in_a_row_ = 0;
    takeState(message_, question, now);
  } else {
    ++counts_.unsound;
    invalidate();
    if (++unsound_in_a_row_ >= kMostUnsound)
      doubt(fmt::format("Haply's service sent {} unsound messages in a row: {}. Restart it.", kMostUnsound,
                        describe(error)));
  }
  before_answered_ = question.ns;
}

void HaplySession::eventsAre(bool up, std::int64_t now) {
  if (up) {
    events_lost_ = -1;
  } else if (events_lost_ < 0) {
    events_lost_ = now;
  }
}

}  // namespace pincer::devices::haply
