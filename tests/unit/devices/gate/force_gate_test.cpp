#include "pincer/devices/gate/force_gate.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <set>

#include "pincer/tests/support/constants.h"
#include "pincer/tests/support/effort.h"
#include "pincer/tests/support/random_numbers.h"

namespace pincer::devices {
namespace {

using tests::kNan;

constexpr double kInf = std::numeric_limits<double>::infinity();
const GateLimits kLimits;

// A healthy loop at 1 kHz around the gate.
struct Loop {
  GateLimits limits;
  GateState state;
  GateInput in;

  Loop() {
    arm(state);
    in.sample.valid = true;
  }
  Vec3 tick(const Vec3& wanted) {
    in.f_D = wanted;
    in.now += in.dt;
    in.sample.time = in.now;
    return gateForce(limits, in, state);
  }
  Vec3 ticks(int count, const Vec3& wanted) {
    Vec3 f = Vec3::Zero();
    for (int i = 0; i < count; ++i) f = tick(wanted);
    return f;
  }
};

TEST(ForceGate, IsClosedUntilArmed) {
  Loop loop;
  loop.state = GateState{};
  EXPECT_EQ(loop.ticks(3000, Vec3(1, 0, 0)), Vec3::Zero());
  EXPECT_EQ(loop.state.trip, Trip::kNone);
}

TEST(ForceGate, LetsASmallForceThroughUnchangedOnceTheRampIsOver) {
  Loop loop;
  EXPECT_EQ(loop.ticks(2100, Vec3(0.3, -0.2, 0.1)), Vec3(0.3, -0.2, 0.1));
}

TEST(ForceGate, RampsUpInTwoSeconds) {
  Loop loop;
  for (int i = 1; i <= 2000; ++i) EXPECT_NEAR(loop.tick(Vec3(1, 0, 0)).x(), i / 2000.0, 1e-12);  // 2000 additions of dt
  EXPECT_EQ(loop.tick(Vec3(1, 0, 0)).x(), 1);
}

TEST(ForceGate, ClampsTheVectorAndKeepsItsDirection) {
  Loop loop;
  for (const double size : {8.6, 1e3, 1e160, 1e308}) {
    const Vec3 f = loop.ticks(3000, size * Vec3(0.6, 0, -0.8));
    EXPECT_LE(f.norm(), kLimits.peak_force);
    EXPECT_NEAR(f.norm(), kLimits.peak_force, 1e-12);
    EXPECT_NEAR(f.normalized().dot(Vec3(0.6, 0, -0.8)), 1, 1e-12);
    loop = Loop();
  }
}

TEST(ForceGate, SlewsOneNewtonPerMillisecond) {
  Loop loop;
  loop.ticks(2100, Vec3(-4, 0, 0));
  for (int i = 1; i <= 8; ++i) EXPECT_NEAR(loop.tick(Vec3(4, 0, 0)).x(), -4 + i, 1e-12);
  EXPECT_EQ(loop.tick(Vec3(4, 0, 0)).x(), 4);
}

TEST(ForceGate, BearsThePeakForItsTimeAndThenSinksToTheContinuousForce) {
  Loop loop;
  loop.limits.ramp_time = 0;
  EXPECT_NEAR(loop.ticks(9900, Vec3(0, 20, 0)).norm(), 8.5, 1e-12);
  const double warm = loop.ticks(2100, Vec3(0, 20, 0)).norm();
  EXPECT_LT(warm, 5);
  EXPECT_GT(warm, 1.4);
  // 32 time constants of 1 s; what is left is the sqrt of rounding
  EXPECT_NEAR(loop.ticks(30000, Vec3(0, 20, 0)).norm(), 1.4, 1e-3);
}

// Mean square over any long run is what heats a winding.
TEST(ForceGate, NeverHeatsTheMotorsBeyondTheirBudget) {
  tests::RandomNumbers draw(1);
  Loop loop;
  const double excess = 8.5 * 8.5 - 1.4 * 1.4;
  for (int i = 0; i < 200000; ++i) {
    loop.tick(Vec3(draw.uniform(0, 60), 0, 0));
    ASSERT_LE(loop.state.heat, excess * 11 * (1 + 1e-9));
  }
}

TEST(ForceGate, CoolsWhileClosedAndKeepsItsHeatWhenArmedAgain) {
  Loop loop;
  loop.ticks(12000, Vec3(20, 0, 0));
  const double hot = loop.state.heat;
  trip(loop.state, Trip::kOperator);
  loop.ticks(1000, Vec3::Zero());
  EXPECT_NEAR(loop.state.heat, hot - 1.4 * 1.4, 1e-9);  // 1000 additions
  const double cooler = loop.state.heat;
  arm(loop.state);
  EXPECT_EQ(loop.state.heat, cooler);
}

// Each doubt, alone, in an otherwise healthy loop under force: zero within the very
// tick, latched with its cause, until armed.
struct Doubt {
  Trip cause;
  void (*raise)(GateInput&);
};
class ForceGateTrips : public testing::TestWithParam<Doubt> {};

TEST_P(ForceGateTrips, ToZeroAtOnceAndStayThereUntilArmed) {
  Loop loop;
  ASSERT_GT(loop.ticks(2100, Vec3(3, 0, 0)).norm(), 2.9);
  loop.in.now += loop.in.dt;
  loop.in.sample.time = loop.in.now;
  const GateInput healthy = loop.in;
  GetParam().raise(loop.in);
  EXPECT_EQ(gateForce(loop.limits, loop.in, loop.state), Vec3::Zero());
  EXPECT_EQ(loop.state.trip, GetParam().cause);
  loop.in = healthy;
  EXPECT_EQ(loop.ticks(5000, Vec3(3, 0, 0)), Vec3::Zero());
  EXPECT_EQ(loop.state.trip, GetParam().cause);
  arm(loop.state);
  EXPECT_LE(loop.tick(Vec3(3, 0, 0)).norm(), 3 * 1e-3 / 2 * 1.001) << "the ramp must start anew";
  EXPECT_EQ(loop.ticks(2100, Vec3(3, 0, 0)), Vec3(3, 0, 0));
}

INSTANTIATE_TEST_SUITE_P(
    EveryDoubt, ForceGateTrips,
    testing::Values(Doubt{Trip::kNotFinite, [](GateInput& in) { in.f_D.y() = kNan; }},
                    Doubt{Trip::kNotFinite, [](GateInput& in) { in.f_D.z() = -kInf; }},
                    Doubt{Trip::kNotFinite, [](GateInput& in) { in.v_DF.x() = kNan; }},
                    Doubt{Trip::kNotFinite, [](GateInput& in) { in.sample.p_DF.x() = kInf; }},
                    Doubt{Trip::kNotFinite, [](GateInput& in) { in.sample.v_DF = Vec3(0, kNan, 0); }},
                    Doubt{Trip::kNotFinite, [](GateInput& in) { in.sample.q_DF = Quat(kNan, 0, 0, 0); }},
                    Doubt{Trip::kNotFinite, [](GateInput& in) { in.sample.time = kNan; }},
                    Doubt{Trip::kException, [](GateInput& in) { in.physics_ok = false; }},
                    Doubt{Trip::kInvalidSample, [](GateInput& in) { in.sample.valid = false; }},
                    Doubt{Trip::kGaveUp,
                          [](GateInput& in) {
                            in.sample.valid = false;
                            in.sample.gave_up = true;
                          }},
                    Doubt{Trip::kOverSpeed, [](GateInput& in) { in.v_DF = Vec3(0, 2.001, 0); }},
                    Doubt{Trip::kOverSpeed, [](GateInput& in) { in.v_DF = Vec3(1e200, 1e200, 0); }},
                    Doubt{Trip::kMissedDeadline, [](GateInput& in) { in.dt = 3.1e-3; }},
                    Doubt{Trip::kMissedDeadline, [](GateInput& in) { in.dt = 0; }},
                    Doubt{Trip::kMissedDeadline, [](GateInput& in) { in.dt = -1e-3; }},
                    Doubt{Trip::kMissedDeadline, [](GateInput& in) { in.dt = kNan; }},
                    Doubt{Trip::kStaleSample, [](GateInput& in) { in.now += 3.1e-3; }},
                    Doubt{Trip::kStaleSample, [](GateInput& in) { in.sample.time += 3.1e-3; }},
                    Doubt{Trip::kStaleSample,
                          // fresh, but before the last one
                          [](GateInput& in) { in.sample.time -= 1.5e-3; }},
                    Doubt{Trip::kStaleSample, [](GateInput& in) { in.now = kNan; }}));

TEST(ForceGate, KeepsTheFirstCause) {
  GateState state;
  arm(state);
  trip(state, Trip::kOverSpeed);
  trip(state, Trip::kOperator);
  EXPECT_EQ(state.trip, Trip::kOverSpeed);
}

TEST(ForceGate, AFrozenArmTripsWithinTheWatchdogTime) {
  Loop loop;
  loop.ticks(2100, Vec3(3, 0, 0));
  int late = 0;
  while (loop.state.armed && late < 100) {
    loop.in.now += loop.in.dt;  // the sample's time stands still
    gateForce(loop.limits, loop.in, loop.state);
    ++late;
  }
  EXPECT_LE(late, 4);
  EXPECT_EQ(loop.state.trip, Trip::kStaleSample);
}

TEST(ForceGate, DescribesEveryTripInItsOwnWords) {
  std::set<std::string> sentences;
  for (int t = 0; t <= static_cast<int>(Trip::kOperator); ++t) sentences.insert(describe(static_cast<Trip>(t)));
  EXPECT_EQ(sentences.size(), 9u);
  EXPECT_FALSE(sentences.contains(describe(static_cast<Trip>(200)))) << "a number that is none of them";
}

// A trip on a busy machine said "check the cable", and not what was measured, nor that --watchdog allows more.
TEST(ForceGate, ATripSaysWhatWasMeasuredItsLimitAndTheRemedy) {
  const auto tripText = [](void (*spoil)(GateInput&)) {
    Loop loop;
    loop.ticks(100, Vec3(1, 0, 0));
    loop.in.now += loop.in.dt;
    loop.in.sample.time = loop.in.now;
    spoil(loop.in);
    gateForce(loop.limits, loop.in, loop.state);
    return describe(loop.limits, loop.state);
  };
  const auto expect = [](const std::string& text, std::initializer_list<const char*> parts) {
    for (const char* part : parts) EXPECT_NE(text.find(part), std::string::npos) << text;
  };
  expect(tripText([](GateInput& in) { in.now += 4.2e-3; }), {"4.2 ms", "limit 3", "--watchdog", "cable"});
  expect(tripText([](GateInput& in) { in.dt = 7e-3; }), {"7 ms", "limit 3", "--watchdog"});
  expect(tripText([](GateInput& in) { in.v_DF = Vec3(0, 2.5, 0); }), {"2.5 m/s", "limit 2"});
  expect(tripText([](GateInput& in) { in.sample.valid = false; }), {"cable", "pincer devices list"});
  expect(tripText([](GateInput& in) {
           in.sample.valid = false;
           in.sample.gave_up = true;
         }),
         {"deadline", "--watchdog"});
}

TEST(ForceGate, NamesTheLimitThatIsOutOfRange) {
  EXPECT_FALSE(problemWith(kLimits));
  GateLimits limits;
  limits.slew = -1;
  EXPECT_NE(problemWith(limits).value().find("slew = -1"), std::string::npos);
  limits = {};
  limits.peak_torque = Vec3(1, 1, 0);
  EXPECT_NE(problemWith(limits).value().find("peak_torque"), std::string::npos);
  limits = {.peak_force = kNan};
  EXPECT_NE(problemWith(limits).value().find("peak_force"), std::string::npos);
}

TEST(ForceGate, NamesEveryLimitThatIsNoPositiveNumber) {
  const std::array<std::pair<const char*, double GateLimits::*>, 7> fields{
      {{"peak_force", &GateLimits::peak_force},
       {"continuous_force", &GateLimits::continuous_force},
       {"thermal_time", &GateLimits::thermal_time},
       {"slew", &GateLimits::slew},
       {"ramp_time", &GateLimits::ramp_time},
       {"top_speed", &GateLimits::top_speed},
       {"watchdog_time", &GateLimits::watchdog_time}}};
  for (const auto& [name, field] : fields) {
    for (const double value : {-1.0, kInf, kNan}) {
      GateLimits limits;
      limits.*field = value;
      EXPECT_EQ(problemWith(limits).value_or("").find(name), 0u) << name << " = " << value;
    }
  }
  GateLimits sound;
  sound.peak_torque = Vec3::Ones();
  EXPECT_FALSE(problemWith(sound));
}

TEST(ForceGate, ScalesAllJointsByOneFactorWhereOneWouldBearTooMuch) {
  Loop loop;
  loop.limits.ramp_time = 0;
  loop.limits.peak_torque = Vec3(1.0, 0.5, 2.0);
  Mat3 J;
  J << 0.2, 0, 0.1, 0, 0.3, 0, 0, 0.1, 0.2;
  loop.in.sample.J = J;
  const Vec3 wanted(3, 4, -1);
  const Vec3 f = loop.ticks(50, wanted);
  EXPECT_NEAR((J.transpose() * f)[1], 0.5, 1e-12) << "the second joint is at its bound";
  EXPECT_NEAR(f.cross(wanted).norm(), 0, 1e-12) << "the direction is kept";
  EXPECT_EQ(loop.ticks(50, Vec3(0.1, 0.1, 0.1)), Vec3(0.1, 0.1, 0.1)) << "below the bound nothing changes";
}

TEST(ForceGate, TorqueWinsOverSlewWhenTheArmMovesIntoAWorsePosture) {
  Loop loop;
  loop.limits.ramp_time = 0;
  loop.limits.peak_torque = Vec3::Constant(1.0);
  loop.in.sample.J = Mat3(0.2 * Mat3::Identity());
  ASSERT_NEAR(loop.ticks(20, Vec3(5, 0, 0)).x(), 5, 1e-9);
  loop.in.sample.J = Mat3(2 * Mat3::Identity());
  EXPECT_LE(loop.tick(Vec3(5, 0, 0)).x(), 0.5);
}

// It broke the slew by what the levers had changed: torque was looked at once more behind it.
TEST(ForceGate, KeepsBothSlewAndTorqueWhileTheLeversChangeAndTheWishTurnsRound) {
  Loop loop;
  loop.limits.ramp_time = 0;
  loop.limits.peak_torque = Vec3::Constant(1.0);
  Vec3 last = Vec3::Zero();
  double most_load = 0, most_change = 0;
  for (int i = 0; i < 2000; ++i) {
    Mat3 J = 0.3 * Mat3::Identity();
    J(0, 1) = 0.1 * std::sin(0.07 * i);  // up to 7 mm per tick
    J(2, 0) = 0.1 * std::cos(0.05 * i);
    loop.in.sample.J = J;
    const double turn = 0.1 * (i / 10);
    const Vec3 f = loop.tick(8 * Vec3(std::cos(turn), std::sin(turn), 0.5));
    most_load = std::max(most_load, (J.transpose() * f).cwiseAbs().maxCoeff());
    most_change = std::max(most_change, (f - last).norm());
    last = f;
  }
  EXPECT_LE(most_load, 1 + 1e-12);
  EXPECT_LE(most_change, 1 + 1e-12);
  EXPECT_GT(most_change, 0.99) << "the slew must have been at work";
}

TEST(ForceGate, AnArmNarrowsTheLimitsByWhatItTells) {
  ArmCapabilities arm;
  EXPECT_EQ(within(kLimits, arm).peak_force, kLimits.peak_force) << "0: not told";
  EXPECT_FALSE(within(kLimits, arm).peak_torque);
  arm.peak_force = 3;
  arm.continuous_force = 20;
  arm.peak_torque = Vec3(1, 2, 3);
  GateLimits limits = within(kLimits, arm);
  EXPECT_EQ(limits.peak_force, 3);
  EXPECT_EQ(limits.continuous_force, kLimits.continuous_force);
  EXPECT_EQ(limits.peak_torque.value(), Vec3(1, 2, 3));
  arm.peak_torque = Vec3(2, 1, 4);
  EXPECT_EQ(within(limits, arm).peak_torque.value(), Vec3(1, 1, 3));
}

TEST(ForceGate, AnInfiniteLoadIsNoForce) {
  Loop loop;
  loop.limits.ramp_time = 0;
  loop.limits.peak_torque = Vec3::Constant(1e-300);
  loop.in.sample.J = Mat3(1e300 * Mat3::Identity());
  EXPECT_EQ(loop.ticks(10, Vec3(5, 0, 0)), Vec3::Zero());
}

// A million ticks of whatever an adversary thinks of.
class Adversary {
 public:
  explicit Adversary(std::uint64_t seed) : draw_(seed) {}

