// The functions of analysis where they have no choice: special values,
// symmetries, bounds, whole powers; and their bits.
#include <gtest/gtest.h>

#include <cmath>
#include <numbers>
#include <random>

#include "pincer/contact/elementary.h"
#include "pincer/tests/support/constants.h"

namespace pincer {
namespace {

constexpr double kInf = std::numeric_limits<double>::infinity();
constexpr double kSmallestNumber = 5e-324, kLargestNumber = std::numeric_limits<double>::max();

std::uint64_t bits(double x) { return std::bit_cast<std::uint64_t>(x); }

void expectSame(double got, double want, const char* what) {
  EXPECT_TRUE(bits(got) == bits(want) || (std::isnan(got) && std::isnan(want)))
      << what << " is " << got << ", not " << want;
}
#define EXPECT_BITS(call, want) expectSame(math::call, want, #call)

TEST(FunctionsSpecialValues, OfAngles) {
  for (double (*f)(double) : {math::sin, math::cos, math::tan}) {
    for (const double x : {kInf, -kInf, tests::kNan}) EXPECT_TRUE(std::isnan(f(x)));
  }
  for (const double x : {kInf, -kInf, tests::kNan})
    EXPECT_TRUE(std::isnan(math::sinCos(x).sin) && std::isnan(math::sinCos(x).cos));
  for (const double x : {0.0, -0.0, kSmallestNumber, -kSmallestNumber, 1e-310, 1e-20}) {
    EXPECT_BITS(sin(x), x);
    EXPECT_BITS(tan(x), x);
    EXPECT_BITS(cos(x), 1);
    EXPECT_BITS(sinCos(x).sin, x);
  }
}

TEST(FunctionsSpecialValues, OfArcs) {
  for (const double x : {0.0, -0.0, kSmallestNumber, -1e-310}) {
    EXPECT_BITS(asin(x), x);
    EXPECT_BITS(atan(x), x);
    EXPECT_BITS(acos(x), tests::kPi / 2);
  }
  EXPECT_BITS(asin(1), tests::kPi / 2);
  EXPECT_BITS(asin(-1), -tests::kPi / 2);
  EXPECT_BITS(acos(1), 0);
  EXPECT_BITS(acos(-1), tests::kPi);
  for (const double x : {1 + 1e-15, -2.0, kInf, -kInf, tests::kNan})
    EXPECT_TRUE(std::isnan(math::asin(x)) && std::isnan(math::acos(x)));
  EXPECT_BITS(atan(kInf), tests::kPi / 2);
  EXPECT_BITS(atan(-kInf), -tests::kPi / 2);
  EXPECT_BITS(atan(kLargestNumber), tests::kPi / 2);
  EXPECT_BITS(atan(tests::kNan), tests::kNan);
}

TEST(FunctionsSpecialValues, OfArcsOfTwo) {
  EXPECT_BITS(atan2(0, 0), 0);
  EXPECT_BITS(atan2(-0.0, 0), -0.0);
  EXPECT_BITS(atan2(0, -0.0), tests::kPi);
  EXPECT_BITS(atan2(-0.0, -0.0), -tests::kPi);
  EXPECT_BITS(atan2(0, 3), 0);
  EXPECT_BITS(atan2(-0.0, 3), -0.0);
  EXPECT_BITS(atan2(0, -3), tests::kPi);
  EXPECT_BITS(atan2(-0.0, -3), -tests::kPi);
  EXPECT_BITS(atan2(3, 0), tests::kPi / 2);
  EXPECT_BITS(atan2(-3, -0.0), -tests::kPi / 2);
  EXPECT_BITS(atan2(3, kInf), 0);
  EXPECT_BITS(atan2(-3, kInf), -0.0);
  EXPECT_BITS(atan2(3, -kInf), tests::kPi);
  EXPECT_BITS(atan2(-3, -kInf), -tests::kPi);
  EXPECT_BITS(atan2(kInf, 3), tests::kPi / 2);
  EXPECT_BITS(atan2(-kInf, -kInf), -3 * tests::kPi / 4);
  EXPECT_BITS(atan2(kInf, kInf), tests::kPi / 4);
  EXPECT_BITS(atan2(tests::kNan, 1), tests::kNan);
  EXPECT_BITS(atan2(1, tests::kNan), tests::kNan);
  EXPECT_BITS(atan2(kSmallestNumber, kLargestNumber), 0);
  EXPECT_BITS(atan2(kSmallestNumber, -kLargestNumber), tests::kPi);
  EXPECT_BITS(atan2(kLargestNumber, kSmallestNumber), tests::kPi / 2);
  EXPECT_BITS(atan2(kSmallestNumber, kSmallestNumber), tests::kPi / 4);
  EXPECT_BITS(atan2(kLargestNumber, kLargestNumber), tests::kPi / 4);
}

TEST(FunctionsSpecialValues, OfExponentials) {
  for (double (*f)(double) : {math::exp, math::exp2}) {
    expectSame(f(0), 1, "of 0");
    expectSame(f(-0.0), 1, "of -0");
    expectSame(f(kInf), kInf, "of infinity");
    expectSame(f(-kInf), 0, "of -infinity");
    expectSame(f(1e300), kInf, "of 1e300");
    expectSame(f(-1e300), 0, "of -1e300");
    expectSame(f(tests::kNan), tests::kNan, "of no number");
  }
  EXPECT_BITS(exp(709.782712893384), 0x1.fffffffffff2ap+1023);
  EXPECT_BITS(exp(709.7827128933841), kInf);
  EXPECT_BITS(exp(-745.1332191019411), kSmallestNumber);
  EXPECT_BITS(exp(-745.1332191019413), 0);
  for (int n = -1074; n < 1024; ++n) EXPECT_BITS(exp2(n), std::ldexp(1, n));
  EXPECT_BITS(exp2(1024), kInf);
  EXPECT_BITS(exp2(-1075.5), 0);
  for (const double x : {0.0, -0.0, kSmallestNumber, -kSmallestNumber, 1e-20}) EXPECT_BITS(expm1(x), x);
  EXPECT_BITS(expm1(kInf), kInf);
  EXPECT_BITS(expm1(1e300), kInf);
  EXPECT_BITS(expm1(-kInf), -1);
  EXPECT_BITS(expm1(-1e300), -1);
  EXPECT_BITS(expm1(tests::kNan), tests::kNan);
}

TEST(FunctionsSpecialValues, OfLogarithms) {
  for (double (*f)(double) : {math::log, math::log2, math::log10}) {
    expectSame(f(1), 0, "of 1");
    expectSame(f(0), -kInf, "of 0");
    expectSame(f(-0.0), -kInf, "of -0");
    expectSame(f(-1), tests::kNan, "of -1");
    expectSame(f(-kInf), tests::kNan, "of -infinity");
    expectSame(f(kInf), kInf, "of infinity");
    expectSame(f(tests::kNan), tests::kNan, "of no number");
  }
  for (int n = -1074; n < 1024; ++n) EXPECT_BITS(log2(std::ldexp(1, n)), n);
  for (int n = 0; n <= 22; ++n) EXPECT_BITS(log10(std::strtod(("1e" + std::to_string(n)).c_str(), nullptr)), n);
  for (const double x : {0.0, -0.0, kSmallestNumber, -kSmallestNumber, 1e-20}) EXPECT_BITS(log1p(x), x);
  EXPECT_BITS(log1p(-1), -kInf);
  EXPECT_BITS(log1p(-1.1), tests::kNan);
  EXPECT_BITS(log1p(kInf), kInf);
  EXPECT_BITS(log1p(tests::kNan), tests::kNan);
}

// C17, F.10.4.4.
TEST(FunctionsSpecialValues, OfPowers) {
  for (const double x : {0.0, -0.0, 2.0, -2.0, kInf, -kInf, tests::kNan}) {
    EXPECT_BITS(pow(x, 0), 1);
    EXPECT_BITS(pow(x, -0.0), 1);
    EXPECT_BITS(pow(1, x), 1);
  }
  for (const double y : {1.0, 3.0, 4503599627370497.0}) {
    EXPECT_BITS(pow(0, y), 0);
    EXPECT_BITS(pow(-0.0, y), -0.0);
    EXPECT_BITS(pow(0, -y), kInf);
    EXPECT_BITS(pow(-0.0, -y), -kInf);
    EXPECT_BITS(pow(-kInf, y), -kInf);
    EXPECT_BITS(pow(-kInf, -y), -0.0);
    EXPECT_BITS(pow(-1, y), -1);
  }
  for (const double y : {2.0, 0.5, 2.5, 1e300}) {
    EXPECT_BITS(pow(-0.0, y), 0);
    EXPECT_BITS(pow(-0.0, -y), kInf);
    EXPECT_BITS(pow(-kInf, y), kInf);
    EXPECT_BITS(pow(-kInf, -y), 0);
    EXPECT_BITS(pow(kInf, y), kInf);
    EXPECT_BITS(pow(kInf, -y), 0);
  }
  for (const double y : {kInf, -kInf}) {
    EXPECT_BITS(pow(-1, y), 1);
    EXPECT_BITS(pow(2, y), y > 0 ? kInf : 0);
    EXPECT_BITS(pow(-0.5, y), y > 0 ? 0 : kInf);
    EXPECT_BITS(pow(0, y), y > 0 ? 0 : kInf);
  }
  EXPECT_BITS(pow(-2, 0.5), tests::kNan);
  EXPECT_BITS(pow(-2, 3), -8);
  EXPECT_BITS(pow(-2, -2), 0.25);
  EXPECT_BITS(pow(-kLargestNumber, 3), -kInf);
  EXPECT_BITS(pow(2, tests::kNan), tests::kNan);
  EXPECT_BITS(pow(tests::kNan, 2), tests::kNan);
  EXPECT_BITS(pow(1 + 1e-15, 1e300), kInf);
  EXPECT_BITS(pow(1 - 1e-15, 1e300), 0);
  EXPECT_BITS(pow(2, 1e-300), 1);
}

TEST(FunctionsSpecialValues, OfRootsAndErrors) {
  for (const double y : {0.0, 1.0, kInf, tests::kNan}) {
    EXPECT_BITS(hypot(kInf, y), kInf);
    EXPECT_BITS(hypot(y, -kInf), kInf);
  }
  EXPECT_BITS(hypot(tests::kNan, 1), tests::kNan);
  EXPECT_BITS(hypot(-3, 4), 5);
  EXPECT_BITS(hypot(0, -0.0), 0);
  EXPECT_BITS(hypot(0, -7), 7);
  EXPECT_BITS(hypot(kSmallestNumber, 0), kSmallestNumber);
  EXPECT_BITS(hypot(3 * kSmallestNumber, 4 * kSmallestNumber), 5 * kSmallestNumber);
  EXPECT_BITS(hypot(kLargestNumber, kLargestNumber), kInf);
  for (const double x : {0.0, -0.0, kInf, -kInf, tests::kNan}) EXPECT_BITS(cbrt(x), x);
  for (int n = -1000; n <= 1000; ++n) EXPECT_BITS(cbrt(1.0 * n * n * n), n == 0 ? 0 : n);
  EXPECT_BITS(erfc(0), 1);
  EXPECT_BITS(erfc(kInf), 0);
  EXPECT_BITS(erfc(-kInf), 2);
  EXPECT_BITS(erfc(tests::kNan), tests::kNan);
}

TEST(FunctionsPowers, OfWholeNumbersAreWhole) {
  for (int base = 2; base <= 30; ++base) {
    double power = 1;
    for (int n = 1; power * base < 0x1p53; ++n) EXPECT_BITS(pow(base, n), power *= base);
  }
}

class Draws {
 public:
  double from(double low, double high) { return low + 0x1p-64 * static_cast<double>(random_()) * (high - low); }
  double ofAnySize() {
    for (;;) {
      const double x = std::bit_cast<double>(random_());
      if (std::isfinite(x)) return x;
    }
  }

