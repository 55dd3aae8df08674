// psychometric: how often an answer is right, as a function of the level, and fitting it to constant stimuli.
//
//   P(x) = gamma + (1 - gamma - lambda) F((x - alpha) / beta)
//   F(z) = 1 / (1 + e^-z)  or  the normal distribution function
//
//   x      level;  alpha  where F = 1/2;  beta > 0  spread, both in the level's unit
//   gamma  guess rate: 1/2 with two intervals;  lambda  lapse rate
// Fit: maximum likelihood of binomial counts over alpha, beta and lambda in {0, 0.01 .. 0.06}; lapses left out bias the
// slope (F. A. Wichmann, N. J. Hill, "The psychometric function: I", Perception & Psychophysics 63(8), 2001,
// 1293-1313). Interval of a threshold x_p, P(x_p) = p: all values at which the likelihood, maximised over the rest,
// stays within exp(-q/2) of the best, q the chi-squared quantile with 1 degree of freedom (profile likelihood; S. S.
// Wilks, Ann. Math. Stat. 9(1), 1938, 60-62). Departure: by nested golden sections over x_p and ln beta, which need no
// start and no derivative: slow beside Newton, but never lost.
#pragma once
#include <span>

namespace pincer::tasks {

enum class Sigmoid { kLogistic, kNormal };

double normalCdf(double z);
double normalQuantile(double p);  // 0 < p < 1

struct PsychometricFunction {
  Sigmoid shape = Sigmoid::kNormal;
  double alpha = 0, beta = 1, gamma = 0.5, lambda = 0;

  double at(double x) const;       // P(x)
  double levelOf(double p) const;  // x_p; gamma < p < 1 - lambda
};

// Answers at one level.
struct LevelCount {
  double level = 0;
  int right = 0, trials = 0;
};

struct ThresholdInterval {
  double low = 0, high = 0;  // infinite where the data don't bound it
};

struct PsychometricFit {
  PsychometricFunction function;
  double threshold = 0;  // x_p
  ThresholdInterval interval;
  double log_likelihood = 0;
};

// `counts`: at least two different levels with trials. `p`: of the threshold, gamma < p <
// 0.94; `confidence` of the interval in (0, 1).
PsychometricFit fitPsychometric(std::span<const LevelCount> counts, Sigmoid shape, double gamma, double p,
                                double confidence = 0.95);

}  // namespace pincer::tasks