  GateInput next() {
    in_.dt = 1e-3;
    in_.now += in_.dt;
    if (!in_.f_D.allFinite() || draw_.below(20) == 0) in_.f_D = force();  // held for long enough to be reached
    in_.v_DF = Vec3{draw_.uniform(-1, 1), draw_.uniform(-1, 1), draw_.uniform(-1, 1)};
    in_.physics_ok = true;
    in_.sample.valid = true;
    in_.sample.p_DF = Vec3::Zero();
    in_.sample.time = in_.now - draw_.uniform(0, 1e-3);
    in_.sample.J = posture();
    if (draw_.below(200) == 0) spoil();
    return in_;
  }
  bool rearms() { return draw_.below(50) == 0; }
  double anyNumber() { return kStrange[draw_.below(static_cast<int>(kStrange.size()))]; }

 private:
  static constexpr std::array<double, 14> kStrange{kNan,  kInf,   -kInf,    0.0, -0.0, 5e-324, -5e-324,
                                                   1e308, -1e308, 2.2e-308, 8.5, -8.5, 1e-3,   1e17};
  Vec3 force() {
    switch (draw_.below(4)) {
      case 0:
        return Vec3::Zero();
      case 1:
        return 20 * Vec3{draw_.uniform(-1, 1), draw_.uniform(-1, 1), draw_.uniform(-1, 1)};
      case 2:
        return (draw_.below(2) ? 8.5 : -8.5) * Vec3::UnitX();
      default:
        return std::exp(draw_.uniform(-740, 700)) *
               Vec3{draw_.uniform(-1, 1), draw_.uniform(-1, 1), draw_.uniform(-1, 1)};
    }
  }
  // An arm that moves: its levers change by up to 1 % per tick, or it doesn't know them.
  std::optional<Mat3> posture() {
    for (int i = 0; i < 9; ++i) J_(i / 3, i % 3) = std::clamp(J_(i / 3, i % 3) + draw_.uniform(-3e-3, 3e-3), -0.3, 0.3);
    if (draw_.below(100) == 0) return std::nullopt;
    return J_;
  }
  void spoil() {
    switch (draw_.below(8)) {
      case 7:
        if (in_.sample.J) (*in_.sample.J)(draw_.below(3), draw_.below(3)) = anyNumber();
        break;
      case 0:
        in_.f_D[draw_.below(3)] = anyNumber();
        break;
      case 1:
        in_.v_DF[draw_.below(3)] = anyNumber();
        break;
      case 2:
        in_.sample.p_DF[draw_.below(3)] = anyNumber();
        break;
      case 3:
        in_.sample.valid = false;
        break;
      case 4:
        in_.sample.time = in_.now + draw_.uniform(-0.1, 0.1);
        break;
      case 5:
        in_.dt = draw_.below(2) ? anyNumber() : draw_.uniform(-4e-3, 4e-3);
        break;
      default:
        in_.physics_ok = false;
        break;
    }
  }

