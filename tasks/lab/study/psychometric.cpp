#include "pincer/tasks/lab/study/psychometric.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <numbers>

#include "pincer/contact/elementary.h"
#include "pincer/contact/functions/invariants.h"

namespace pincer::tasks {
namespace {

constexpr double kLapses[] = {0, 0.01, 0.02, 0.03, 0.04, 0.05, 0.06};  // lambda [-]: the fit's grid, psychometric.h
constexpr int kSections = 30;  // of golden sections: 0.618^30 = 5e-7 of the range

double sigmoidAt(Sigmoid shape, double z) {
  return shape == Sigmoid::kLogistic ? 1 / (1 + math::exp(-z)) : normalCdf(z);
}
double sigmoidQuantile(Sigmoid shape, double p) {
  return shape == Sigmoid::kLogistic ? math::log(p / (1 - p)) : normalQuantile(p);
}

struct Peak {
  double at = 0, value = 0;
};

// The maximum of a function with one peak in [low, high].
template <class Function>
Peak goldenSection(double low, double high, const Function& f) {
  constexpr double kRatio = std::numbers::phi - 1;  // golden section: each step keeps so much of the interval
  double a = high - kRatio * (high - low), b = low + kRatio * (high - low);
  double fa = f(a), fb = f(b);
  for (int i = 0; i < kSections; ++i) {
    if (fa > fb) {
      high = b, b = a, fb = fa;
      fa = f(a = high - kRatio * (high - low));
    } else {
      low = a, a = b, fa = fb;
      fb = f(b = low + kRatio * (high - low));
    }
  }
  return fa > fb ? Peak{a, fa} : Peak{b, fb};
}

// The likelihood of the counts, as a function of the threshold x_p.
class ThresholdLikelihood {
 public:
  ThresholdLikelihood(std::span<const LevelCount> counts, Sigmoid shape, double gamma, double p)
      : counts_(counts), shape_(shape), gamma_(gamma), p_(p) {
    const auto [least, most] =
        std::minmax_element(counts.begin(), counts.end(), [](auto& a, auto& b) { return a.level < b.level; });
    low_ = least->level, range_ = most->level - least->level;
    PINCER_ASSERT(range_ > 0);  // two levels at least
  }
  double low() const { return low_ - range_; }
  double high() const { return low_ + 2 * range_; }

  // Maximised over spread and lapses.
  double at(double threshold) const { return best(threshold).log_likelihood; }

  PsychometricFit best(double threshold) const {
    PsychometricFit fit;
    fit.log_likelihood = -std::numeric_limits<double>::infinity();
    for (const double lambda : kLapses) {
      const double z = sigmoidQuantile(shape_, (p_ - gamma_) / (1 - gamma_ - lambda));
      const Peak peak = goldenSection(math::log(1e-3 * range_), math::log(10 * range_), [&](double ln_beta) {
        return logLikelihood(function(threshold, z, math::exp(ln_beta), lambda));
      });
      if (peak.value > fit.log_likelihood)
        fit = {function(threshold, z, math::exp(peak.at), lambda), threshold, {}, peak.value};
    }
    return fit;
  }

 private:
  PsychometricFunction function(double threshold, double z, double beta, double lambda) const {
    return {shape_, threshold - z * beta, beta, gamma_, lambda};
  }
  double logLikelihood(const PsychometricFunction& f) const {
    constexpr double kLeast = 1e-12;  // a probability of exactly 0 or 1 would make one answer decide all
    double sum = 0;
    for (const LevelCount& c : counts_) {
      const double p = std::clamp(f.at(c.level), kLeast, 1 - kLeast);
      sum += c.right * math::log(p) + (c.trials - c.right) * math::log1p(-p);
    }
    return sum;
  }

  std::span<const LevelCount> counts_;
  Sigmoid shape_;
  double gamma_, p_, low_ = 0, range_ = 1;
};

// Where the profile crosses `limit` between `inside` (above it) and `outside`; infinite if it stays above.
double crossing(const ThresholdLikelihood& profile, double inside, double outside, double limit) {
  if (profile.at(outside) >= limit) return std::copysign(std::numeric_limits<double>::infinity(), outside - inside);
  for (int i = 0; i < 20; ++i) {  // to 1e-6 of the range
    const double middle = 0.5 * (inside + outside);
    (profile.at(middle) >= limit ? inside : outside) = middle;
  }
  return 0.5 * (inside + outside);
}

}  // namespace

double normalCdf(double z) { return 0.5 * math::erfc(-z * std::numbers::sqrt2 / 2); }

double normalQuantile(double p) {
  PINCER_ASSERT(0 < p && p < 1);
  double low = -40, high = 40;
  for (int i = 0; i < 60; ++i) {  // 80 / 2^60 is below round-off
    const double middle = 0.5 * (low + high);
    (normalCdf(middle) < p ? low : high) = middle;
  }
  return 0.5 * (low + high);
}

double PsychometricFunction::at(double x) const {
  PINCER_ASSERT(beta > 0);
  return gamma + (1 - gamma - lambda) * sigmoidAt(shape, (x - alpha) / beta);
}

double PsychometricFunction::levelOf(double p) const {
  return alpha + beta * sigmoidQuantile(shape, (p - gamma) / (1 - gamma - lambda));
}

PsychometricFit fitPsychometric(std::span<const LevelCount> counts, Sigmoid shape, double gamma, double p,
                                double confidence) {
  PINCER_ASSERT(!counts.empty());
  PINCER_ASSERT(gamma < p && p < 0.94);  // with the most lapses
  PINCER_ASSERT(0 < confidence && confidence < 1);
  const ThresholdLikelihood profile(counts, shape, gamma, p);
  const Peak peak =
      goldenSection(profile.low(), profile.high(), [&](double threshold) { return profile.at(threshold); });
  PsychometricFit fit = profile.best(peak.at);
  const double z = normalQuantile(0.5 + 0.5 * confidence);
  // a chi-squared variable with 1 degree of freedom is a squared normal one
  const double limit = fit.log_likelihood - 0.5 * z * z;
  fit.interval = {crossing(profile, peak.at, profile.low(), limit), crossing(profile, peak.at, profile.high(), limit)};
  return fit;
}

}  // namespace pincer::tasks
