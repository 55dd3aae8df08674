// A session with the emulated service in virtual time: how it begins, and that every doubt ends in zero.
#include "pincer/devices/haply/haply_session.h"

#include <gtest/gtest.h>

#include <cmath>
#include <deque>

#include "pincer/devices/emulate/haply_service.h"
#include "pincer/devices/haply/haply_frames.h"

namespace pincer::devices::haply {
namespace {

using emulate::HaplyFault;
using emulate::HaplyService;
using emulate::HaplyServiceSettings;

constexpr std::int64_t kStep = kMillisecond / 4, kLatency = kMillisecond / 4;

SessionOptions twoArms(int minor = 5) {
  SessionOptions options;
  options.arms = {{"049D", "1605"}, {"04BA", "1606"}};
  options.version = {3, minor};
  return options;
}

// Both ends and a wire that takes 0.25 ms each way.
class Wire {
 public:
  explicit Wire(const SessionOptions& options = twoArms(), const HaplyServiceSettings& settings = {})
      : service(settings), session(options, 0) {
    std::string inventory;
    number_ = service.connected(inventory);
    session.received(inventory, 0);
  }
  void run(double seconds) {
    for (const std::int64_t end = now + static_cast<std::int64_t>(seconds * 1e9); now < end; step()) {
    }
  }
  // Arms both and waits for the echo.
  void arm() {
    session.arm(0, now);
    session.arm(1, now);
    run(0.21);
  }
  // The service is away, as on a busy computer; what was sent waits.
  void pauseService(double seconds) {
    service_away_until_ = now + static_cast<std::int64_t>(seconds * 1e9);
    run(seconds);
  }
  void push(const Vec3& f_H) { session.want(0, f_H), session.want(1, f_H); }
  double force(std::size_t arm = 0) { return service.plant(arm).force_D().norm(); }

  HaplyService service;
  HaplySession session;
  std::int64_t now = 0;

 private:
  void step() {
    now += kStep;
    service.advance(1e-9 * kStep);
    while (now > service_away_until_ && !to_service_.empty() && to_service_.front().first <= now) {
      for (std::string& answer : service.answer(number_, to_service_.front().second))
        to_session_.emplace_back(now + kLatency, std::move(answer));
      to_service_.pop_front();
    }
    while (!to_session_.empty() && to_session_.front().first <= now) {
      session.received(to_session_.front().second, now);
      to_session_.pop_front();
    }
    for (const std::string& event : service.takeEvents()) session.heard(event, now);
    for (auto text = session.next(now); !text.empty(); text = session.next(now))
      to_service_.emplace_back(now + kLatency, text);
  }

