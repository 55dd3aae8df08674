#include "pincer/tasks/lab/report/group_tests.h"

#include <algorithm>
#include <cmath>

#include "pincer/contact/functions/invariants.h"
#include "pincer/tasks/lab/report/distributions.h"

namespace pincer::tasks {
namespace {

struct Moments {
  double n = 0, mean = 0, squares = 0;  // squares: about the mean
  double variance() const { return squares / (n - 1); }
};

std::vector<double> finiteOnly(const std::vector<double>& values) {
  std::vector<double> finite;
  std::copy_if(values.begin(), values.end(), std::back_inserter(finite), [](double x) { return std::isfinite(x); });
  return finite;
}

Moments momentsOf(const std::vector<double>& values) {
  Moments m;
  for (const double x : values) m.mean += x;
  m.n = static_cast<double>(values.size());
  if (m.n > 0) m.mean /= m.n;
  for (const double x : values) m.squares += (x - m.mean) * (x - m.mean);
  return m;
}

Moments finiteMoments(const std::vector<double>& values) { return momentsOf(finiteOnly(values)); }

void finish(VarianceTest& test, double between_squares, double within_squares) {
  if (!(test.between_dof > 0 && test.within_dof > 0)) return;
  test.within = within_squares / test.within_dof;
  if (!(test.within > 0)) return;
  test.f = between_squares / test.between_dof / test.within;
  test.p = fTail(test.f, test.between_dof, test.within_dof);
}

MeansTest meansTest(double difference, double error, double dof) {
  MeansTest test{difference, 0, dof, 1};
  if (!(error > 0 && dof > 0)) return test;
  test.t = difference / error;
  test.p = studentTail(std::abs(test.t), dof);
  return test;
}

// Of everybody who has a number in every condition.
Groups wholePeople(const Groups& conditions) {
  Groups whole(conditions.size());
  const std::size_t people = conditions.empty() ? 0 : conditions.front().size();
  for (std::size_t person = 0; person < people; ++person) {
    if (!std::all_of(conditions.begin(), conditions.end(), [&](const auto& c) { return std::isfinite(c[person]); }))
      continue;
    for (std::size_t c = 0; c < conditions.size(); ++c) whole[c].push_back(conditions[c][person]);
  }
  return whole;
}

}  // namespace

VarianceTest oneWayVariance(const Groups& groups) {
  VarianceTest test;
  std::vector<double> all;
  double between = 0, within = 0;
  for (const auto& group : groups) {
    for (const double x : finiteOnly(group)) all.push_back(x);
  }
  const Moments total = momentsOf(all);
  for (const auto& group : groups) {
    const Moments m = finiteMoments(group);
    between += m.n * (m.mean - total.mean) * (m.mean - total.mean);
    within += m.squares;
  }
  test.between_dof = static_cast<double>(groups.size()) - 1;
  test.within_dof = total.n - static_cast<double>(groups.size());
  finish(test, between, within);
  return test;
}

VarianceTest repeatedMeasures(const Groups& conditions) {
  VarianceTest test;
  const Groups whole = wholePeople(conditions);
  const auto k = static_cast<double>(whole.size()), n = whole.empty() ? 0.0 : static_cast<double>(whole.front().size());
  test.between_dof = k - 1;
  test.within_dof = (k - 1) * (n - 1);
  if (k < 2 || n < 2) return test;
  std::vector<double> all, of_people, of_conditions;
  for (std::size_t person = 0; person < whole.front().size(); ++person) {
    std::vector<double> own;
    for (const auto& condition : whole) own.push_back(condition[person]);
    all.insert(all.end(), own.begin(), own.end());
    of_people.push_back(momentsOf(own).mean);
  }
  for (const auto& condition : whole) of_conditions.push_back(momentsOf(condition).mean);
  const double between = n * momentsOf(of_conditions).squares, people = k * momentsOf(of_people).squares;
  finish(test, between, momentsOf(all).squares - between - people);
  return test;
}

double tukeyPair(const Groups& groups, std::size_t a, std::size_t b) {
  PINCER_ASSERT(a < groups.size() && b < groups.size());
  const VarianceTest test = oneWayVariance(groups);
  const Moments first = finiteMoments(groups[a]), second = finiteMoments(groups[b]);
  if (!(test.within > 0) || first.n < 1 || second.n < 1) return 1;
  const double error = std::sqrt(0.5 * test.within * (1 / first.n + 1 / second.n));
  return studentizedRangeTail(std::abs(first.mean - second.mean) / error, static_cast<int>(groups.size()),
                              test.within_dof);
}

MeansTest studentTest(const std::vector<double>& a, const std::vector<double>& b) {
  const Moments x = finiteMoments(a), y = finiteMoments(b);
  const double dof = x.n + y.n - 2;
  if (x.n < 1 || y.n < 1 || !(dof > 0)) return {};
  return meansTest(y.mean - x.mean, std::sqrt((x.squares + y.squares) / dof * (1 / x.n + 1 / y.n)), dof);
}

MeansTest welchTest(const std::vector<double>& a, const std::vector<double>& b) {
  const Moments x = finiteMoments(a), y = finiteMoments(b);
  if (x.n < 2 || y.n < 2) return {};
  const double vx = x.variance() / x.n, vy = y.variance() / y.n, v = vx + vy;
  return meansTest(y.mean - x.mean, std::sqrt(v), v * v / (vx * vx / (x.n - 1) + vy * vy / (y.n - 1)));
}

MeansTest oneSampleTest(const std::vector<double>& a, double value) {
  const Moments x = finiteMoments(a);
  if (x.n < 2) return {};
  return meansTest(x.mean - value, std::sqrt(x.variance() / x.n), x.n - 1);
}

double equivalenceTest(const std::vector<double>& differences, double margin) {
  PINCER_ASSERT(margin > 0);
  const MeansTest low = oneSampleTest(differences, -margin), high = oneSampleTest(differences, margin);
  const auto oneSided = [](const MeansTest& test, double sign) {
    const double half = 0.5 * test.p;
    return sign * test.t > 0 ? half : 1 - half;
  };
  return std::max(oneSided(low, 1), oneSided(high, -1));
}

}  // namespace pincer::tasks
