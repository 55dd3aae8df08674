// person_means: what a participant of the manipulation tasks did in each condition, and whether the conditions differ:
// each is compared with the first.
//
// A time-out is censored: a count or time per success is (sum over all trials) / (successes), the
// estimate of largest likelihood when every try succeeds with the same chance; with no success at all it
// is a lower bound. Training and faults don't count.
#pragma once
#include <cstdint>
#include <string>
#include <vector>

#include "pincer/tasks/lab/report/paired_test.h"
#include "pincer/tasks/run/records.h"

namespace pincer::tasks {

// with the display, against without; kNone: shown only
enum class PublishedEffect : std::uint8_t { kLess, kMore, kSame, kNone };

struct FindingMeasure {
  const char *key, *label, *unit, *published;
  PublishedEffect expected;
  bool of_pickup;
  Averaged averaged = Averaged::kPositive;
};
const std::vector<FindingMeasure>& findingMeasures();

// The means of one participant's `trials` in the condition, one per measure; NaN: none.
std::vector<double> personMeans(const std::vector<TrialRecord>& trials, const std::string& condition);

// A measure in every condition, over the participants.
struct MeasureRow {
  std::size_t measure = 0;              // place in findingMeasures()
  std::vector<Estimate> means;          // per condition
  std::vector<std::vector<double>> of;  // likewise, of each participant in the order of their numbers; NaN: none
  std::vector<PairedTest> tests;        // of the second condition against the first, of the third against it ...
  // Holm's adjusted p of `tests` (Wilcoxon), for having looked at all of them; NaN where one can't be told.
  std::vector<double> adjusted() const;
};
// Of the measures that somebody has, in conditions of these names.
std::vector<MeasureRow> measureRows(const std::vector<TrialRecord>& trials, const std::vector<std::string>& conditions);

}  // namespace pincer::tasks
