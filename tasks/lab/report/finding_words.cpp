#include "pincer/tasks/lab/report/finding_words.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <numeric>

#include "pincer/contact/io/counted.h"

namespace pincer::tasks {
namespace {

constexpr double kChanceLimit = 0.05;  // of p: level of significance
constexpr double kLeastShown = 0.005;  // half of the last digit that is written: narrower intervals have one end

bool isSimulated(const SessionSummary& s) { return s.info.devices_json.find("\"simulated\"") != std::string::npos; }

std::string peopleWords(const SessionSummary& s) {
  const char* kind = isSimulated(s) ? "simulated " : "";
  return s.participants == 1 ? fmt::format("One {}person", kind) : fmt::format("{} {}people", s.participants, kind);
}

// "1 in 80 such studies": how often chance alone would show a difference as large.
std::string chanceWords(double p) {
  if (p < 1e-3) return "chance alone would hardly ever show as much (less than 1 in 1000 such studies)";
  return fmt::format("chance alone would show as much in {} such studies",
                     p < 0.1 ? fmt::format("1 of {:.0f}", 1 / p) : fmt::format("{:.0f} of 100", 100 * p));
}

std::string unitOf(const FindingMeasure& m) { return *m.unit ? fmt::format(" {}", m.unit) : ""; }

// "by force only", "with the display"; of a study's own conditions "in " and the label.
std::string inWords(const SessionSummary& s, std::size_t condition) {
  if (s.labels[condition] == "force only") return "by force only";
  if (s.labels[condition] == "CLD + force") return "with the display";
  return fmt::format("in \"{}\"", s.labels[condition]);
}

// True of the published pair, whose difference is the display.
bool isTheDisplay(const SessionSummary& s) { return s.conditions == std::vector<std::string>{"force", "cld+force"}; }

std::string meanWords(const SessionSummary& s, const MeasureRow& row) {
  const FindingMeasure& m = findingMeasures()[row.measure];
  std::string words = m.label;
  words[0] = static_cast<char>(std::toupper(static_cast<unsigned char>(words[0])));
  for (std::size_t k = 0; k < row.means.size(); ++k)
    words += fmt::format("{} {:.2f}{} {}", k == 0 ? ":" : ",", row.means[k].mean, unitOf(m), inWords(s, k));
  return words;
}

// Equal differences say nothing about how far others would lie apart.
std::string intervalWords(const Estimate& difference) {
  if (!(difference.half_width >= kLeastShown)) return "the same for all, so no interval";
  return fmt::format("95 % interval {:+.2f} to {:+.2f}", difference.mean - difference.half_width,
                     difference.mean + difference.half_width);
}

// One condition against the first. `p`: adjusted, where several are compared.
std::string comparisonWords(const MeasureRow& row, std::size_t k, double p) {
  const PairedTest& test = row.tests[k];
  const std::string unit = unitOf(findingMeasures()[row.measure]);
  const bool less = test.difference.mean < 0;
  return fmt::format("difference {:+.2f}{} ({}), {} for {} of {} people; {}", test.difference.mean, unit,
                     intervalWords(test.difference), less ? "less" : "more", less ? test.lower : test.higher, test.n,
                     chanceWords(p));
}

std::string verdictWords(const SessionSummary& s, const MeasureRow& row, std::size_t k, double p) {
  const bool less = row.tests[k].difference.mean < 0, shown = p < kChanceLimit;
  if (isTheDisplay(s))
    return shown ? fmt::format("So the display {} it.", less ? "lowers" : "raises")
                 : "So no effect of the display is shown; that isn't to say that there is none.";
  return shown ? fmt::format("So it is {} {} than {}.", less ? "less" : "more", inWords(s, k + 1), inWords(s, 0))
               : fmt::format("So no difference {} is shown; that isn't to say that there is none.", inWords(s, k + 1));
}

// The other measures of the task that differ all the same.
std::string otherWords(const SessionSummary& s, const std::vector<MeasureRow>& rows) {
  std::vector<double> p;
  std::vector<std::string> names;
  std::size_t measures = 0;
  for (std::size_t r = 1; r < rows.size(); ++r) {
    bool looked = false;
    for (std::size_t k = 0; k < rows[r].tests.size(); ++k) {
      const PairedTest& test = rows[r].tests[k];
      p.push_back(test.n < 2 ? std::nan("") : test.p_wilcoxon);
      names.push_back(fmt::format("{}{} ({:+.2f})", findingMeasures()[rows[r].measure].label,
                                  isTheDisplay(s) ? "" : " " + inWords(s, k + 1), test.difference.mean));
      looked = looked || p.back() == p.back();
    }
    measures += looked;
  }
  const std::vector<double> adjusted = holmAdjusted(p);
  std::string differ;
  for (std::size_t k = 0; k < p.size(); ++k)
    if (adjusted[k] < kChanceLimit) differ += (differ.empty() ? "" : ", ") + names[k];
  if (measures == 0) return "";
  const std::string looked = counted(static_cast<std::int64_t>(measures), "other measure");
  return differ.empty() ? fmt::format("None of the {} looked at differs beyond chance (Holm).", looked)
                        : fmt::format("Of the {} looked at, these differ as well (Holm): {}.", looked, differ);
}

std::string taskWords(const SessionSummary& s, bool pickup) {
  std::vector<MeasureRow> rows;
  std::copy_if(s.rows.begin(), s.rows.end(), std::back_inserter(rows), [&](const MeasureRow& row) {
    const auto known = std::count_if(row.means.begin(), row.means.end(), [](const Estimate& e) { return e.n > 0; });
    return findingMeasures()[row.measure].of_pickup == pickup && known > 1 && row.means[0].n > 0;
  });
  if (rows.empty()) return "";
  const MeasureRow& primary = rows[0];  // the list begins with the one that counts
  std::string words = meanWords(s, primary);
  const bool alone = std::all_of(primary.tests.begin(), primary.tests.end(), [](const auto& t) { return t.n < 2; });
  if (alone) return words + "; one person says nothing about others. More people are needed for a finding.";
  const std::vector<double> adjusted = primary.adjusted();
  const bool several = primary.tests.size() > 1;
  for (std::size_t k = 0; k < primary.tests.size(); ++k) {
    if (primary.tests[k].n < 2) continue;
    words +=
        several ? fmt::format("{} \"{}\" against \"{}\": ", k == 0 ? "." : "", s.labels[k + 1], s.labels[0]) : "; ";
    words += comparisonWords(primary, k, adjusted[k]) + ". " + verdictWords(s, primary, k, adjusted[k]);
  }
  if (several) words += fmt::format(" Chances are Holm's, for {} comparisons.", primary.tests.size());
  const std::string others = otherWords(s, rows);
  return words + (others.empty() ? "" : " " + others);
}

}  // namespace

std::vector<std::string> findingWords(const SessionSummary& s) {
  std::vector<std::string> words;
  for (const bool pickup : {true, false}) {
    const std::string task = taskWords(s, pickup);
    if (!task.empty()) words.push_back(fmt::format("{}. {}", peopleWords(s), task));
  }
  if (words.empty())
    words.push_back(fmt::format("{}, {}: no two conditions to compare.", peopleWords(s), counted(s.trials, "trial")));
  return words;
}

}  // namespace pincer::tasks