 private:
  std::mt19937_64 random_{23};
};

TEST(FunctionsSymmetry, IsExact) {
  Draws draws;
  for (int i = 0; i < 100000; ++i) {
    for (const double x : {draws.from(-10, 10), draws.ofAnySize()}) {
      ASSERT_EQ(bits(math::sin(-x)), bits(-math::sin(x))) << x;
      ASSERT_EQ(bits(math::cos(-x)), bits(math::cos(x))) << x;
      ASSERT_EQ(bits(math::tan(-x)), bits(-math::tan(x))) << x;
      ASSERT_EQ(bits(math::sinCos(x).sin), bits(math::sin(x))) << x;
      ASSERT_EQ(bits(math::sinCos(x).cos), bits(math::cos(x))) << x;
      ASSERT_EQ(bits(math::atan(-x)), bits(-math::atan(x))) << x;
      ASSERT_EQ(bits(math::cbrt(-x)), bits(-math::cbrt(x))) << x;
      const double y = i % 2 ? draws.from(-10, 10) : draws.ofAnySize();
      ASSERT_EQ(bits(math::hypot(x, y)), bits(math::hypot(-y, x))) << x << " " << y;
      ASSERT_EQ(bits(math::atan2(-y, x)), bits(-math::atan2(y, x))) << x << " " << y;
    }
    const double sine = draws.from(-1, 1);
    ASSERT_EQ(bits(math::asin(-sine)), bits(-math::asin(sine))) << sine;
  }
}

// No sine beyond 1 makes a square root of a negative number, no arc sine leaves its half turn.
TEST(FunctionsBounds, AreKept) {
  Draws draws;
  for (int i = 0; i < 200000; ++i) {
    const double near_peak = tests::kPi / 2 * (2 * (i % 200) - 199) * (1 + 1e-9 * draws.from(-1, 1));
    for (const double x :
         {draws.from(-10, 10), draws.ofAnySize(), near_peak, near_peak + tests::kPi / 2, 1e-8 * draws.from(-1, 1)}) {
      const auto [s, c] = math::sinCos(x);
      ASSERT_LE(std::abs(s), 1) << x;
      ASSERT_LE(std::abs(c), 1) << x;
      ASSERT_LE(std::abs(math::atan(x)), tests::kPi / 2) << x;
      ASSERT_LE(std::abs(math::atan2(x, draws.ofAnySize())), tests::kPi) << x;
      const double complement = math::erfc(x);
      ASSERT_TRUE(complement >= 0 && complement <= 2) << x;
    }
    const double sine = i % 2 ? draws.from(-1, 1) : 1 - draws.from(0, 1e-14);
    ASSERT_LE(std::abs(math::asin(sine)), tests::kPi / 2) << sine;
    ASSERT_TRUE(math::acos(sine) >= 0 && math::acos(sine) <= tests::kPi) << sine;
  }
}

// Neighbours on the two sides of every seam: of table cells, of methods.
TEST(FunctionsMonotony, HoldsAcrossSeams) {
  const auto expectRising = [](double (*f)(double), double seam, const char* name) {
    double x = seam;
    for (int i = 0; i < 50; ++i) x = std::nextafter(x, -kInf);
    for (double last = f(x); x < seam + 1e-13 * std::abs(seam); last = f(x)) {
      x = std::nextafter(x, kInf);
      ASSERT_GE(f(x), last) << name << " at " << x;
    }
  };
  for (int j = -200; j <= 200; ++j) {
    expectRising(math::exp, (j + 0.5) * std::numbers::ln2 / 64, "exp");
    if (j > 0) expectRising(math::log, (j + 0.5) / 128, "log");
    if (j > 0) expectRising(math::log, (j + 0.5) / 64, "log");
    expectRising(math::atan, (j + 0.5) / 32, "atan");
  }
  for (const double seam : {-0.125, 0.125}) expectRising(math::expm1, seam, "expm1");
  for (const double seam : {-0x1p-8, 0x1p-8}) expectRising(math::log1p, seam, "log1p");
  for (const double seam : {-1.0, 1.0}) expectRising(math::atan, seam, "atan");
  for (const double seam : {-tests::kPi / 4, tests::kPi / 4}) expectRising(math::sin, seam, "sin");
}

// A hash of every bit of every function. It may change only with the functions themselves,
// never with compiler, processor or library.
TEST(FunctionsBits, AreTheSameEverywhere) {
  Draws draws;
  std::uint64_t hash = 14695981039346656037u;  // FNV-1a
  const auto add = [&](double value) {
    std::uint64_t b = std::isnan(value) ? 0x7ff8000000000000 : bits(value);
    for (int i = 0; i < 8; ++i, b >>= 8) hash = (hash ^ (b & 0xff)) * 1099511628211u;
  };
  for (int i = 0; i < 20000; ++i) {
    const double x = i % 3 ? draws.from(-30, 30) : draws.ofAnySize(), y = i % 3 ? draws.from(-3, 3) : draws.ofAnySize();
    for (double (*f)(double) : {math::sin, math::cos, math::tan, math::atan, math::exp, math::exp2, math::expm1,
                                math::log, math::log2, math::log10, math::log1p, math::cbrt, math::erfc}) {
      add(f(x));
    }
    for (double (*f)(double, double) : {math::atan2, math::pow, math::hypot}) add(f(x, y)), add(f(std::abs(x), y));
    for (double (*f)(double) : {math::asin, math::acos}) add(f(draws.from(-1, 1)));
  }
  EXPECT_EQ(hash, 7296434937720878582u);
}

}  // namespace
}  // namespace pincer
