#include "pincer/devices/cld/sim_cld.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <numbers>
#include <set>
#include <stdexcept>

#include "pincer/tests/support/constants.h"
#include "pincer/tests/support/random_numbers.h"

namespace pincer::devices {
namespace {

using tests::kNan;

// Half of the tactor's travel, peak to peak, while `axis` follows a sine of `amplitude`
// [m] at `frequency` [Hz], once it is steady.
double tactorAmplitude(int axis, double amplitude, double frequency) {
  SimCld cld;
  // ticks: 2 and 3 periods
  const int settle = static_cast<int>(2000 / frequency), cycles = static_cast<int>(3000 / frequency);
  double low = kNan, high = kNan;
  for (int i = 0; i < settle + cycles; ++i) {
    Vec2 place = Vec2::Zero();
    place[axis] = amplitude * std::sin(2 * std::numbers::pi * frequency * i * 1e-3);
    cld.command({false, place});
    cld.advance(1e-3);
    if (i < settle) continue;
    low = std::fmin(low, cld.trueTactor_L()[axis]);
    high = std::fmax(high, cld.trueTactor_L()[axis]);
  }
  return (high - low) / 2;
}

// The dissertation's method: backlash is the travel of the smallest slow sine that still moves the tactor.
double measuredBacklash(int axis) {
  double still = 0, moves = 2e-3;
  while (moves - still > 1e-7) {
    const double middle = (still + moves) / 2;
    (tactorAmplitude(axis, middle, 0.2) > 1e-9 ? moves : still) = middle;
  }
  return moves + still;
}

TEST(SimCld, BacklashMeasuredFromOutsideIsThePublishedOne) {
  // 1 %: the actuator's own response at 0.2 Hz is 1 - (0.2/8)^2 of the command's.
  EXPECT_NEAR(measuredBacklash(0), 1.13e-3, 0.01e-3);
  EXPECT_NEAR(measuredBacklash(1), 0.42e-3, 0.01e-3);
}

// -3 dB against the slow response to a sine of the same 2 mm, so that the backlash's own loss doesn't count twice.
double measuredBandwidth(int axis) {
  const double slow = tactorAmplitude(axis, 2e-3, 0.2);
  double frequency = 1;
  while (frequency < 20 && tactorAmplitude(axis, 2e-3, frequency) > slow * std::numbers::sqrt2 / 2) frequency += 0.1;
  return frequency;
}

TEST(SimCld, BandwidthMeasuredFromOutsideIsAboveFiveHertz) {
  for (int axis = 0; axis < 2; ++axis) {
    const double bandwidth = measuredBandwidth(axis);
    EXPECT_GT(bandwidth, 5);
    EXPECT_LT(bandwidth, 8) << "better than the device that is modelled";
    RecordProperty(axis == 0 ? "bandwidth_pd_hz" : "bandwidth_ru_hz", std::to_string(bandwidth));
  }
}

TEST(SimCld, MeasuresItsPlaceInStepsOf53Micrometres) {
  SimCld cld;
  double last = 0;
  std::set<long> steps;
  for (int i = 0; i < 5000; ++i) {
    cld.command({false, Vec2(i * 1e-6, 0)});
    cld.advance(1e-3);
    const double place = cld.sample().place_L->x();
    EXPECT_LE(std::abs(place - cld.trueActuator_L().x()), 53e-6 / 2 + 1e-12);
    if (place != last) steps.insert(std::lround((place - last) * 1e9));
    last = place;
  }
  EXPECT_EQ(steps, std::set<long>{53000});  // [nm]
}

// From a command in step with the device's 500 Hz frames to the first motion of the
// actuator, and from one at any other moment.
TEST(SimCld, AnswersACommandWithinItsDelayAndOneFrame) {
  for (int phase = 0; phase < 8; ++phase) {
    SimCld cld;
    for (int i = 0; i < phase; ++i) cld.advance(0.25e-3);
    cld.command({false, Vec2(0.005, 0)});
    double delay = 0;
    for (; cld.trueActuator_L().x() == 0 && delay < 0.01; delay += 0.25e-3) cld.advance(0.25e-3);
    // The motion shows at the end of the half millisecond in which it began.
    EXPECT_LE(delay, (phase == 0 ? 2e-3 : 4e-3) + 1e-9) << "phase " << phase;
    EXPECT_GT(delay, 1.5e-3) << "phase " << phase;
  }
}

TEST(SimCld, MovesAtItsTopSpeedAndNoFaster) {
  SimCld cld;
  cld.command({false, Vec2(-0.012, 0)});
  cld.advance(1);
  cld.command({false, Vec2(0.012, 0)});
  double fastest = 0;
  for (int i = 0; i < 1000; ++i) {
    const double before = cld.trueTactor_L().x();
    cld.advance(1e-3);
    fastest = std::max(fastest, (cld.trueTactor_L().x() - before) / 1e-3);
  }
  EXPECT_GT(fastest, 0.074);
  EXPECT_LE(fastest, cld.capabilities().speed * (1 + 1e-9));
}

// How far the actuator overshoots when it crosses the pad by `step`, read every millisecond.
double overshoot(double step) {
  SimCld cld;
  cld.command({false, Vec2(-step / 2, 0)});
  cld.advance(2);
  cld.command({false, Vec2(step / 2, 0)});
  double highest = 0;
  for (int i = 0; i < 1000; ++i) {
    cld.advance(1e-3);
    highest = std::max(highest, cld.trueActuator_L().x());
  }
  return highest - step / 2;
}

// A second-order response overshoots by exp(-pi zeta / sqrt(1 - zeta^2)) = 1.5 % of a step. A long step runs at
// top speed until only so much of it is left (4.7 mm) that a response from rest would never be faster: the limit
// must not store up speed and let it go later.
TEST(SimCld, OvershootsAsASecondOrderResponseWhetherTheStepIsShortOrLong) {
  const double zeta = 0.8, w = 2 * std::numbers::pi * 8, root = std::sqrt(1 - zeta * zeta);
  const double share = std::exp(-std::numbers::pi * zeta / root);
  const double never_limited = 0.1 / (w * std::exp(-std::acos(zeta) * zeta / root));
  EXPECT_NEAR(overshoot(1e-3), share * 1e-3, 0.01 * share * 1e-3);  // 1 %: read every millisecond, limited every half
  EXPECT_NEAR(overshoot(16e-3), share * never_limited, 0.01 * share * never_limited);
}

TEST(SimCld, MovesAnUnreachablePlaceToTheNearestReachableOneAndSaysSo) {
  SimCld cld;
  EXPECT_FALSE(cld.command({false, Vec2(cld.capabilities().reach.x(), 0)}));
  EXPECT_TRUE(cld.command({false, Vec2(0.02, -0.003)}));
  cld.advance(2);
  const Vec2 nearest = cld.kinematics().reach(Vec2(0.02, -0.003)).place_L;
  EXPECT_NEAR((cld.trueActuator_L() - nearest).norm(), 0, 1e-9);  // settled
  EXPECT_GT(nearest.x(), 0.0115);
  EXPECT_LT(nearest.y(), -0.001);
}

TEST(SimCld, ParksAtTheCentreWhateverThePlace) {
  SimCld cld;
  cld.command({false, Vec2(0.008, 0.004)});
  cld.advance(2);
  EXPECT_FALSE(cld.command({true, Vec2(0.008, 0.004)}));
  cld.advance(2);
  EXPECT_LE(cld.trueActuator_L().norm(), 1e-9);                     // settled
  EXPECT_LE(std::abs(cld.trueTactor_L().x()), 1.13e-3 / 2 + 1e-9);  // it may rest anywhere within the play
}

TEST(SimCld, RefusesAPlaceThatIsNotANumber) {
  SimCld cld;
  cld.command({false, Vec2(0.004, 0)});
  cld.advance(2);
  EXPECT_TRUE(cld.command({false, Vec2(kNan, 0)}));
  cld.advance(2);
  EXPECT_NEAR(cld.trueActuator_L().x(), 0.004, 1e-9);
}

TEST(SimCld, TactorStaysWithinThePlayAndTheReach) {
  tests::RandomNumbers draw(1);
  SimCld cld;
  const TwoDofGeometry& stops = cld.kinematics().geometry();
  for (int i = 0; i < 100000; ++i) {
    if (draw.below(20) == 0)
      cld.command({draw.below(5) == 0, Vec2{draw.uniform(-0.03, 0.03), draw.uniform(-0.03, 0.03)}});
    cld.advance(draw.uniform(1e-5, 2e-3));
    const PadWay tactor = cld.kinematics().wayTo(cld.trueTactor_L()),
                 actuator = cld.kinematics().wayTo(cld.trueActuator_L());
    // 1 nm: the way back from a place a quarter turn away
    ASSERT_LE(std::abs(tactor.along - actuator.along), 1.13e-3 / 2 + 1e-9);
    ASSERT_LE(0.008 * std::abs(tactor.round - actuator.round), 0.42e-3 / 2 + 1e-9);
    ASSERT_TRUE(actuator.along >= stops.place_min - 1e-9 && actuator.along <= stops.place_max + 1e-9);
    ASSERT_LE(std::abs(actuator.round), stops.carriage_max + 1e-9);
  }
}

// The firmware's clock is its own: how the caller slices time doesn't matter.
TEST(SimCld, DoesNotDependOnTheCallersSlices) {
  SimCld fine, coarse;
  for (int i = 0; i < 500; ++i) {
    const TactileCommand command{false, Vec2(0.006 * std::sin(0.05 * i), 0.004 * std::cos(0.03 * i))};
    fine.command(command);
    coarse.command(command);
    for (int k = 0; k < 8; ++k) fine.advance(0.25e-3);
    coarse.advance(2e-3);
    ASSERT_EQ(fine.trueTactor_L(), coarse.trueTactor_L());
  }
}

TEST(SimCld, IsItsOwnSnapshot) {
  SimCld cld;
  cld.command({false, Vec2(0.007, -0.002)});
  cld.advance(0.0213);
  SimCld copy = cld;
  cld.advance(0.1);
  copy.advance(0.1);
  EXPECT_EQ(cld.trueTactor_L(), copy.trueTactor_L());
  EXPECT_EQ(cld.sample().place_L, copy.sample().place_L);
}

TEST(SimCld, SuffersTheFaultsOfARealOne) {
  SimCld cld;
  cld.command({false, Vec2(0.007, 0)});
  cld.advance(0.05);
  cld.setFault(SimFault::kFrozenSamples);
  const double frozen = cld.sample().time;
  cld.advance(0.05);
  EXPECT_EQ(cld.sample().time, frozen);
  cld.setFault(SimFault::kInvalidSamples);
  EXPECT_FALSE(cld.sample().valid);
  EXPECT_FALSE(cld.sample().place_L);
  cld.setFault(SimFault::kNotFinitePosition);
  EXPECT_TRUE(std::isnan(cld.sample().place_L->x()));
  cld.setFault(SimFault::kStuckMotor);
  cld.command({false, Vec2(-0.007, 0)});
  const Vec2 stuck = cld.trueActuator_L();
  cld.advance(0.5);
  EXPECT_EQ(cld.trueActuator_L(), stuck);
  cld.setFault(SimFault::kUnplugged);
  EXPECT_EQ(cld.state(), DeviceState::kFaulted);
  EXPECT_FALSE(cld.sample().valid);
  cld.setFault(SimFault::kNone);
  cld.advance(1);
  EXPECT_EQ(cld.state(), DeviceState::kReady);
  EXPECT_NEAR(cld.sample().place_L->x(), -0.007, 53e-6);
}

// Plate on the cylinder, ring on the tip, carriage round both.
TEST(SimCld, LeadsItsThreeActuatorsByTheFingersProfile) {
  SimCld cld;
  cld.command({false, Vec2(-0.006, 0.004)});
  cld.advance(2);
  EXPECT_NEAR((cld.trueActuators() - Vec3(-0.006, 0, 0.5)).norm(), 0, 1e-6);
  cld.command({false, Vec2(0.004, 0)});
  cld.advance(2);
  EXPECT_NEAR((cld.trueActuators() - Vec3(0, 0.5, 0)).norm(), 0, 1e-6);
}

TEST(SimCld, JitterDelaysACommandByUpToItsSize) {
  SimCldSettings settings;
  settings.delay = 1e-3;
  settings.jitter = 1e-3;
  SimCld cld(settings);
  std::set<int> delays;
  for (int k = 0; k < 60; ++k) {
    const double before = cld.trueActuator_L().x();
    cld.command({false, Vec2(k % 2 ? 0.004 : -0.004, 0)});
    int half_ms = 0;
    for (; cld.trueActuator_L().x() == before && half_ms < 20; ++half_ms) cld.advance(0.5e-3);
    delays.insert(half_ms - 1);
    for (; half_ms < 4000; ++half_ms) cld.advance(0.5e-3);  // at rest again, and in step with the frames
  }
  EXPECT_EQ(delays, (std::set<int>{2, 3, 4}));
}

TEST(SimCld, NamesASettingThatIsOutOfRange) {
  SimCldSettings settings;
  settings.delay = 0.01;
  EXPECT_THROW(SimCld{settings}, std::invalid_argument);
  settings = {};
  settings.speed = kNan;
  EXPECT_THROW(SimCld{settings}, std::invalid_argument);
}

}  // namespace
}  // namespace pincer::devices
