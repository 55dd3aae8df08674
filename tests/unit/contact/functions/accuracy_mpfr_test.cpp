// The functions of analysis against MPFR, which rounds any of them correctly at any precision.
#include <fmt/format.h>
#include <gtest/gtest.h>
#include <mpfr.h>

#include <cmath>
#include <random>

#include "pincer/contact/elementary.h"
#include "pincer/contact/functions/double_double.h"

namespace pincer {
namespace {

// binary; arguments are doubles, so that no result of ours lies closer to the middle of two
constexpr mpfr_prec_t kDigits = 200;

class Exact {
 public:
  explicit Exact(double x = 0) {
    mpfr_init2(x_, kDigits);
    mpfr_set_d(x_, x, MPFR_RNDN);
  }
  Exact(const Exact&) = delete;
  Exact& operator=(const Exact&) = delete;
  ~Exact() { mpfr_clear(x_); }
  mpfr_ptr get() { return x_; }

  // How far `value` is off, in units of the last place of a double of this size.
  double ulpsTo(double value) {
    const long exponent = mpfr_zero_p(x_) ? -2000 : mpfr_get_exp(x_) - 53;
    mpfr_sub_d(x_, x_, value, MPFR_RNDN);
    mpfr_mul_2si(x_, x_, -std::max(exponent, -1074L), MPFR_RNDN);
    return std::abs(mpfr_get_d(x_, MPFR_RNDN));
  }
  bool overflows() { return std::isinf(mpfr_get_d(x_, MPFR_RNDN)); }

