#include "pincer/tasks/lab/report/paired_test.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <numeric>

#include "pincer/contact/functions/invariants.h"

namespace pincer::tasks {
namespace {

constexpr double kEqualBut = 1e-12;  // of differences that are equal but for it

// Ranks of the sizes, doubled so that the mean rank of ties is whole.
std::vector<int> doubledRanks(const std::vector<double>& values) {
  std::vector<std::size_t> order(values.size());
  std::iota(order.begin(), order.end(), 0u);
  std::sort(order.begin(), order.end(),
            [&](std::size_t i, std::size_t j) { return std::abs(values[i]) < std::abs(values[j]); });
  std::vector<int> ranks(values.size());
  for (std::size_t first = 0; first < order.size();) {
    std::size_t last = first;
    while (last + 1 < order.size() && std::abs(values[order[last + 1]]) == std::abs(values[order[first]])) ++last;
    for (std::size_t k = first; k <= last; ++k) ranks[order[k]] = static_cast<int>(first + last + 2);
    first = last + 1;
  }
  return ranks;
}

}  // namespace

double wilcoxonSignedRank(const std::vector<double>& differences) {
  std::vector<double> d;
  std::copy_if(differences.begin(), differences.end(), std::back_inserter(d), [](double x) { return x != 0; });
  if (d.empty()) return 1;
  const std::vector<int> ranks = doubledRanks(d);
  const int total = std::accumulate(ranks.begin(), ranks.end(), 0);
  std::vector<double> share(static_cast<std::size_t>(total) + 1, 0.0);  // of all signs, with this sum
  share[0] = 1;
  for (const int rank : ranks) {
    for (int sum = total; sum >= 0; --sum) {
      const double before = sum >= rank ? share[static_cast<std::size_t>(sum - rank)] : 0;
      share[static_cast<std::size_t>(sum)] = 0.5 * (share[static_cast<std::size_t>(sum)] + before);
    }
  }
  int positive = 0;
  for (std::size_t i = 0; i < d.size(); ++i) positive += d[i] > 0 ? ranks[i] : 0;
  const int smaller = std::min(positive, total - positive);
  double tail = 0;
  for (int sum = 0; sum <= smaller; ++sum) tail += share[static_cast<std::size_t>(sum)];
  return std::min(1.0, 2 * tail);
}

PairedTest comparePairs(const std::vector<double>& a, const std::vector<double>& b) {
  std::vector<double> d;
  for (std::size_t i = 0; i < std::min(a.size(), b.size()); ++i) {
    if (std::isfinite(a[i]) && std::isfinite(b[i])) d.push_back(b[i] - a[i]);
  }
  PairedTest test;
  test.n = static_cast<int>(d.size());
  test.lower = static_cast<int>(std::count_if(d.begin(), d.end(), [](double x) { return x < 0; }));
  test.higher = static_cast<int>(std::count_if(d.begin(), d.end(), [](double x) { return x > 0; }));
  test.difference = estimateMean(d);
  test.effect = std::numeric_limits<double>::quiet_NaN();
  if (test.n < 2) return test;
  double squares = 0;
  for (const double x : d) squares += (x - test.difference.mean) * (x - test.difference.mean);
  const double sd = std::sqrt(squares / (test.n - 1));
  test.p_wilcoxon = wilcoxonSignedRank(d);
  if (!(sd > kEqualBut * std::abs(test.difference.mean))) {
    // t is infinite: it knows nothing of their spread
    if (test.difference.mean != 0) test.p_t = std::numeric_limits<double>::quiet_NaN();
    return test;
  }
  test.effect = test.difference.mean / sd;
  test.p_t = 1 - studentTwoSided(std::abs(test.effect) * std::sqrt(test.n), test.n - 1);
  return test;
}

std::vector<double> holmAdjusted(const std::vector<double>& p) {
  std::vector<std::size_t> order(p.size());
  std::iota(order.begin(), order.end(), 0u);
  std::erase_if(order, [&](std::size_t k) { return p[k] != p[k]; });
  std::sort(order.begin(), order.end(), [&](std::size_t a, std::size_t b) { return p[a] < p[b]; });
  std::vector<double> adjusted(p.size(), std::nan(""));
  double largest = 0;
  for (std::size_t rank = 0; rank < order.size(); ++rank) {
    largest = std::max(largest, std::min(1.0, static_cast<double>(order.size() - rank) * p[order[rank]]));
    adjusted[order[rank]] = largest;
  }
  return adjusted;
}

std::pair<double, double> wilsonInterval(int k, int n) {
  PINCER_ASSERT(0 <= k && k <= n);
  if (n == 0) return {0, 1};
  constexpr double z = 1.959963984540054;
  const double p = static_cast<double>(k) / n, zz = z * z / n;
  const double middle = (p + 0.5 * zz) / (1 + zz), half = z / (1 + zz) * std::sqrt(p * (1 - p) / n + 0.25 * zz / n);
  return {std::max(0.0, middle - half), std::min(1.0, middle + half)};
}

}  // namespace pincer::tasks
