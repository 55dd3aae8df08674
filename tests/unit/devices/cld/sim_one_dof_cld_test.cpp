#include "pincer/devices/cld/sim_one_dof_cld.h"

#include <gtest/gtest.h>

#include <cmath>
#include <set>
#include <stdexcept>

#include "pincer/tests/support/constants.h"

namespace pincer::devices {
namespace {

// Half of the roller's travel while it follows a sine of `amplitude` [m] at `frequency` [Hz], once it is steady.
double rollerAmplitude(SimOneDofCld& cld, double amplitude, double frequency) {
  const int period = static_cast<int>(1000 / frequency);
  double low = 1, high = -1;
  for (int i = 0; i < 5 * period; ++i) {
    cld.command({false, Vec2(amplitude * std::sin(2 * tests::kPi * i / period), 0)});
    cld.advance(1e-3);
    if (i < 3 * period) continue;
    low = std::min(low, cld.trueRoller()), high = std::max(high, cld.trueRoller());
  }
  return (high - low) / 2;
}

double rollerAmplitude(double amplitude, double frequency) {
  SimOneDofCld cld;
  return rollerAmplitude(cld, amplitude, frequency);
}

TEST(SimOneDofCld, MapsSixteenMillimetresOfArcToSixteenOfTravel) {
  const OneDofMap map;
  EXPECT_EQ(map.carriageOf(0.008), 0.008);
  EXPECT_EQ(map.placeOf(map.carriageOf(0.003)), 0.003);
  EXPECT_NEAR(map.angleOf(0.008), 0.8, 1e-15);  // 46 degrees on a finger of 20 mm
  const OneDofMap small{.finger_diameter = 0.013};
  EXPECT_NEAR(small.angleOf(0.008), 0.008 / 0.0065, 1e-15);
}

TEST(SimOneDofCld, BacklashMeasuredFromOutsideIsThePublishedOne) {
  double still = 0, moves = 1e-3;
  while (moves - still > 1e-6) {  // the smallest slow sine that still moves the roller
    const double middle = (still + moves) / 2;
    (rollerAmplitude(middle, 0.2) > 2e-6 ? moves : still) = middle;  // 2 um: the encoder's steps reach the roller
  }
  EXPECT_NEAR(2 * moves, 0.23e-3, 0.01e-3);
}

TEST(SimOneDofCld, BandwidthMeasuredFromOutsideIsAboveFiveHertz) {
  const double slow = rollerAmplitude(2e-3, 0.2);
  double frequency = 1;
  while (frequency < 40 && rollerAmplitude(2e-3, frequency) > slow * std::sqrt(0.5)) frequency += 0.25;
  EXPECT_GT(frequency, 5);
  EXPECT_LT(frequency, 15);
}

TEST(SimOneDofCld, MeasuresInStepsOfItsEncoder) {
  SimOneDofCld cld;
  cld.command({false, Vec2(0.004, 0)});
  for (int i = 0; i < 3000; ++i) {
    cld.advance(1e-3);
    const double steps = cld.sample().place_L->x() / 0.8e-6;
    EXPECT_NEAR(steps, std::round(steps), 1e-6);
    EXPECT_LE(std::abs(cld.sample().place_L->x() - cld.trueCarriage()), 0.4e-6 + 1e-12);
  }
  EXPECT_NEAR(cld.trueCarriage(), 0.004, 1e-6);  // the integral leaves an encoder step at most
}

TEST(SimOneDofCld, ACommandTravelsForOneOrTwoMilliseconds) {
  std::set<int> seen;
  for (int phase = 0; phase < 50; ++phase) {
    SimOneDofCld cld;
    cld.advance(1e-3 * (phase + 1));
    cld.command({false, Vec2(0.005, 0)});
    int ticks = 0;
    for (; cld.trueCarriage() == 0 && ticks < 10; ++ticks) cld.advance(1e-3);
    seen.insert(ticks - 1);  // the motion shows at the end of the millisecond in which it begins
  }
  EXPECT_EQ(seen, (std::set<int>{1, 2}));
}

TEST(SimOneDofCld, ShowsTheExperimentersBacklashAndDelay) {
  SimOneDofCld cld;
  cld.setTransmission({.backlash = 2e-3});
  // 0.1 mm: the loop's overshoot at 0.2 Hz
  EXPECT_NEAR(rollerAmplitude(cld, 4e-3, 0.2), 4e-3 - 1e-3 - 0.115e-3, 0.1e-3);
  SimOneDofCld prompt, late;
  late.setTransmission({.delay = 61});
  for (int i = 0; i < 62; ++i) {
    if (i == 1) prompt.command({false, Vec2(0.005, 0)}), late.command({false, Vec2(0.005, 0)});
    prompt.advance(1e-3), late.advance(1e-3);
    EXPECT_EQ(late.trueCarriage(), 0) << i;
  }
  EXPECT_GT(prompt.trueCarriage(), 1e-3);
  for (int i = 0; i < 10; ++i) late.advance(1e-3);
  EXPECT_GT(late.trueCarriage(), 0);
}

TEST(SimOneDofCld, StandsStillWhileFrozen) {
  SimOneDofCld cld;
  cld.setTransmission({.frozen = true});
  for (int i = 0; i < 1000; ++i) {
    cld.command({false, Vec2(0.006, 0)});
    cld.advance(1e-3);
  }
  EXPECT_EQ(cld.trueRoller(), 0);
}

TEST(SimOneDofCld, MovesWhatItCantReachToTheNearestPlaceAndSaysSo) {
  SimOneDofCld cld;
  EXPECT_FALSE(cld.command({false, Vec2(0.008, 0)}));
  EXPECT_TRUE(cld.command({false, Vec2(0.009, 0)}));
  EXPECT_TRUE(cld.command({false, Vec2(0, 1e-3)}));
  EXPECT_TRUE(cld.command({false, Vec2(0.005, tests::kNan)}));
  EXPECT_FALSE(cld.command({true, Vec2(1, 1)})) << "parked is the centre, wherever the place";
  cld.command({false, Vec2(0.02, 0)});
  for (int i = 0; i < 3000; ++i) cld.advance(1e-3);
  EXPECT_NEAR(cld.trueCarriage(), 0.008, 1e-6);
}

TEST(SimOneDofCld, SuffersEveryFault) {
  SimOneDofCld cld;
  cld.setFault(SimFault::kStuckMotor);
  cld.command({false, Vec2(0.005, 0)});
  for (int i = 0; i < 100; ++i) cld.advance(1e-3);
  EXPECT_EQ(cld.trueRoller(), 0);
  cld.setFault(SimFault::kInvalidSamples);
  EXPECT_FALSE(cld.sample().valid);
  cld.setFault(SimFault::kNotFinitePosition);
  EXPECT_TRUE(std::isnan(cld.sample().place_L->x()));
  cld.setFault(SimFault::kUnplugged);
  EXPECT_EQ(cld.state(), DeviceState::kFaulted);
  EXPECT_FALSE(cld.sample().place_L);
  cld.setFault(SimFault::kNone);
  cld.setFault(SimFault::kFrozenSamples);
  const double time = cld.sample().time;
  cld.advance(0.1);
  EXPECT_EQ(cld.sample().time, time);
}

TEST(SimOneDofCld, RefusesSettingsOutOfRange) {
  SimOneDofCldSettings settings;
  settings.loop_frequency = 0;
  EXPECT_THROW(SimOneDofCld{settings}, std::invalid_argument);
  settings = {};
  settings.play = -1;
  EXPECT_THROW(SimOneDofCld{settings}, std::invalid_argument);
  SimOneDofCld cld;
  EXPECT_THROW(cld.setTransmission({.delay = 1000}), std::invalid_argument);
}

}  // namespace
}  // namespace pincer::devices
