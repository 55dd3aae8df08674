#include "pincer/devices/cld/tactor_error.h"

#include <gtest/gtest.h>

#include <cmath>

#include "pincer/devices/cld/sim_cld.h"
#include "pincer/tests/support/constants.h"

namespace pincer::devices {
namespace {

DisplayFigures perfect() { return {0, 100, 0.8, 100, Vec2::Zero(), 1e-9}; }  // as fast as the meter's own steps allow

TactorErrors errorsOn(const DisplayFigures& figures, double amplitude, double frequency) {
  TactorErrorMeter meter(figures);
  for (int i = 0; i < 10000; ++i) {
    meter.add(Vec2(amplitude * std::sin(2 * tests::kPi * frequency * 1e-3 * i), 0), std::nullopt, 1e-3);
  }
  return meter.result();
}

TEST(TactorError, BlamesEachPartForItsOwn) {
  const double speed = 2e-3 * 2 * tests::kPi / std::sqrt(2.0);  // rms, of a sine of 2 mm at 1 Hz [m/s]
  DisplayFigures slow = perfect();
  slow.delay = 20e-3;
  EXPECT_NEAR(errorsOn(slow, 2e-3, 1).delay, speed * 20e-3, 0.02 * speed * 20e-3);
  DisplayFigures loose = perfect();
  loose.play = Vec2(1e-3, 0);
  EXPECT_NEAR(errorsOn(loose, 4e-3, 1).play, 0.5e-3, 0.05e-3) << "half of the play on either side";
  DisplayFigures narrow = perfect();
  narrow.natural_frequency = 8, narrow.damping_ratio = 0.8;
  EXPECT_NEAR(errorsOn(narrow, 2e-3, 1).bandwidth, speed * 2 * 0.8 / (2 * tests::kPi * 8), 0.03 * speed * 0.032);
  DisplayFigures coarse = perfect();
  coarse.resolution = 53e-6;
  EXPECT_NEAR(errorsOn(coarse, 2e-3, 1).quantisation, 53e-6 / std::sqrt(12.0), 2e-6) << "a uniform error within a step";
}

TEST(TactorError, OfAFastDisplayIsSmall) {
  const TactorErrors e = errorsOn(perfect(), 2e-3, 1);
  EXPECT_LT(e.total, 30e-6);  // 2.5 ms behind 9 mm/s
  EXPECT_EQ(e.beyond_limit, 0);
}

// The chain in the meter and the simulated display agree on the whole.
TEST(TactorError, IsThatOfTheSimulatedDisplay) {
  SimCld cld;
  TactorErrorMeter from_truth({}), from_chain({});
  for (int i = 0; i < 20000; ++i) {
    const Vec2 wanted(-0.004 + 3e-3 * std::sin(2 * tests::kPi * 1e-3 * i),
                      2e-3 * std::cos(2 * tests::kPi * 0.7e-3 * i));
    cld.command({false, wanted});
    cld.advance(1e-3);
    if (i < 2000) continue;
    from_truth.add(wanted, cld.trueTactor_L(), 1e-3);
    from_chain.add(wanted, std::nullopt, 1e-3);
  }
  // its frames wait up to 2 ms more
  EXPECT_NEAR(from_truth.result().total, from_chain.result().total, 0.1 * from_truth.result().total);
  EXPECT_GT(from_truth.result().worst, from_truth.result().total);
}

TEST(TactorError, LagOfThePublishedDisplayIsBelowWhatPeopleNotice) { EXPECT_LT(DisplayFigures{}.lag(), kDelayLimit); }

TEST(TactorError, LeavesOutWhatIsNotANumber) {
  TactorErrorMeter meter({});
  meter.add(Vec2(tests::kNan, 0), std::nullopt, 1e-3);
  EXPECT_EQ(meter.result().total, 0);
}

}  // namespace
}  // namespace pincer::devices
