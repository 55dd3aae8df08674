#include "pincer/tasks/lab/report/person_means.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <map>

namespace pincer::tasks {
namespace {

constexpr double kNoValue = std::numeric_limits<double>::quiet_NaN();  // NaN: nothing to take a mean of
constexpr double kDegrees = 57.29577951308232;                         // per radian

struct Sums {
  double tries = 0, lifts = 0, pickup_time = 0, error = 0, signed_error = 0, alignment_time = 0, regrasps = 0;
  int pickups = 0, picked_up = 0, alignments = 0, answered = 0;

  void add(const TrialRecord& t) {
    const bool success = t.outcome == "success";
    if (t.task == "sphere-pickup") {
      ++pickups;
      picked_up += success;
      tries += static_cast<double>(t.squeezes);
      lifts += static_cast<double>(t.lifts);
      pickup_time += t.duration;
      return;
    }
    ++alignments;
    alignment_time += t.duration;
    regrasps += static_cast<double>(t.regrasps);
    if (!success) return;
    ++answered;
    error += kDegrees * std::abs(t.error);
    signed_error += kDegrees * t.error;
  }

  std::vector<double> means() const {
    const auto per = [](double sum, int n) { return n > 0 ? sum / n : kNoValue; };
    const int successes = std::max(picked_up, pickups > 0 ? 1 : 0),
              answers = std::max(answered, alignments > 0 ? 1 : 0);
    return {per(tries, successes),           per(lifts, successes),    per(pickup_time, successes),
            per(100.0 * picked_up, pickups), per(error, answered),     per(signed_error, answered),
            per(alignment_time, answers),    per(regrasps, alignments)};
  }
};

}  // namespace

const std::vector<FindingMeasure>& findingMeasures() {
  static const std::vector<FindingMeasure> measures = {
      {"tries", "squeezes per sphere picked up", "", "significantly fewer with the CLD", PublishedEffect::kLess, true},
      {"lifts", "lifts per sphere picked up", "", "(not published apart from tries)", PublishedEffect::kNone, true},
      {"pickup_time", "time per sphere picked up", "s", "no change", PublishedEffect::kSame, true},
      {"picked_up", "spheres picked up within the time", "%", "(not published)", PublishedEffect::kNone, true,
       Averaged::kPercent},
      {"alignment_error", "mean absolute alignment error", "deg", "no change", PublishedEffect::kSame, false},
      {"alignment_bias", "mean signed alignment error", "deg", "(not published)", PublishedEffect::kNone, false,
       Averaged::kAny},
      {"alignment_time", "time per alignment answered", "s", "7 s more with the CLD", PublishedEffect::kMore, false},
      {"regrasps", "regrasps per alignment", "", "(not published)", PublishedEffect::kNone, false},
  };
  return measures;
}

std::vector<double> personMeans(const std::vector<TrialRecord>& trials, const std::string& condition) {
  Sums sums;
  for (const TrialRecord& t : trials) {
    if (t.training == 0 && t.outcome != "fault" && t.condition == condition) sums.add(t);
  }
  return sums.means();
}

std::vector<double> MeasureRow::adjusted() const {
  std::vector<double> p;
  for (const PairedTest& test : tests) p.push_back(test.n < 2 ? kNoValue : test.p_wilcoxon);
  return holmAdjusted(p);
}

std::vector<MeasureRow> measureRows(const std::vector<TrialRecord>& trials,
                                    const std::vector<std::string>& conditions) {
  std::map<std::int64_t, std::vector<TrialRecord>> of_person;
  for (const TrialRecord& t : trials) of_person[t.participant].push_back(t);
  std::vector<MeasureRow> rows(findingMeasures().size());
  for (std::size_t m = 0; m < rows.size(); ++m) rows[m].measure = m;
  for (const std::string& condition : conditions) {
    for (MeasureRow& row : rows) row.of.emplace_back();
    for (const auto& [person, own] : of_person) {
      const std::vector<double> means = personMeans(own, condition);
      for (std::size_t m = 0; m < rows.size(); ++m) rows[m].of.back().push_back(means[m]);
    }
  }
  for (MeasureRow& row : rows) {
    for (const std::vector<double>& values : row.of) {
      std::vector<double> known;
      std::copy_if(values.begin(), values.end(), std::back_inserter(known), [](double x) { return std::isfinite(x); });
      row.means.push_back(estimateMean(known));
    }
    for (std::size_t k = 1; k < row.of.size(); ++k) row.tests.push_back(comparePairs(row.of[0], row.of[k]));
  }
  std::erase_if(rows, [](const MeasureRow& row) {
    return std::all_of(row.means.begin(), row.means.end(), [](const Estimate& e) { return e.n == 0; });
  });
  return rows;
}

}  // namespace pincer::tasks
