// The feel of a stroke: bands of the skin's motion, and one percept of push and tactor.
#include <gtest/gtest.h>

#include <cmath>

#include "pincer/tasks/lab/participants/roughness.h"

namespace pincer::tasks {
namespace {

double rmsOf(BandPower band, double amplitude, double frequency) {
  for (int k = 0; k < 6000; ++k) band.add(amplitude * std::sin(2 * M_PI * frequency * 1e-3 * k), k >= 2000);
  return band.rms();
}

// A cascade of three first-order high-passes: gain (1 + (f1/f)^2)^(-3/2); of two low-passes at 50 Hz
// 1 / (1 + (f/50)^2). 10 %: a step of 1 ms.
TEST(BandPower, LeavesOutAStrokesOwnMotion) {
  const BandPower slow(5, 50);
  const double whole = 8e-3, bump = 0.07e-3;
  EXPECT_LT(rmsOf(slow, whole, 0.25), 1.5e-6) << "8 mm to and fro in four seconds is below the threshold of 7 um";
  EXPECT_NEAR(rmsOf(slow, bump, 15), bump / std::sqrt(2.0) * std::pow(1 + 1.0 / 9, -1.5) / (1 + 0.09), 0.1 * bump);
}

// One reading of a push of 5 Hz-wide pulses and of a tactor that jumps `step` every 50 ms.
void feel(RoughnessSense& sense, std::size_t interval, double push, std::optional<double> step, Random& random) {
  sense.clear();
  for (int k = 0; k < 4000; ++k) {
    sense.feelPush({0, 1 + push * ((k / 25) % 2)}, k > 500);
    if (step) sense.feelTactor(*step * ((k / 25) % 2), k > 500);
  }
  sense.read(interval, random);
}

double shareOfSecond(double push, std::optional<double> reference, std::optional<double> step) {
  RoughnessSense sense({}, 0.75);
  Random random(1);
  int second = 0;
  for (int k = 0; k < 60; ++k) {
    feel(sense, 0, 0, reference, random);
    feel(sense, 1, push, step, random);
    second += sense.rougher() == 2;
  }
  return second / 60.0;
}

// The rougher of two is named where either sense tells, guessed where none does (0.5 +- 4 SD of 60 guesses).
TEST(RoughnessSense, NamesTheRougher) {
  EXPECT_EQ(shareOfSecond(0.2, {}, {}), 1);
  EXPECT_EQ(shareOfSecond(0, 1e-6, 0.1e-3), 1);
  EXPECT_NEAR(shareOfSecond(0, {}, {}), 0.5, 0.26);
}

// The same push is told less surely once the tactor says "smooth": a quarter of its weight is
// left. A parked tactor takes nothing away.
TEST(RoughnessSense, ASmoothTactorOutweighsARoughPush) {
  const double push = 0.015;
  EXPECT_LT(shareOfSecond(push, 1e-6, 1e-6), shareOfSecond(push, {}, {}));
}

}  // namespace
}  // namespace pincer::tasks