  tests::RandomNumbers draw_;
  GateInput in_;
  Mat3 J_ = 0.2 * Mat3::Identity();
};

void expectSafe(const GateLimits& limits, const GateInput& in, const GateState& before, const GateState& after,
                const Vec3& f) {
  ASSERT_TRUE(f.allFinite());
  ASSERT_LE(f.norm(), limits.peak_force);
  ASSERT_EQ(f, after.f_D);
  ASSERT_TRUE(std::isfinite(after.heat) && after.heat >= 0);
  if (!before.armed || !after.armed) {
    ASSERT_EQ(f, Vec3::Zero());
    ASSERT_FALSE(after.armed) << "armed by itself";
    return;
  }
  const double rounding = 1e-15 * limits.peak_force;  // of one addition and subtraction
  const bool torque_limited = limits.peak_torque && in.sample.J;
  if (torque_limited) {
    const Vec3 load = (in.sample.J->transpose() * f).cwiseQuotient(*limits.peak_torque);
    ASSERT_LE(load.cwiseAbs().maxCoeff(), 1 + 1e-12);
    const double before_load =
        (in.sample.J->transpose() * before.f_D).cwiseQuotient(*limits.peak_torque).cwiseAbs().maxCoeff();
    const double must_fall = before.f_D.norm() * std::max(0.0, 1 - 1 / before_load);
    if (must_fall < limits.slew * in.dt) {
      ASSERT_LE((f - before.f_D).norm(), limits.slew * in.dt + 1e-12)
          << "only a leap into a worse posture may cut faster";
    }
  }
  if (!torque_limited) {
    ASSERT_LE((f - before.f_D).norm(), limits.slew * in.dt + rounding);
  }
  const double ramp = limits.ramp_time > 0 ? std::min(1.0, after.armed_for / limits.ramp_time) : 1;
  ASSERT_LE(f.norm(), std::max(limits.peak_force * ramp, before.f_D.norm()) + rounding);
}

TEST(ForceGate, IsSafeWhateverComesIn) {
  const int ticks = tests::draws(100000);
  for (std::uint64_t seed = 0; seed < 10; ++seed) {
    Adversary adversary(seed);
    GateState state;
    GateLimits limits;
    limits.ramp_time = seed % 2 ? 0.05 : 0;
    limits.thermal_time = seed < 5 ? 0.2 : 100;
    if (seed % 3 == 0) limits.peak_torque = Vec3(0.8, 0.8, 0.6);
    int armed_ticks = 0;
    for (int i = 0; i < ticks; ++i) {
      if (!state.armed && adversary.rearms()) arm(state);
      const GateInput in = adversary.next();
      const GateState before = state;
      const Vec3 f = gateForce(limits, in, state);
      ASSERT_NO_FATAL_FAILURE(expectSafe(limits, in, before, state, f)) << "seed " << seed << ", tick " << i;
      armed_ticks += state.armed;
    }
    EXPECT_GT(armed_ticks, 0.4 * ticks) << "the adversary must not hide behind the latch";
  }
}

}  // namespace
}  // namespace pincer::devices
