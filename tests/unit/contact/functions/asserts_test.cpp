// The two kinds of promises that end the program when they are broken, and what they ask of vectors, frames and lists.
#include <gtest/gtest.h>

#include <limits>
#include <vector>

#include "pincer/contact/functions/invariants.h"

namespace pincer {
namespace {

constexpr double kNaN = std::numeric_limits<double>::quiet_NaN();

// Returns `answer`, and counts how often it was asked.
bool asked(int& times, bool answer) {
  ++times;
  return answer;
}

TEST(Demand, EndsTheProgramWithPlaceMessageAndCondition) {
  const std::vector<int> inputs(1);
  EXPECT_DEATH(
      PINCER_DEMAND(inputs.size() == 2, "one input per finger"),
      "asserts_test.cpp:[0-9]+: one input per finger .inputs.size.. == 2 doesn't hold.. The program that calls pincer");
}

TEST(Demand, IsAskedOnceAndSilentWhereItHolds) {
  int times = 0;
  PINCER_DEMAND(asked(times, true), "never read");
  EXPECT_EQ(times, 1);
}

#ifdef PINCER_ASSERTS
TEST(Assert, EndsTheProgramWithPlaceAndCondition) {
  const Vec3 n(0, 0, 1.1);
  EXPECT_DEATH(PINCER_ASSERT(isUnit(n)), "asserts_test.cpp:[0-9]+: isUnit.n. doesn't hold. That is an error in pincer");
}

TEST(Assert, IsAskedOnceAndSilentWhereItHolds) {
  int times = 0;
  PINCER_ASSERT(asked(times, true));
  EXPECT_EQ(times, 1);
}
#else
TEST(Assert, IsNotAskedInThisBuild) {
  int times = 0;
  PINCER_ASSERT(asked(times, false));
  EXPECT_EQ(times, 0);
}
#endif

// Round-off of a chain of rotations passes; the seventh digit of a number written by hand doesn't.
TEST(Invariants, UnitMeansToRoundOff) {
  Vec3 n = Vec3(1, 2, 3).normalized();
  const Quat turn = quatFromRotationVector(Vec3(0.1, -0.2, 0.3));
  for (int i = 0; i < 1000; ++i) n = turn * n;
  EXPECT_TRUE(isUnit(n));
  EXPECT_TRUE(isUnit(turn));
  EXPECT_FALSE(isUnit(Vec3(0, 0, 1 + 1e-7)));
  EXPECT_FALSE(isUnit(Quat(0, 0, 0, 0)));
  EXPECT_FALSE(isUnit(Vec3(0, 0, kNaN)));
  EXPECT_TRUE(isUnitIfFinite(Vec3(0, 0, kNaN)));
  EXPECT_FALSE(isUnitIfFinite(Vec3(0, 0, 1.1)));
}

TEST(Invariants, FramesAreOrthonormalAndRightHanded) {
  Mat3 R = frameFromNormal(Vec3(1, 2, 3).normalized());
  EXPECT_TRUE(isRotation(R));
  R.col(0).swap(R.col(1));
  EXPECT_FALSE(isRotation(R)) << "left-handed";
  R = Mat3::Identity();
  R(0, 1) = 1e-6;
  EXPECT_FALSE(isRotation(R)) << "not at right angles";
  R(0, 1) = kNaN;
  EXPECT_FALSE(isRotation(R));
  EXPECT_TRUE(isRotationIfFinite(R));
}

TEST(Invariants, SymmetricMeansToRoundOff) {
  Mat3 A = Mat3::Identity();
  A(0, 1) = 0.3;
  A(1, 0) = 0.3 + 1e-16;
  EXPECT_TRUE(isSymmetric(A));
  A(1, 0) = 0.3 + 1e-9;
  EXPECT_FALSE(isSymmetric(A));
}

TEST(Invariants, AscendingKeysRiseStrictly) {
  const auto self = [](int x) { return x; };
  EXPECT_TRUE(isAscending(std::vector<int>{}, self));
  EXPECT_TRUE(isAscending(std::vector<int>{1, 2, 5}, self));
  EXPECT_FALSE(isAscending(std::vector<int>{1, 2, 2}, self));
  EXPECT_FALSE(isAscending(std::vector<int>{2, 1}, self));
}

TEST(Invariants, IndicesAreOfWhatIsThere) {
  EXPECT_TRUE(isIndex(0, 1));
  EXPECT_FALSE(isIndex(-1, 1));
  EXPECT_FALSE(isIndex(1, 1));
}

}  // namespace
}  // namespace pincer
