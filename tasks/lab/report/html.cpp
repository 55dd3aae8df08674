#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "pincer/tasks/lab/report/finding_words.h"
#include "pincer/tasks/lab/report/html_page.h"

namespace pincer::tasks {

namespace {

std::string facts(const SessionSummary& s) {
  const std::vector<std::pair<std::string, std::string>> rows{{"task", s.info.task},
                                                              {"seed", std::to_string(s.info.seed)},
                                                              {"started (UTC)", s.started_utc},
                                                              {"state of the session", s.state},
                                                              {"participants", std::to_string(s.participants)},
                                                              {"finished trials", std::to_string(s.trials)},
                                                              {"pincer", s.info.version},
                                                              {"build", buildFacts(s.info)},
                                                              {"participants' parameters", s.info.participants_hash},
                                                              {"session file", s.path}};
  return htmlFacts(rows);
}

std::string cellTable(const SessionSummary& s) {
  if (s.cells.empty()) return s.trials > 0 ? "" : "<p>No trial was finished.</p>\n";
  std::string html = "<div class=\"wide\"><table>\n" + htmlRow(tableHeads(), "th");
  for (const CellSummary& cell : s.cells)
    html += htmlRowOfIntervals(tableRow(s, cell), cell.allFrictions() ? " class=\"all\"" : "");
  return fmt::format("{}</table></div>\n<p class=\"note\">{}</p>\n", html, escaped(tableNote(s)));
}

std::string pairTable(const SessionSummary& s) {
  if (s.rows.empty() || s.conditions.size() < 2) return "";
  std::string html = "<h2>The conditions compared</h2>\n<div class=\"wide\"><table>\n" + htmlRow(pairHeads(s), "th");
  for (const std::vector<std::string>& row : pairTexts(s)) html += htmlRowOfIntervals(row);
  const bool several = s.conditions.size() > 2;
  return html + fmt::format(
                    "</table></div>\n<p class=\"note\">Means over the participants with their 95 % intervals (Student "
                    "t; of the logarithm, of shares the logit); difference: {} minus {}; d_z: mean over standard "
                    "deviation of the participants' differences; paired t-test and Wilcoxon's signed ranks (exact){}. "
                    "Time-outs are censored: counts and times are per success.</p>\n",
                    escaped(several ? "the other condition" : s.labels[1]), escaped(s.labels[0]),
                    several ? "; Holm: p (Wilcoxon) adjusted for the comparisons of the measure" : "");
}

std::string number(double value, double scale, int digits) {
  return std::isfinite(value) ? fmt::format("{:.{}f}", scale * value, digits) : "–";
}

// The trial's number, which leads to where the page plays it.
std::string trialCell(std::int64_t trial, const ReplayPage& replay) {
  const auto found = std::find(replay.trials.begin(), replay.trials.end(), trial);
  if (replay.name.empty() || found == replay.trials.end()) return fmt::format("<td>{}</td>", trial + 1);
  return fmt::format("<td><a href=\"{}#shown={}\">{}</a></td>", escaped(replay.name), found - replay.trials.begin() + 1,
                     trial + 1);
}

std::string trialList(const SessionSummary& s, const std::vector<TrialRecord>& trials, const ReplayPage& replay) {
  std::string html = "<h2>All trials</h2>\n<div class=\"wide\"><table class=\"long\">\n" +
                     htmlRow({"trial", "task", "participant", "condition", "µₛ", "outcome", "squeezes", "lifts",
                              "tries > 5 mm", "time [s]", "slips", "drops", "peak grip [N]", "grip ratio [-]",
                              "offset [mm]", "error [deg]", "regrasps"},
                             "th");
  for (const TrialRecord& t : trials) {
    const auto text = [](std::int64_t n) { return std::to_string(n); };
    std::string row = htmlRow(
        {t.training ? t.task + " (training)" : t.task, text(t.participant + 1), s.labelOf(t.condition),
         number(t.mu_s, 1, 2), t.outcome, text(t.squeezes), text(t.lifts), text(t.tries_5mm), number(t.duration, 1, 2),
         text(t.slips), text(t.drops), number(t.peak_grip, 1, 2), number(t.grip_ratio, 1, 2),
         number(t.offset_at_squeeze, 1e3, 1), number(t.error, 57.29577951308232, 1), text(t.regrasps)},
        "td", fmt::format(" id=\"trial-{}\"", t.trial + 1));
    html += row.insert(row.find('>') + 1, trialCell(t.trial, replay));
  }
  return html +
         "</table></div>\n<p class=\"note\">Grip ratio: grip while held over the smallest that holds, m g / (2 µₛ). "
         "Offset: of the "
         "contacts from "
         "the antipodal line at the last squeeze.</p>\n";
}

}  // namespace

std::string reportHtml(const SessionSummary& s, const std::vector<TrialRecord>& trials,
                       const std::vector<Picture>& pictures, const std::string& figures_name,
                       const std::string& devices, const ReplayPage& replay) {
  const std::string title = fmt::format("{}, seed {}", s.info.task, s.info.seed);
  std::string html = htmlHead(title, s.warning);
  for (const std::string& words : findingWords(s)) html += fmt::format("<p class=\"finding\">{}</p>\n", escaped(words));
  html += htmlReplay(replay);
  html += (s.cells.empty() ? "" : "<h2>Per condition and friction</h2>\n") + cellTable(s) + pairTable(s);
  for (const Picture& picture : pictures) html += htmlFigure(picture, figures_name);
  html += devices;
  if (!trials.empty()) html += trialList(s, trials, replay);
  return html + htmlFoot(s.info, facts(s));
}

}  // namespace pincer::tasks
