// paired_test: does a measure differ between two conditions that the same people did?
//
//   d_i = b_i - a_i, i = 1..n;   mean +- t_{0.975, n-1} s/sqrt(n)
//   d_z = mean/s   (J. Cohen, Statistical Power Analysis, 1988, ch. 2)
//   t-test     t = mean/(s/sqrt(n)), two-sided, Student with n - 1 degrees of freedom
//   Wilcoxon   W = sum of the ranks of |d_i| with d_i > 0, zeros left out, ties by mean ranks; p
//              two-sided and exact over all 2^n signs (F. Wilcoxon, Biometrics Bulletin 1(6), 1945,
//              80-83), by counting the sums of doubled ranks
//   Wilson     interval of a share k of n (E. B. Wilson, J. Am. Stat. Assoc. 22, 1927, 209-212)
#pragma once
#include <utility>
#include <vector>

#include "pincer/tasks/lab/report/statistics.h"

namespace pincer::tasks {

struct PairedTest {
  int n = 0;              // pairs; those with a NaN don't count
  int lower = 0;          // of them, those with b < a
  int higher = 0;         // those with b > a
  Estimate difference;    // b - a
  double effect = 0;      // d_z; NaN if n < 2 or nothing varies
  double p_t = 1;         // 1 where it can't be told; NaN where all differ by the same
  double p_wilcoxon = 1;  // likewise
};

// `a` and `b` of the same people in the same order.
PairedTest comparePairs(const std::vector<double>& a, const std::vector<double>& b);

// Two-sided exact p of Wilcoxon's signed ranks; 1 if all are zero. At most 60 differences.
double wilcoxonSignedRank(const std::vector<double>& differences);

// Adjusted p of each, for having looked at all of them; NaN counts as never looked at (S. Holm, Scand. J. Statist.
// 6(2), 1979, 65-70).
std::vector<double> holmAdjusted(const std::vector<double>& p);

std::pair<double, double> wilsonInterval(int k, int n);  // 95 %

}  // namespace pincer::tasks
