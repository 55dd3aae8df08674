// Which stiffness a sampled arm can carry: the bound of theory against the condition that it
// comes from, and against the loop itself.
#include <gtest/gtest.h>

#include <algorithm>
#include <complex>

#include "pincer/grasp/hold_bounds.h"
#include "pincer/tests/support/constants.h"

namespace pincer::grasp {
namespace {

constexpr double kHoldTick = 1e-3;

// Colgate & Schenkel's condition, by brute force over frequency.
double requiredByFrequency(double K, double B, double T, double lead) {
  using Complex = std::complex<double>;
  double most = 0;
  for (int i = 1; i <= 20000; ++i) {
    const double wT = tests::kPi * i / 20000;
    const Complex back = std::exp(Complex(0, -wT)), H = K * (1.0 + lead * (1.0 - back)) + B / T * (1.0 - back);
    most = std::max(most, T / 2 / (1 - std::cos(wT)) * ((1.0 - back) * H).real());
  }
  return most;
}

TEST(HoldBounds, AreThoseOfTheConditionOverFrequency) {
  for (const double K : {100.0, 1000.0, 20000.0}) {
    for (const double B : {0.0, 0.3, 5.0}) {
      for (const double lead : {-1.0, -0.3, 0.0, 0.5, 1.0}) {
        const double exact = requiredDamping(K, B, kHoldTick, lead),
                     scanned = requiredByFrequency(K, B, kHoldTick, lead);
        EXPECT_NEAR(exact, scanned, 1e-6 * exact) << K << " " << B << " " << lead;  // the scan stops short of w = 0
      }
    }
  }
}

TEST(HoldBounds, PublishedOne) {
  EXPECT_DOUBLE_EQ(requiredDamping(1000, 0.2, kHoldTick), 0.5 * 1000 * kHoldTick + 0.2);
  EXPECT_DOUBLE_EQ(passiveStiffness({0.1, 0.7, 0}, 0.2, kHoldTick), 2 * (0.7 - 0.2) / kHoldTick);
  EXPECT_EQ(passiveStiffness({0.1, 0.7, 0}, 0.8, kHoldTick), 0);
}

TEST(HoldBounds, PassiveStiffnessNeedsAllOfTheDamping) {
  for (const double B : {0.0, 0.1}) {
    for (const double lead : {-1.0, -0.4, 0.0, 0.4, 1.0}) {
      const ArmPort arm{0.05, 0.6, 0};
      const double K = passiveStiffness(arm, B, kHoldTick, lead);
      EXPECT_NEAR(requiredDamping(K, B, kHoldTick, lead), arm.damping, 1e-12) << lead;
    }
  }
}

// m x'' = -b x' against a held spring: with b = 0 any K is unstable, and passive implies stable.
TEST(HoldBounds, StableIsWiderThanPassiveAndNothingWithoutDamping) {
  EXPECT_EQ(stableStiffness({0.1, 0, 0}, 0, kHoldTick), 0);
  for (const double mass : {0.03, 0.1, 0.5}) {
    for (const double b : {0.2, 1.0, 3.0}) {
      const ArmPort arm{mass, b, 0};
      EXPECT_GE(stableStiffness(arm, 0, kHoldTick), 0.998 * passiveStiffness(arm, 0, kHoldTick)) << mass << " " << b;
    }
  }
}

// The loop, run: it grows on one side of the stable stiffness and decays on the other.
TEST(HoldBounds, StableStiffnessIsWhereTheLoopBeginsToGrow) {
  const ArmPort arm{0.08, 0.5, 300};
  const double K = stableStiffness(arm, 0.3, kHoldTick);
  for (const double share : {0.98, 1.02}) {
    double x = 1e-3, v = 0, last = 1e-3, largest_early = 0, largest_late = 0;
    for (int k = 0; k < 20000; ++k) {
      const double f = share * K * x + 0.3 * (x - last) / kHoldTick;
      last = x;
      constexpr int kParts = 200;
      for (int i = 0; i < kParts; ++i) {
        v += kHoldTick / kParts * (-arm.damping * v - arm.hand_stiffness * x - f) / arm.mass;
        x += kHoldTick / kParts * v;
      }
      if (k < 1000) largest_early = std::max(largest_early, std::abs(x));
      if (k >= 19000) largest_late = std::max(largest_late, std::abs(x));
      if (!(std::abs(x) < 1)) break;
    }
    EXPECT_EQ(largest_late > largest_early || !(std::abs(x) < 1), share > 1) << share;
  }
}

}  // namespace
}  // namespace pincer::grasp
