// study_tests: do the conditions of a psychophysical session differ? Analyses of variance over the
// people's headline figures, and every pair.
//
// As published: one-way, as if the conditions had been done by different people, with Tukey's test of the
// pairs, and Student's unpaired t. Beside them, because everybody did all conditions: repeated measures and
// paired t (group_tests.h, paired_test.h).
#pragma once
#include <string>

#include "pincer/tasks/lab/report/study_summary.h"

namespace pincer::tasks {

// A section of the report; empty for fewer than two conditions with at least two people each.
std::string studyTestsHtml(const StudySummary& summary);

}  // namespace pincer::tasks
