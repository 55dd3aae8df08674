// statistics: the mean of a few numbers and how well it is known.
//
//   mean +- t s / sqrt(n),   s^2 = sum (x - mean)^2 / (n - 1)
//   P(|T| < t) = 0.95 for Student's T with n - 1 degrees of freedom
//
// Source of the distribution: M. Abramowitz, I. A. Stegun, Handbook of Mathematical Functions, 1964, equations 26.7.3
// (odd) and 26.7.4 (even degrees of freedom): finite sums, exact. t follows by bisection, to round-off.
#pragma once
#include <cstdint>
#include <vector>

namespace pincer::tasks {

struct Estimate {
  int n = 0;
  double mean = 0;        // NaN if n = 0
  double half_width = 0;  // of the 95 % confidence interval; NaN if n < 2
};

// P(|T| < t), t >= 0, `dof` >= 1.
double studentTwoSided(double t, int dof);

// The t with P(|T| < t) = `probability` in (0, 1).
double studentQuantile(double probability, int dof);

struct Interval {
  double low = 0, high = 0;
};

// The values that the mean of a few numbers lies between, 95 %, by what is averaged; both ends the mean if n < 2.
//   kAny       differences, signed errors: mean +- h
//   kPositive  counts, times, thresholds: Student's t for the mean's logarithm (delta
//              method), mean exp(+-h / mean): never below zero
//   kShare     of 1, and kPercent of 100: likewise for the logit, never below none nor above all
enum class Averaged : std::uint8_t { kAny, kPositive, kShare, kPercent };
Interval intervalOf(const Estimate& estimate, Averaged averaged);

Estimate estimateMean(const std::vector<double>& values);

// The value below which a share p of `values` lies (nearest rank); NaN if there is none. 0 <= p <= 1.
double percentile(std::vector<double> values, double p);

}  // namespace pincer::tasks
