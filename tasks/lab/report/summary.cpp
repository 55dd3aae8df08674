#include "pincer/tasks/lab/report/summary.h"

#include <fmt/format.h>

#include <algorithm>
#include <limits>
#include <map>
#include <set>

#include "pincer/contact/io/printable.h"
#include "pincer/tasks/run/session/session_conditions.h"

namespace pincer::tasks {

namespace {

constexpr double kAllFrictions = std::numeric_limits<double>::quiet_NaN();  // NaN: a row for all of them

bool isFault(const TrialRecord& t) { return t.outcome == "fault"; }

Estimate estimateOf(const std::vector<TrialRecord>& trials, const Measure& measure) {
  std::map<std::int64_t, std::vector<double>> of_participant;
  for (const TrialRecord& t : trials) {
    if (!isFault(t)) of_participant[t.participant].push_back(measure.of(t));
  }
  if (of_participant.size() == 1) return estimateMean(of_participant.begin()->second);
  std::vector<double> means;
  for (const auto& [participant, values] : of_participant) means.push_back(estimateMean(values).mean);
  return estimateMean(means);
}

CellSummary cellOf(const std::string& condition, double mu_s, const std::vector<TrialRecord>& trials) {
  const auto count = [&](const char* outcome) {
    return std::count_if(trials.begin(), trials.end(), [&](const TrialRecord& t) { return t.outcome == outcome; });
  };
  CellSummary cell;
  cell.condition = condition;
  cell.mu_s = mu_s;
  cell.trials = static_cast<std::int64_t>(trials.size());
  cell.successes = count("success");
  cell.timeouts = count("timeout");
  cell.faults = count("fault");
  for (std::size_t m = 0; m < kMeasures.size(); ++m) cell.measures[m] = estimateOf(trials, kMeasures[m]);
  return cell;
}

template <class Keep>
std::vector<TrialRecord> select(const std::vector<TrialRecord>& trials, Keep keep) {
  std::vector<TrialRecord> kept;
  std::copy_if(trials.begin(), trials.end(), std::back_inserter(kept), keep);
  return kept;
}

void addCells(SessionSummary& s, const std::string& condition, const std::vector<TrialRecord>& trials) {
  for (const double mu : s.frictions) {
    const auto of_mu = select(trials, [mu](const TrialRecord& t) { return t.mu_s == mu; });
    if (!of_mu.empty()) s.cells.push_back(cellOf(condition, mu, of_mu));
  }
  s.cells.push_back(cellOf(condition, kAllFrictions, trials));
}

// The conditions that trials were done in.
void addConditions(SessionSummary& s, std::set<std::string> done) {
  for (const auto& [name, label] : conditionLabels(s.info)) {
    if (done.erase(name) == 0) continue;
    s.conditions.push_back(name);
    s.labels.push_back(label);
  }
  std::vector<std::string> others(done.begin(), done.end());
  std::stable_partition(others.begin(), others.end(), [](const std::string& c) { return c == "force"; });
  for (const std::string& c : others) {
    s.conditions.push_back(c);
    s.labels.push_back(publishedLabel(c));
  }
}

std::string show(const Estimate& e, Averaged averaged, bool lower_bound = false) {
  if (e.n == 0) return "–";
  if (lower_bound) return fmt::format("≥ {:.2f}", e.mean);
  if (e.n < 2 || !(e.half_width > 0)) return fmt::format("{:.2f}", e.mean);  // a few equal values aren't certainty
  const Interval interval = intervalOf(e, averaged);
  return fmt::format("{:.2f} ({:.2f} to {:.2f})", e.mean, interval.low, interval.high);
}

// Characters, not bytes: a UTF-8 continuation byte is 10xxxxxx.
std::size_t width(const std::string& text) {
  return static_cast<std::size_t>(std::count_if(text.begin(), text.end(), [](char c) { return (c & 0xc0) != 0x80; }));
}

std::string alignedRow(const std::vector<std::string>& fields, const std::vector<std::size_t>& widths) {
  std::string line;
  for (std::size_t c = 0; c < fields.size(); ++c) {
    const std::string space(widths[c] - width(fields[c]), ' ');
    if (c > 0) line += "  ";
    line += c == 0 ? fields[c] + space : space + fields[c];  // names to the left, numbers to the right
  }
  return line + "\n";
}

std::string alignedRows(std::vector<std::vector<std::string>> rows) {
  for (auto& row : rows) {
    for (std::string& field : row) field = printable(field);  // names in a session may be another's
  }
  std::vector<std::size_t> widths(rows[0].size(), 0);
  for (const auto& row : rows) {
    for (std::size_t c = 0; c < row.size(); ++c) widths[c] = std::max(widths[c], width(row[c]));
  }
  std::string text;
  for (const auto& row : rows) text += alignedRow(row, widths);
  return text;
}

}  // namespace

const std::string& SessionSummary::labelOf(const std::string& condition) const {
  const auto found = std::find(conditions.begin(), conditions.end(), condition);
  const auto place = static_cast<std::size_t>(found - conditions.begin());
  return place < labels.size() ? labels[place] : condition;
}

SessionSummary summariseSession(const SessionReader& session) {
  SessionSummary s{session.path(),
                   session.info(),
                   session.state(),
                   session.startedUtc(),
                   session.warning(),
                   0,
                   0,
                   {},
                   {},
                   {},
                   {},
                   {}};
  const std::vector<TrialRecord> all = session.trials();
  const auto trials = select(all, [](const TrialRecord& t) { return t.task == "sphere-pickup" && t.training == 0; });
  std::set<std::int64_t> participants;
  std::set<std::string> conditions;
  std::set<double> frictions;
  for (const TrialRecord& t : all) {
    participants.insert(t.participant);
    conditions.insert(t.condition);
  }
  for (const TrialRecord& t : trials) frictions.insert(t.mu_s);
  s.participants = static_cast<std::int64_t>(participants.size());
  s.trials = static_cast<std::int64_t>(all.size());
  s.frictions.assign(frictions.begin(), frictions.end());
  addConditions(s, conditions);
  for (const std::string& c : s.conditions) {
    const auto of_condition = select(trials, [&](const TrialRecord& t) { return t.condition == c; });
    if (!of_condition.empty()) addCells(s, c, of_condition);
  }
  s.rows = measureRows(all, s.conditions);
  return s;
}

std::vector<std::string> pairHeads(const SessionSummary& s) {
  const bool two = s.conditions.size() == 2;
  std::vector<std::string> heads{
      "over the participants", s.labels[0], two ? s.labels[1] : "compared with it", "difference", "d_z", "p (t)",
      "p (Wilcoxon)"};
  if (!two) heads.emplace_back("p (Holm)");
  return heads;
}

std::vector<std::vector<std::string>> pairTexts(const SessionSummary& s) {
  const auto p_text = [](double p) {
    return p != p ? std::string("–") : p < 1e-4 ? "< 0.0001" : fmt::format("{:.4f}", p);
  };
  std::vector<std::vector<std::string>> texts;
  for (const MeasureRow& row : s.rows) {
    const FindingMeasure& m = findingMeasures()[row.measure];
    const std::vector<double> adjusted = row.adjusted();
    for (std::size_t k = 0; k < row.tests.size(); ++k) {
      const PairedTest& test = row.tests[k];
      const bool several = row.tests.size() > 1, tested = test.n > 1;
      const std::string mean = show(row.means[k + 1], m.averaged);
      texts.push_back({fmt::format("{}{}", m.label, *m.unit ? fmt::format(" [{}]", m.unit) : ""),
                       show(row.means[0], m.averaged), several ? fmt::format("{}: {}", s.labels[k + 1], mean) : mean,
                       show(test.difference, Averaged::kAny),
                       tested && test.effect == test.effect ? fmt::format("{:.2f}", test.effect) : "–",
                       tested ? p_text(test.p_t) : "–", tested ? p_text(test.p_wilcoxon) : "–"});
      if (several) texts.back().push_back(p_text(adjusted[k]));
    }
  }
  return texts;
}

std::vector<std::string> tableHeads() {
  std::vector<std::string> heads{"condition", "µₛ", "trials"};
  heads.insert(heads.end(), {"success", "time-outs", "faults"});
  for (const Measure& m : kMeasures) heads.emplace_back(m.label);
  return heads;
}

std::vector<std::string> tableRow(const SessionSummary& summary, const CellSummary& cell) {
  std::vector<std::string> row{summary.labelOf(cell.condition),
                               cell.allFrictions() ? "all" : fmt::format("{:.2f}", cell.mu_s),
                               fmt::format("{}", cell.trials)};
  row.push_back(fmt::format("{:.0f} %", 100 * cell.successRate()));
  row.push_back(fmt::format("{}", cell.timeouts));
  row.push_back(fmt::format("{}", cell.faults));
  for (const Estimate& e : cell.measures) row.push_back(show(e, Averaged::kPositive, cell.timeouts > 0));
  return row;
}

std::string tableNote(const SessionSummary& s) {
  std::string note = fmt::format("Mean and 95 % confidence interval (Student t, of the logarithm) over {}.",
                                 s.participants > 1 ? "the participants' means" : "the trials of the one participant");
  note += " A value without one: all are equal, or there is only one.";
  const auto has = [&](auto of) {
    return std::any_of(s.cells.begin(), s.cells.end(), [of](const CellSummary& c) { return c.*of > 0; });
  };
  if (has(&CellSummary::timeouts))
    note += " ≥ marks lower bounds: at least one trial of the cell timed out, so that no interval can be told.";
  if (has(&CellSummary::faults)) note += " Trials that ended in a fault are left out of the means.";
  return note;
}

std::string formatTable(const SessionSummary& summary) {
  std::string text;
  if (!summary.cells.empty()) {
    std::vector<std::vector<std::string>> rows{tableHeads()};
    for (const CellSummary& cell : summary.cells) rows.push_back(tableRow(summary, cell));
    text += alignedRows(rows) + tableNote(summary) + "\n";
  }
  if (summary.conditions.size() > 1 && !summary.rows.empty()) {
    std::vector<std::vector<std::string>> rows{pairHeads(summary)};
    for (std::vector<std::string>& row : pairTexts(summary)) rows.push_back(std::move(row));
    text += "\n" + alignedRows(rows);
  }
  if (!summary.warning.empty()) text += summary.warning + "\n";
  return text;
}

}  // namespace pincer::tasks