 private:
  mpfr_t x_;
};

using Oracle = int (*)(mpfr_ptr, mpfr_srcptr, mpfr_rnd_t);
using Oracle2 = int (*)(mpfr_ptr, mpfr_srcptr, mpfr_srcptr, mpfr_rnd_t);

double ulpsOff(double value, Oracle exact, double x) {
  Exact result(x);
  exact(result.get(), result.get(), MPFR_RNDN);
  return result.overflows() ? (std::isinf(value) ? 0 : kDigits) : result.ulpsTo(value);
}

double ulpsOff(double value, Oracle2 exact, double x, double y) {
  Exact result(x), second(y);
  exact(result.get(), result.get(), second.get(), MPFR_RNDN);
  return result.overflows() ? (std::isinf(value) ? 0 : kDigits) : result.ulpsTo(value);
}

struct Arguments {
  double low, high;
  bool by_size = false;  // sizes evenly spread over the exponents
};

double draw(const Arguments& range, std::mt19937_64& random) {
  const double u = 0x1p-64 * static_cast<double>(random());
  if (!range.by_size) return range.low + u * (range.high - range.low);
  return std::exp(std::log(range.low) + u * (std::log(range.high) - std::log(range.low)));
}

struct Function {
  const char* name;
  double (*ours)(double);
  Oracle exact;
  double bound;  // [ulp]
  std::vector<Arguments> ranges;
};

class FunctionsAccuracy : public testing::TestWithParam<Function> {};

TEST_P(FunctionsAccuracy, IsWithinItsBound) {
  const Function& f = GetParam();
  std::mt19937_64 random(20);
  for (const Arguments& range : f.ranges) {
    double worst = 0, at = 0;
    for (int i = 0; i < 5000; ++i) {
      const double x = draw(range, random), off = ulpsOff(f.ours(x), f.exact, x);
      if (!(off <= worst)) worst = off, at = x;
    }
    fmt::print("{} from {:g} to {:g}: {:.3f} ulp\n", f.name, range.low, range.high, worst);
    EXPECT_LE(worst, f.bound) << fmt::format("{}({:a})", f.name, at);
  }
}

constexpr double kLargestArgument = 1.7e308, kSmallestArgument = 5e-324;
const Arguments kAnySize{kSmallestArgument, kLargestArgument, true}, kOneTurn{-M_PI, M_PI}, kSmall{1e-12, 0.8, true};

INSTANTIATE_TEST_SUITE_P(
    All, FunctionsAccuracy,
    testing::Values(
        Function{"sin", math::sin, mpfr_sin, 0.85, {kOneTurn, {-0.79, 0.79}, {-1e6, 1e6}, kSmall, kAnySize}},
        Function{"cos", math::cos, mpfr_cos, 0.85, {kOneTurn, {-0.79, 0.79}, {-1e6, 1e6}, kSmall, kAnySize}},
        Function{"tan", math::tan, mpfr_tan, 0.8, {kOneTurn, {-0.79, 0.79}, {-1e6, 1e6}, kSmall, kAnySize}},
        Function{"asin", math::asin, mpfr_asin, 0.75, {{-1, 1}, {0.999, 1}, {0.2, 0.25}, {kSmallestArgument, 1, true}}},
        Function{
            "acos", math::acos, mpfr_acos, 0.75, {{-1, 1}, {0.999, 1}, {-1, -0.999}, {kSmallestArgument, 1, true}}},
        Function{"atan", math::atan, mpfr_atan, 0.75, {{-5, 5}, {0.15, 0.3}, kAnySize}},
        Function{"exp", math::exp, mpfr_exp, 0.76, {{-10, 10}, {-708, 710}, {-746, -707}, {1e-20, 1, true}}},
        Function{"exp2", math::exp2, mpfr_exp2, 0.76, {{-10, 10}, {-1021, 1025}, {-1076, -1021}, {1e-20, 1, true}}},
        Function{"expm1", math::expm1, mpfr_expm1, 0.8, {{-2, 2}, {-0.2, 0.2}, {-50, 711}, {1e-20, 1, true}}},
        Function{"log", math::log, mpfr_log, 0.55, {{0.5, 2}, {0.99, 1.01}, kAnySize}},
        Function{"log2", math::log2, mpfr_log2, 0.55, {{0.5, 2}, {0.99, 1.01}, kAnySize}},
        Function{"log10", math::log10, mpfr_log10, 0.55, {{0.5, 2}, {0.99, 1.01}, kAnySize}},
        Function{"log1p", math::log1p, mpfr_log1p, 0.55, {{-1, 5}, {-0.01, 0.01}, {1e-20, 1, true}, kAnySize}},
        Function{"cbrt", math::cbrt, mpfr_cbrt, 0.51, {{-8, 8}, kAnySize}},
        Function{"erfc", math::erfc, mpfr_erfc, 2, {{-6.5, 6}, {-0.3, 0.3}, {3.9, 26}, {26, 27.3}, {1e-20, 1, true}}}),
    [](const auto& function) { return std::string(function.param.name); });

struct PairFunction {
  const char* name;
  double (*ours)(double, double);
  Oracle2 exact;
  double bound;  // [ulp]
  std::vector<std::array<Arguments, 2>> ranges;
};

class PairFunctionsAccuracy : public testing::TestWithParam<PairFunction> {};

TEST_P(PairFunctionsAccuracy, IsWithinItsBound) {
  const PairFunction& f = GetParam();
  std::mt19937_64 random(21);
  for (const auto& [first, second] : f.ranges) {
    double worst = 0, at_x = 0, at_y = 0;
    for (int i = 0; i < 5000; ++i) {
      const double x = draw(first, random), y = draw(second, random), off = ulpsOff(f.ours(x, y), f.exact, x, y);
      if (!(off <= worst)) worst = off, at_x = x, at_y = y;
    }
    fmt::print("{} from ({:g}, {:g}) to ({:g}, {:g}): {:.3f} ulp\n", f.name, first.low, second.low, first.high,
               second.high, worst);
    EXPECT_LE(worst, f.bound) << fmt::format("{}({:a}, {:a})", f.name, at_x, at_y);
  }
}

const Arguments kAboutOne{-3, 3};
using Two = std::array<Arguments, 2>;
INSTANTIATE_TEST_SUITE_P(
    All, PairFunctionsAccuracy,
    testing::Values(PairFunction{"atan2",
                                 math::atan2,
                                 mpfr_atan2,
                                 0.75,
                                 {Two{kAboutOne, kAboutOne}, Two{kAnySize, kAnySize}, Two{kAnySize, kAboutOne},
                                  Two{kAboutOne, kAnySize}}},
                    PairFunction{
                        "hypot", math::hypot, mpfr_hypot, 0.51, {Two{kAboutOne, kAboutOne}, Two{kAnySize, kAnySize}}},
                    PairFunction{"pow",
                                 math::pow,
                                 mpfr_pow,
                                 0.55,
                                 {Two{Arguments{0, 5}, kAboutOne}, Two{Arguments{0.99, 1.01}, Arguments{-7e4, 7e4}},
                                  Two{kAnySize, kAboutOne}, Two{kAnySize, kAnySize}}}),
    [](const auto& function) { return std::string(function.param.name); });

// The double closest to a multiple of pi/2: 2^-61 off it (W. Kahan), and its like at
// every size: all digits of 2/pi are asked for.
TEST(FunctionsReduction, KnowsPiFarEnoughForEveryDouble) {
  EXPECT_LE(ulpsOff(math::cos(0x1.6ac5b262ca1ffp+849), mpfr_cos, 0x1.6ac5b262ca1ffp+849), 0.85);
  EXPECT_LT(std::abs(math::cos(0x1.6ac5b262ca1ffp+849)), 1e-18);
  std::mt19937_64 random(22);
  for (int exponent = -5; exponent < 1024; ++exponent) {
    for (int i = 0; i < 20; ++i) {
      const double x = std::ldexp(1 + 0x1p-64 * static_cast<double>(random()), exponent);
      ASSERT_LE(ulpsOff(math::sin(x), mpfr_sin, x), 0.85) << fmt::format("{:a}", x);
      ASSERT_LE(ulpsOff(math::cos(x), mpfr_cos, x), 0.85) << fmt::format("{:a}", x);
    }
  }
}

TEST(FunctionsReduction, StaysAccurateNextToMultiplesOfPi) {
  for (int k = 1; k < 100000; ++k) {
    const double x = k * (M_PI / 2),
                 off = k % 2 ? ulpsOff(math::cos(x), mpfr_cos, x) : ulpsOff(math::sin(x), mpfr_sin, x);
    ASSERT_LE(off, 0.85) << k;
  }
}

// pi/2 and ln 2 to 106 bits, which all else is made of.
TEST(FunctionsConstants, AreRight) {
  const auto off = [](const math::DoubleDouble& ours, const auto& fill, double factor) {
    Exact exact;
    fill(exact.get());
    mpfr_mul_d(exact.get(), exact.get(), factor, MPFR_RNDN);
    mpfr_sub_d(exact.get(), exact.get(), ours.hi, MPFR_RNDN);
    mpfr_sub_d(exact.get(), exact.get(), ours.lo, MPFR_RNDN);
    return std::abs(mpfr_get_d(exact.get(), MPFR_RNDN));
  };
  EXPECT_LT(off(
                math::kHalfPi, [](mpfr_ptr x) { mpfr_const_pi(x, MPFR_RNDN); }, 0.5),
            0x1p-106);
  EXPECT_LT(off(
                math::kLn2, [](mpfr_ptr x) { mpfr_const_log2(x, MPFR_RNDN); }, 1),
            0x1p-107);
}

}  // namespace
}  // namespace pincer
