// person_means: what a participant of the manipulation tasks did in either
// condition, and whether the conditions differ.
//
// A time-out is censored: a count or time per success is (sum over all trials) / (successes), the
// estimate of largest likelihood when every try succeeds with the same chance; with no success at all it
// is a lower bound. Training and faults don't count.
#pragma once
#include <cstdint>
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

// The means of one participant, per condition (force, cld+force), one per measure.
struct PersonMeans {
  std::vector<double> force, cld;
};
PersonMeans personMeans(const std::vector<TrialRecord>& trials);

// Both conditions of a measure over the participants.
struct PairedRow {
  std::size_t measure = 0;  // place in findingMeasures()
  Estimate force, cld;
  PairedTest test;
  std::vector<double> force_of, cld_of;  // each participant's, in the order of their numbers; NaN: none
};
// Of the measures that somebody has.
std::vector<PairedRow> pairedRows(const std::vector<TrialRecord>& trials);

}  // namespace pincer::tasks
