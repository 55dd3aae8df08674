// finding_words: what a session of the manipulation tasks found, in words that need no table: who took part,
// the measure that counts, by force only and with the display, the difference with its interval, in how many
// people, and how easily chance does the same.
//
// The measure that counts was chosen beforehand: squeezes per sphere picked up; of alignment, the error. The
// others are named only where they differ even after Holm's correction for having looked at all of them (S.
// Holm, Scand. J. Statist. 6(2), 1979, 65-70).
#pragma once
#include <string>
#include <vector>

#include "pincer/tasks/lab/report/summary.h"

namespace pincer::tasks {

// One sentence or a few per task; at least one.
std::vector<std::string> findingWords(const SessionSummary& summary);

}  // namespace pincer::tasks
