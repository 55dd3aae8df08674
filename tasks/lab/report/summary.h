// summary: what a session found, per condition and friction. Training doesn't count.
//
// Mean and 95 % confidence interval of each measure (statistics.h). The unit is the trial with one participant,
// and the participant's mean with several: trials of one person aren't independent. A trial that ended in a fault
// is counted but left out of the means. A time-out cuts a trial short, so the means of a cell that holds one are
// lower bounds and are marked with a `>=` sign.
#pragma once
#include <array>
#include <string>
#include <vector>

#include "pincer/tasks/lab/report/person_means.h"
#include "pincer/tasks/run/session_store.h"

namespace pincer::tasks {

struct Measure {
  const char* key;    // in JSON and CSV, with its unit
  const char* label;  // for people
  double (*of)(const TrialRecord&);
};

// Per trial; key and label tell the unit.
constexpr std::array<Measure, 6> kMeasures{{
    {"squeezes", "squeezes", [](const TrialRecord& t) { return static_cast<double>(t.squeezes); }},
    {"lifts", "lifts", [](const TrialRecord& t) { return static_cast<double>(t.lifts); }},
    {"tries_5mm", "tries > 5 mm", [](const TrialRecord& t) { return static_cast<double>(t.tries_5mm); }},
    {"time_s", "time [s]", [](const TrialRecord& t) { return t.duration; }},
    {"slips", "slips", [](const TrialRecord& t) { return static_cast<double>(t.slips); }},
    {"drops", "drops", [](const TrialRecord& t) { return static_cast<double>(t.drops); }},
}};
constexpr std::size_t kSqueezes = 0, kTime = 3;  // places in kMeasures

struct CellSummary {
  std::string condition;
  double mu_s = 0;  // NaN: all frictions of the condition
  std::int64_t trials = 0, successes = 0, timeouts = 0, faults = 0;
  std::array<Estimate, kMeasures.size()> measures;

  bool allFrictions() const { return mu_s != mu_s; }
  double successRate() const { return trials > 0 ? static_cast<double>(successes) / static_cast<double>(trials) : 0; }
};

struct SessionSummary {
  std::string path;
  SessionInfo info;
  std::string state, started_utc, warning;  // warning: empty if the session is complete
  std::int64_t participants = 0, trials = 0;
  std::vector<std::string> conditions;  // in the study's order; without a study "force" first, then by name
  std::vector<std::string> labels;      // of the conditions, for people
  std::vector<double> frictions;        // mu_s, rising
  std::vector<CellSummary> cells;       // of sphere pickup, per condition: each friction, then all
  std::vector<MeasureRow> rows;         // of both tasks, over the participants

  // A condition that the session doesn't have keeps its name.
  const std::string& labelOf(const std::string& condition) const;
};

SessionSummary summariseSession(const SessionReader& session);

// One text per column of a cell's row, and the columns' heads; shared by the text table and the HTML one.
std::vector<std::string> tableHeads();
std::vector<std::string> tableRow(const SessionSummary& summary, const CellSummary& cell);
std::string tableNote(const SessionSummary& summary);  // how to read the intervals and marks, one or two sentences

// The comparison of the conditions with the first: heads, and one text per column of a row; a row per measure and
// condition that is compared. Nothing with fewer than two conditions.
std::vector<std::string> pairHeads(const SessionSummary& summary);
std::vector<std::vector<std::string>> pairTexts(const SessionSummary& summary);

// For a terminal: aligned columns, UTF-8, no colour.
std::string formatTable(const SessionSummary& summary);

// For machines; NaN is null.
std::string summaryJson(const SessionSummary& summary);

}  // namespace pincer::tasks
