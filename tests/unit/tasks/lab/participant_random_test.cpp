#include <gtest/gtest.h>
#include <rapidcheck/gtest.h>

#include <cmath>
#include <set>

#include "pincer/tasks/lab/participants/body.h"
#include "pincer/tasks/lab/participants/random.h"
#include "pincer/tasks/lab/participants/reach.h"

namespace pincer::tasks {
namespace {

constexpr int kDraws = 100000;

TEST(ParticipantRandom, RepeatsItselfForOneSeedAndDiffersForAnother) {
  Random a(7), b(7), c(8);
  for (int i = 0; i < 100; ++i) {
    const auto value = a.bits();
    EXPECT_EQ(value, b.bits());
    EXPECT_NE(value, c.bits());
  }
}

// The generator's own definition, written out for the first output: rotl(s0 + s3, 23) + s0 with the state from
// splitmix64. The state words for seed 0 are the published outputs of splitmix64.
TEST(ParticipantRandom, IsXoshiro256PlusPlusSeededBySplitmix64) {
  const std::uint64_t s0 = 0xe220a8397b1dcdafu, s3 = 0xf88bb8a8724c81ecu;
  const std::uint64_t sum = s0 + s3;
  EXPECT_EQ(Random(0).bits(), ((sum << 23) | (sum >> 41)) + s0);
}

// Standard errors of mean and variance of N(0, 1) are 1/sqrt(n) and sqrt(2/n); five of them.
TEST(ParticipantRandom, NormalHasMeanZeroAndVarianceOne) {
  Random random(1);
  double sum = 0, squares = 0;
  for (int i = 0; i < kDraws; ++i) {
    const double x = random.normal();
    sum += x;
    squares += x * x;
  }
  EXPECT_NEAR(sum / kDraws, 0, 5 / std::sqrt(kDraws));
  EXPECT_NEAR(squares / kDraws, 1, 5 * std::sqrt(2.0 / kDraws));
}

RC_GTEST_PROP(ParticipantRandom, KeepsToItsRange, (std::uint64_t seed)) {
  const auto bound = *rc::gen::inRange<std::uint64_t>(1, 1000);
  Random random(seed);
  for (int i = 0; i < 50; ++i) {
    RC_ASSERT(random.below(bound) < bound);
    const double x = random.uniform(2, 3);
    RC_ASSERT(x >= 2 && x < 3);
  }
}

TEST(ParticipantRandom, PartsOfASeedAreDistinct) {
  std::set<std::uint64_t> seeds;
  for (std::uint64_t seed = 0; seed < 30; ++seed) {
    for (std::uint64_t part = 0; part < 30; ++part) seeds.insert(seedFor(seed, part));
  }
  EXPECT_EQ(seeds.size(), 900u);
}

TEST(ParticipantBody, IsDrawnWithinItsRanges) {
  const HandRanges ranges;
  for (std::uint64_t seed = 0; seed < 200; ++seed) {
    const Body body = drawBody(ranges, seed);
    EXPECT_TRUE(body.speed >= 0.032 && body.speed < 0.074);
    for (const auto& hand : body.hands) {
      EXPECT_TRUE(hand.mass >= 0.05 && hand.mass < 0.1);
      EXPECT_TRUE(hand.stiffness >= 200 && hand.stiffness < 600);
      EXPECT_TRUE(hand.damping >= 2 && hand.damping < 5);
    }
  }
}

// The mean of the fingers' misplacements has SD 7 mm per axis, their difference
// 4 mm. Five standard errors, SD/sqrt(2 n).
TEST(ParticipantBody, MisplacesPinchLineAndFingersAsSpecified) {
  Random random(3);
  const int n = 5000;
  double shared = 0, between = 0;
  for (int i = 0; i < n; ++i) {
    const BodySense sense = drawBodySense({}, random);
    shared += (0.5 * (sense.misplacement_W[0] + sense.misplacement_W[1])).squaredNorm() / 3;
    between += (sense.misplacement_W[1] - sense.misplacement_W[0]).squaredNorm() / 3;
  }
  EXPECT_NEAR(std::sqrt(shared / n), 7e-3, 5 * 7e-3 / std::sqrt(6.0 * n));
  EXPECT_NEAR(std::sqrt(between / n), 4e-3, 5 * 4e-3 / std::sqrt(6.0 * n));
}

TEST(Reach, StartsAndEndsAtRestAndPeaksAt15Over8OfItsMeanSpeed) {
  const Posture from{Vec3(0, 0, 0.02), 0.07}, to{Vec3(0.03, 0, 0.06), 0.04};
  const double speed = 0.05, step = 1e-6;
  const Reach movement = reach(from, to, 1.0, speed);
  EXPECT_EQ(movement.at(0.5).half, from.half);
  EXPECT_NEAR(movement.at(1.0 + movement.duration).centre_W.x(), to.centre_W.x(), 1e-15);
  EXPECT_TRUE(movement.over(1.0 + movement.duration));
  EXPECT_NEAR(movement.duration * speed, 0.08, 1e-15);  // 50 mm of the centre and 30 mm of closing
  const double middle = 1.0 + movement.duration / 2;
  const double peak = (movement.at(middle + step).half - movement.at(middle - step).half) / (2 * step);
  // the difference quotient's round-off: 1e-17/1e-6
  EXPECT_NEAR(peak, 15.0 / 8 * (to.half - from.half) / movement.duration, 1e-8);
  EXPECT_NEAR((movement.at(1.0 + step).half - from.half) / step, 0, 1e-9);
}

}  // namespace
}  // namespace pincer::tasks
