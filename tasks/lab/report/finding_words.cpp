#include "pincer/tasks/lab/report/finding_words.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <numeric>

#include "pincer/contact/io/counted.h"

namespace pincer::tasks {
namespace {

constexpr double kChanceLimit = 0.05;  // of p: level of significance

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

std::string comparisonWords(const PairedRow& row) {
  const FindingMeasure& m = findingMeasures()[row.measure];
  const PairedTest& test = row.test;
  const std::string unit = unitOf(m);
  std::string head = m.label;
  head[0] = static_cast<char>(std::toupper(static_cast<unsigned char>(head[0])));
  std::string words = fmt::format("{}: {:.2f}{} by force only, {:.2f}{} with the display", head, row.force.mean, unit,
                                  row.cld.mean, unit);
  if (test.n < 2) return words + "; one person says nothing about others";
  const double low = test.difference.mean - test.difference.half_width,
               high = test.difference.mean + test.difference.half_width;
  words +=
      fmt::format("; difference {:+.2f}{} (95 % interval {:+.2f} to {:+.2f})", test.difference.mean, unit, low, high);
  const bool less = test.difference.mean < 0;
  return words + fmt::format(", {} for {} of {} people; {}", less ? "less" : "more", less ? test.lower : test.higher,
                             test.n, chanceWords(test.p_wilcoxon));
}

std::string verdictWords(const PairedRow& row) {
  if (row.test.n < 2) return "More people are needed for a finding.";
  if (row.test.p_wilcoxon < kChanceLimit)
    return fmt::format("So the display {} it.", row.test.difference.mean < 0 ? "lowers" : "raises");
  return "So no effect of the display is shown; that isn't to say that there is none.";
}

// The other measures of the task that differ all the same.
std::string otherWords(const std::vector<PairedRow>& rows, std::size_t primary) {
  std::vector<double> p;
  for (std::size_t k = 0; k < rows.size(); ++k)
    p.push_back(k == primary || rows[k].test.n < 2 ? std::nan("") : rows[k].test.p_wilcoxon);
  const std::vector<double> adjusted = holmAdjusted(p);
  const auto looked = std::count_if(p.begin(), p.end(), [](double x) { return x == x; });
  std::string differ;
  for (std::size_t k = 0; k < rows.size(); ++k) {
    if (adjusted[k] < kChanceLimit)
      differ += fmt::format("{}{} ({:+.2f})", differ.empty() ? "" : ", ", findingMeasures()[rows[k].measure].label,
                            rows[k].test.difference.mean);
  }
  if (looked == 0) return "";
  return differ.empty()
             ? fmt::format("None of the {} looked at differs beyond chance (Holm).", counted(looked, "other measure"))
             : fmt::format("Of the {} looked at, these differ as well (Holm): {}.", counted(looked, "other measure"),
                           differ);
}

std::string taskWords(const SessionSummary& s, bool pickup) {
  std::vector<PairedRow> rows;
  std::copy_if(s.pairs.begin(), s.pairs.end(), std::back_inserter(rows), [&](const PairedRow& row) {
    return findingMeasures()[row.measure].of_pickup == pickup && row.force.n > 0 && row.cld.n > 0;
  });
  if (rows.empty()) return "";
  const std::string others = rows[0].test.n < 2 ? "" : otherWords(rows, 0);  // the list begins with the one that counts
  return fmt::format("{}. {}{}{}", comparisonWords(rows[0]), verdictWords(rows[0]), others.empty() ? "" : " ", others);
}

}  // namespace

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