  int number_ = 0;
  std::int64_t service_away_until_ = -1;
  std::deque<std::pair<std::int64_t, std::string>> to_service_, to_session_;
};

TEST(HaplySession, BecomesReadyWithoutAnyForceAndTellsWhereTheArmsAre) {
  Wire wire;
  wire.run(0.4);
  EXPECT_EQ(wire.session.phase(), SessionPhase::kSettling) << wire.session.complaint();
  wire.run(0.2);
  ASSERT_EQ(wire.session.phase(), SessionPhase::kReady) << wire.session.complaint();
  const ArmReading& reading = wire.session.reading(0);
  EXPECT_TRUE(reading.valid && reading.q_H && reading.v_H);
  EXPECT_LT((reading.p_H - Vec3(0, -0.17, 0.16)).norm(), 1e-3);
  EXPECT_EQ(wire.force(), 0);
  EXPECT_EQ(wire.session.config(0)->preset.view(), "defaults");
  const double age = 1e-6 * static_cast<double>(wire.now - reading.ns);
  EXPECT_GE(age, 0.5) << "a state may be one message old";
  EXPECT_LE(age, 2.0) << "within the gate's 3 ms";
}

TEST(HaplySession, RendersForcesOnlyOnceArmedAndTheirEchoWasHeard) {
  Wire wire;
  wire.run(0.6);
  wire.push({0, 0, 1});
  wire.run(0.01);
  EXPECT_EQ(wire.force(), 0) << "not armed";
  wire.session.arm(0, wire.now);
  wire.push({0, 0, 1});
  wire.run(0.02);
  EXPECT_NEAR(wire.force(), kEchoForce, 1e-6) << "the echo is tested first";
  EXPECT_EQ(wire.force(1), 0);
  wire.run(0.2);
  EXPECT_NEAR(wire.force(), 1, 1e-6) << wire.session.complaint();
  wire.session.disarm(0);
  wire.run(0.0005);
  EXPECT_EQ(wire.force(), 0);
}

// No page says if 3.5 takes "values", or which spelling 3.1 to 3.4 take: both ways work.
TEST(HaplySession, FindsTheSpellingThatTheServiceTakes) {
  for (const int minor : {1, 3, 4, 5}) {
    for (const bool vector : {false, true}) {
      Wire wire(twoArms(minor), {.minor = minor, .vector = vector, .values = !vector});
      wire.run(0.6);
      ASSERT_EQ(wire.session.phase(), SessionPhase::kReady) << wire.session.complaint();
      wire.arm();
      wire.push({0, 0.5, 0});
      wire.run(0.2);
      EXPECT_FALSE(wire.session.doubted()) << wire.session.complaint();
      EXPECT_EQ(wire.session.spelling(), vector ? ForceSpelling::kVector : ForceSpelling::kValues);
      EXPECT_NEAR(wire.force(), 0.5, 1e-6);
    }
  }
  Wire both(twoArms(), {.vector = true, .values = true});
  both.run(0.6);
  both.arm();
  both.push({0.5, 0, 0});
  both.run(0.1);
  EXPECT_NEAR(both.force(), 0.5, 1e-6) << "never both spellings: forces add";
}

TEST(HaplySession, DoubtsAnArmThatIsDeafInEitherSpelling) {
  Wire wire(twoArms(), {.vector = false, .values = false});
  wire.run(0.6);
  wire.arm();
  EXPECT_TRUE(wire.session.doubted());
  EXPECT_NE(wire.session.complaint().find("echo"), std::string::npos) << wire.session.complaint();
}

// Its place needn't stand still for that, and the force needn't change.
TEST(HaplySession, DoubtsAnArmThatGoesDeafWhileItPushesEvenly) {
  for (const double f : {0.1, 1.0, 1.9}) {
    Wire wire;
    wire.run(0.6);
    wire.arm();
    wire.push({0, 0, f});
    wire.run(0.05);
    ASSERT_NEAR(wire.force(), f, 1e-6) << wire.session.complaint();
    wire.service.setFault(HaplyFault::kDeafToForces);
    wire.run(0.2);
    EXPECT_FALSE(wire.session.doubted()) << f << " N: a filter may take that long; " << wire.session.complaint();
    wire.run(0.1);
    EXPECT_TRUE(wire.session.doubted()) << f << " N";
    EXPECT_NE(wire.session.complaint().find("renders nothing"), std::string::npos) << wire.session.complaint();
  }
}

// Forces of a light touch may round to nothing in what the service tells.
TEST(HaplySession, DoesNotDoubtAnArmWhoseSmallForcesRoundToNothing) {
  Wire wire;
  wire.run(0.6);
  wire.arm();
  wire.push({0, 0, 0.04});
  wire.run(0.05);
  wire.service.setFault(HaplyFault::kDeafToForces);
  wire.run(1);
  EXPECT_FALSE(wire.session.doubted()) << wire.session.complaint();
}

TEST(HaplySession, TakesStatesThatAreFreshAndStatesThatAreOneMessageOld) {
  for (const bool old : {false, true}) {
    Wire wire(twoArms(), {.one_message_old = old});
    wire.run(0.6);
    wire.arm();
    wire.push({0, 0, 1});
    wire.run(0.3);
    EXPECT_FALSE(wire.session.doubted()) << wire.session.complaint();
  }
}

// Each in the midst of an armed session that pushes: zero for good, within what
// it takes to see it, or a harmless fault.
TEST(HaplySession, EveryFaultWhilePushingEndsInZeroOrIsHarmless) {
  const auto harmless = [](HaplyFault fault) {
    return fault == HaplyFault::kUnknownKey || fault == HaplyFault::kGripAsleep || fault == HaplyFault::kGripZero ||
           fault >= HaplyFault::kPieces;
  };
  for (std::size_t i = 1; i < emulate::kHaplyFaults; ++i) {
    const auto fault = static_cast<HaplyFault>(i);
    Wire wire;
    wire.run(0.6);
    wire.arm();
    wire.push({0, 0, 0.1});
    wire.run(0.05);
    ASSERT_NEAR(wire.force(), 0.1, 1e-6) << nameOf(fault) << wire.session.complaint();
    wire.service.setFault(fault);
    wire.run(0.1);
    wire.push({0, 0, 0.9});
    wire.run(0.65);
    if (harmless(fault)) {
      EXPECT_FALSE(wire.session.doubted()) << nameOf(fault) << wire.session.complaint();
      EXPECT_NEAR(wire.force(), 0.9, 1e-6) << nameOf(fault);
    } else {
      EXPECT_TRUE(wire.session.doubted()) << nameOf(fault);
      EXPECT_GT(wire.session.complaint().size(), 40u) << nameOf(fault);
      EXPECT_EQ(wire.force(), 0) << nameOf(fault) << wire.session.complaint();
      EXPECT_FALSE(wire.session.reading(0).valid) << nameOf(fault);
    }
    wire.service.setFault(HaplyFault::kNone);
    wire.run(0.1);
    EXPECT_TRUE(!wire.session.doubted() || wire.force() == 0) << nameOf(fault) << ": only the operator arms again";
  }
}

TEST(HaplySession, RendersAgainAfterADoubtOnlyOnceTheOperatorArmed) {
  Wire wire;
  wire.run(0.6);
  wire.arm();
  wire.service.setFault(HaplyFault::kNotReady);
  wire.run(0.05);
  wire.service.setFault(HaplyFault::kNone);
  wire.push({0, 0, 1});
  wire.run(0.3);
  EXPECT_EQ(wire.force(), 0);
  wire.arm();
  wire.push({0, 0, 1});
  wire.run(0.05);
  EXPECT_NEAR(wire.force(), 1, 1e-6) << wire.session.complaint();
}

TEST(HaplySession, EveryFaultAtTheStartRefusesOrIsHarmless) {
  for (std::size_t i = 1; i < emulate::kHaplyFaults; ++i) {
    const auto fault = static_cast<HaplyFault>(i);
    HaplyService service;
    HaplySession session(twoArms(), 0);
    service.setFault(fault);
    std::string inventory;
    service.connected(inventory);
    session.received(inventory, 0);
    for (std::int64_t now = 0; now < 3000 * kMillisecond; now += kStep) session.next(now);
    EXPECT_EQ(session.phase() == SessionPhase::kRefused, !session.complaint().empty()) << nameOf(fault);
    EXPECT_NE(session.phase(), SessionPhase::kReady) << "nobody answered";
    EXPECT_FALSE(session.reading(0).valid);
  }
}

TEST(HaplySession, NamesWhyItDoesNotBegin) {
  const auto refusal = [](SessionOptions options, HaplyFault fault, const HaplyServiceSettings& settings = {}) {
    HaplyService service(settings);
    service.setFault(fault);
    HaplySession session(std::move(options), 0);
    std::string inventory;
    service.connected(inventory);
    session.received(inventory, 0);
    return session.complaint();
  };
  SessionOptions other = twoArms();
  other.arms[1].arm = "04XX";
  EXPECT_NE(refusal(other, HaplyFault::kNone).find("04XX"), std::string::npos);
  other = twoArms();
  other.arms[0].grip = "1699";
  EXPECT_NE(refusal(other, HaplyFault::kNone).find("1699"), std::string::npos);
  EXPECT_NE(refusal(twoArms(), HaplyFault::kPowerLost).find("power"), std::string::npos);
  EXPECT_NE(refusal(twoArms(), HaplyFault::kNoJson).find("another program on the port"), std::string::npos);
  HaplySession silent(twoArms(), 0);
  silent.next(2100 * kMillisecond);
  EXPECT_NE(silent.complaint().find("--service"), std::string::npos);
}

TEST(HaplySession, LeavesADeviceThatAnotherSessionHoldsAlone) {
  Wire first;
  first.run(0.6);
  std::string inventory;
  first.service.connected(inventory);
  HaplySession second(twoArms(), 0);
  second.received(inventory, 0);
  EXPECT_EQ(second.phase(), SessionPhase::kRefused);
  EXPECT_NE(second.complaint().find("another session"), std::string::npos) << second.complaint();
  EXPECT_TRUE(second.next(kMillisecond).empty()) << "not even a zero: that would take the device";
}

TEST(HaplySession, WaitsForCalibrationWithoutACommand) {
  HaplyService service;
  service.setFault(HaplyFault::kCalibrationLost);
  Wire wire;
  std::string inventory;
  service.connected(inventory);
  HaplySession session(twoArms(), 0);
  session.received(inventory, 0);
  EXPECT_EQ(session.phase(), SessionPhase::kHoming);
  const std::string text(session.next(20 * kMillisecond));
  EXPECT_NE(text.find("probe_position"), std::string::npos) << text;
  EXPECT_EQ(text.find("force"), std::string::npos);
}

TEST(HaplySession, RefusesSettingsThatStayOdd) {
  Wire wire;
  wire.service.setFault(HaplyFault::kSettingsChanged);
  wire.run(0.7);
  EXPECT_EQ(wire.session.phase(), SessionPhase::kRefused);
  EXPECT_NE(wire.session.complaint().find("preset"), std::string::npos) << wire.session.complaint();
}

// No page shows how a preset or a damping is set over the WebSocket: a service that takes ours is
// configured, one that doesn't is refused.
TEST(HaplySession, ConfiguresAServiceOrRefusesIt) {
  for (const bool takes : {true, false}) {
    for (const HaplyServiceSettings& odd : {HaplyServiceSettings{.preset = "led_front", .takes_configuration = takes},
                                            HaplyServiceSettings{.damping = 0.7, .takes_configuration = takes}}) {
      Wire wire(twoArms(), odd);
      wire.run(1.2);
      EXPECT_EQ(wire.session.phase(), takes ? SessionPhase::kReady : SessionPhase::kRefused)
          << wire.session.complaint();
      const char* const named = odd.damping > 0 ? "damping" : "preset";
      EXPECT_EQ(wire.session.complaint().find(named) != std::string::npos, !takes) << wire.session.complaint();
      EXPECT_EQ(wire.force(), 0);
    }
  }
}

// Clients disagree on what a force is told as; where it isn't told at all, nobody knows that a zero arrives.
TEST(HaplySession, RefusesToPushWhereTheForceIsNotTold) {
  Wire wire(twoArms(), {.tells_force = false});
  wire.run(0.6);
  ASSERT_EQ(wire.session.phase(), SessionPhase::kReady) << wire.session.complaint();
  wire.arm();
  wire.push({0, 0, 1});
  wire.run(0.3);
  EXPECT_TRUE(wire.session.doubted());
  EXPECT_EQ(wire.force(), 0);
}

// Grips on a cable tell other things than wireless ones; both turn the finger.
TEST(HaplySession, TakesWiredAndWirelessGrips) {
  for (const bool wired : {false, true}) {
    Wire wire(twoArms(), {.wired_grips = wired});
    wire.service.plant(1).arm().setGimbal(Quat(0.5, -0.5, 0.5, 0.5));
    wire.run(0.6);
    ASSERT_EQ(wire.session.phase(), SessionPhase::kReady) << wire.session.complaint();
    ASSERT_TRUE(wire.session.reading(1).q_H);
    EXPECT_LT(wire.session.reading(1).q_H->angularDistance(wire.service.plant(1).grip_H()), 1e-6) << wired;
  }
}

// An arm that had lain still to the bit for half a second counted as frozen the moment that it was pushed.
TEST(HaplySession, AnArmThatRestedMayBePushed) {
  Wire wire;
  wire.run(0.6);
  wire.arm();
  wire.run(2);
  for (const double f : {1.0, -1.0}) {
    wire.push({0, 0, f});
    wire.run(0.03);
    EXPECT_NEAR(wire.force(), 1, 1e-6) << wire.session.complaint();
  }
}

// No page tells which gain of the force gate lets all through. The one that is found may damp what changes sign: then
// nobody may push until --force-gate gives another.
TEST(HaplySession, PushesOnlyWhereTheForceGateLetsWhatChangesSignThrough) {
  for (const double neutral : {0.3, 0.6}) {
    for (const bool given : {false, true}) {
      SessionOptions options = twoArms();
      if (given) options.gate_gain = neutral;
      Wire wire(options, {.gate_neutral = neutral});
      wire.run(0.6);
      ASSERT_EQ(wire.session.phase(), SessionPhase::kReady) << wire.session.complaint();
      wire.session.arm(0, wire.now);
      wire.run(0.6);
      const bool passes = given || neutral == wire.service.settings().gate_gain;
      EXPECT_EQ(wire.session.doubted(), !passes) << wire.session.complaint();
      EXPECT_EQ(wire.session.complaint().find("--force-gate") != std::string::npos, !passes)
          << wire.session.complaint();
      for (const double f : {1.0, -1.0, 1.0}) {
        wire.push({0, 0, f});
        wire.run(0.03);
        EXPECT_NEAR(wire.force(), passes ? 1 : 0, 1e-6) << wire.session.complaint();
      }
      EXPECT_EQ(wire.session.counts().attenuated, 0);
    }
  }
}

// No page tells if a grip's yaw drifts. Its drift, taken out at one turn of the finger, is gone at every other; aligned
// anew, it wouldn't be.
TEST(HaplySession, ADriftOfAGripsYawIsTakenOut) {
  const Quat held(0.5, -0.5, 0.5, 0.5), tilted = Quat(0.8, 0.6, 0, 0) * held;  // q_DF
  for (const double drift : {0.0, 0.1, -0.2}) {
    Wire wire(twoArms(), {.arms = {{.grip_drift = drift}, {.id = "04BA", .grip = "1606"}}});
    const auto told = [&](const Quat& q_DF, const HaplyFrame& frame) {
      wire.service.plant(0).arm().setGimbal(q_DF);
      wire.run(0.002);
      return HaplyMap(frame).turn(*wire.session.reading(0).q_H);
    };
    wire.run(2);
    const HaplyFrame aligned;  // before it drifted
    EXPECT_NEAR(told(tilted, aligned).angularDistance(tilted), 2 * std::abs(drift), 2e-3);
    const GripDrift found = gripDrift(told(held, aligned), held);
    EXPECT_NEAR(found.yaw, 2 * drift, 2e-3);
    EXPECT_LT(found.tilt, 1e-6);
    HaplyFrame undrifted = aligned;
    undrifted.grip_yaw = found.yaw;
    EXPECT_LT(told(held, undrifted).angularDistance(held), 2e-3);
    EXPECT_LT(told(tilted, undrifted).angularDistance(tilted), 2e-3);
    const HaplyFrame anew{.q_align = told(held, aligned).conjugate() * held};
    EXPECT_LT(told(held, anew).angularDistance(held), 2e-3);
    EXPECT_GE(told(tilted, anew).angularDistance(tilted) + 2e-3, std::abs(drift)) << "aligned anew";
  }
}

TEST(HaplySession, DoubtsALostEventChannelAfterASecond) {
  Wire wire;
  wire.run(0.6);
  wire.arm();
  wire.session.eventsAre(false, wire.now);
  wire.run(0.9);
  EXPECT_FALSE(wire.session.doubted());
  wire.run(0.2);
  EXPECT_TRUE(wire.session.doubted());
}

// A force that ended while the service was away for 40 ms looked like one that nobody had
// asked for; an echo that was late, like none.
TEST(HaplySession, DoesNotTakeALateServiceForAWildOne) {
  Wire wire;
  wire.run(0.6);
  wire.session.arm(0, wire.now);
  wire.pauseService(0.06);
  wire.run(0.25);
  EXPECT_FALSE(wire.session.doubted()) << wire.session.complaint();
  wire.push({0, 0, 1});
  wire.run(0.1);
  ASSERT_NEAR(wire.force(), 1, 1e-6) << wire.session.complaint();
  wire.push({0, 0, 0.05});
  wire.pauseService(0.04);
  wire.run(0.1);
  EXPECT_FALSE(wire.session.doubted()) << wire.session.complaint();
  EXPECT_NEAR(wire.force(), 0.05, 1e-6);
}

// Forces that stop coming are zero at once, not at the next turn.
TEST(HaplySession, SendsZerosBeforeTheLastAnswerCame) {
  Wire wire;
  wire.run(0.6);
  wire.arm();
  wire.push({0, 0, 1});
  wire.run(0.1);
  while (wire.session.underWay() == 0) wire.run(1e-4);
  wire.session.disarm(0);
  EXPECT_FALSE(wire.session.next(wire.now).empty());
  EXPECT_TRUE(wire.session.next(wire.now).empty());
}

TEST(HaplySession, CommandsNothingThatIsNotANumber) {
  Wire wire;
  wire.run(0.6);
  wire.arm();
  wire.push({0, 0, 1});
  wire.run(0.1);
  wire.push({0, 0, NAN});
  wire.run(0.001);
  EXPECT_EQ(wire.force(), 0);
}

}  // namespace
}  // namespace pincer::devices::haply
