// weighing: the two steps that every belief over hypotheses shares.
//
//   weigh     w_k <- w_k exp(l_k) / sum,  l_k the log likelihood of what was observed
//             returns the share 1 / (n sum w_k^2) of hypotheses that count
//   resample  n copies, hypothesis k about n w_k times, by one draw (systematic)
//
// Sources: N. J. Gordon, D. J. Salmond, A. F. M. Smith, "Novel approach to nonlinear/non-Gaussian Bayesian state
// estimation", IEE Proc. F 140(2), 1993, 107-113; systematic resampling: G. Kitagawa, J. Comput. Graph. Stat. 5(1),
// 1996. A hypothesis has a member `weight`.
#pragma once
#include <algorithm>
#include <cmath>
#include <vector>

#include "pincer/tasks/lab/participants/random.h"

namespace pincer::tasks {

constexpr double kEnoughShare = 0.5;  // fewer hypotheses that count: resample

template <class Hypothesis>
double weigh(std::vector<Hypothesis>& hypotheses, const std::vector<double>& logs) {
  const double best = *std::max_element(logs.begin(), logs.end());
  double sum = 0, squares = 0;
  for (std::size_t k = 0; k < hypotheses.size(); ++k) sum += hypotheses[k].weight *= math::exp(logs[k] - best);
  for (Hypothesis& h : hypotheses) {
    h.weight /= sum;
    squares += h.weight * h.weight;
  }
  return 1 / (squares * static_cast<double>(hypotheses.size()));
}

// `vary(copy)` makes copies differ. `copies` is as long as `hypotheses`.
template <class Hypothesis, class Vary>
void resample(std::vector<Hypothesis>& hypotheses, std::vector<Hypothesis>& copies, Random& random, Vary vary) {
  const double step = 1.0 / static_cast<double>(hypotheses.size());
  double at = step * random.uniform(), passed = hypotheses[0].weight;
  std::size_t source = 0;
  for (Hypothesis& copy : copies) {
    while (at > passed && source + 1 < hypotheses.size()) passed += hypotheses[++source].weight;
    copy = hypotheses[source];
    vary(copy);
    copy.weight = step;
    at += step;
  }
  hypotheses.swap(copies);
}

}  // namespace pincer::tasks
