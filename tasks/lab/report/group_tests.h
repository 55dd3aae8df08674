// group_tests: do groups of numbers have the same mean, which differ, and are two the same within a margin?
//
//   one-way       F = MS_between / MS_within,  k - 1 and N - k degrees of freedom
//   repeated      F = MS_conditions / MS_residual,  k - 1 and (k - 1)(n - 1): each of n people did each of k conditions
//   Tukey         q = |m_a - m_b| / sqrt(MS_within / 2 (1/n_a + 1/n_b)), studentized range of
//                 k means (J. W. Tukey; C. Y. Kramer, 1956)
//   Student       t = (m_b - m_a) / sqrt(s^2 (1/n_a + 1/n_b)), one variance, n_a + n_b - 2: as the published tests
//   Welch         t = (m_b - m_a) / sqrt(s_a^2/n_a + s_b^2/n_b), degrees of freedom by F. E.
//                 Satterthwaite (B. L. Welch, Biometrika 34, 1947)
//   equivalence   two one-sided t-tests against -margin and +margin; p is the larger (D. J.
//                 Schuirmann, J. Pharmacokinet. Biopharm. 15, 1987)
//
// Numbers that aren't finite are left out (of repeated measures: the person). Where a test
// needs more numbers or nothing varies, p is 1.
#pragma once
#include <vector>

#include "pincer/tasks/lab/report/statistics.h"

namespace pincer::tasks {

using Groups = std::vector<std::vector<double>>;

struct VarianceTest {
  double f = 0, between_dof = 0, within_dof = 0;
  double within = 0;  // MS within groups, of repeated measures the residual's
  double p = 1;
};

VarianceTest oneWayVariance(const Groups& groups);
// `conditions[c][person]`: all of one length.
VarianceTest repeatedMeasures(const Groups& conditions);

// p of the pair a, b of the groups' one-way analysis.
double tukeyPair(const Groups& groups, std::size_t a, std::size_t b);

struct MeansTest {
  double difference = 0;  // b - a
  double t = 0, dof = 0, p = 1;
};
MeansTest studentTest(const std::vector<double>& a, const std::vector<double>& b);
MeansTest welchTest(const std::vector<double>& a, const std::vector<double>& b);
// Of one group's mean against `value`.
MeansTest oneSampleTest(const std::vector<double>& a, double value);

// p that the mean of `differences` isn't within (-margin, margin), margin > 0.
double equivalenceTest(const std::vector<double>& differences, double margin);

}  // namespace pincer::tasks
