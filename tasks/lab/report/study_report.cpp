#include "pincer/tasks/lab/report/study_report.h"

#include <fmt/format.h>

#include "pincer/contact/io/atomic_file.h"
#include "pincer/tasks/lab/report/device_errors.h"
#include "pincer/tasks/lab/report/figures.h"
#include "pincer/tasks/lab/report/html_page.h"
#include "pincer/tasks/lab/report/study_tests.h"

namespace pincer::tasks {
namespace {

std::vector<Picture> studyPictures(const SessionReader& session, const StudySummary& s,
                                   const std::vector<ResponseRecord>& responses) {
  std::vector<Picture> pictures;
  if (responses.empty()) return pictures;
  const auto add = [&](Figure figure) { pictures.push_back({std::move(figure), "", ""}); };
  add(headlineFigure(s));
  const bool has_staircases =
      std::any_of(s.conditions.begin(), s.conditions.end(), [](const StudyCondition& c) { return c.averaged > 0; });
  if (has_staircases) {
    add(staircaseFigure(s, responses));
    add(psychometricFigure(s, responses));
  }
  if (s.info.task == "repeated-localisation") add(placesFigure(responses));
  if (s.info.task == "shape-identification") add(confusionFigure(responses));
  add(speedFigure(s));
  add(timeFigure(s));
  if (auto ticks = tickFigure(session)) add(*std::move(ticks));
  return pictures;
}

bool isSimulated(const StudySummary& s) { return s.info.devices_json.find("\"simulated\"") != std::string::npos; }

std::string studyFacts(const StudySummary& s) {
  return htmlFacts({{"task", s.info.task},
                    {"seed", std::to_string(s.info.seed)},
                    {"started (UTC)", s.started_utc},
                    {"state of the session", s.state},
                    {"participants", fmt::format("{}{}", s.participants, isSimulated(s) ? ", simulated" : "")},
                    {"finished trials", std::to_string(s.trials)},
                    {"fingerprint of the participants' parameters", s.fingerprint},
                    {"pincer", s.info.version},
                    {"build", buildFacts(s.info)},
                    {"session file", s.path}});
}

std::string studyHtml(const StudySummary& s, const std::vector<Picture>& pictures, const std::string& figures_name,
                      const std::string& errors, const ReplayPage& replay) {
  std::string html = htmlHead(fmt::format("{}, seed {}", s.info.task, s.info.seed), s.warning);
  html += fmt::format("<p class=\"finding\">{}</p>\n", escaped(studyFinding(s)));
  html += htmlReplay(replay);
  html += "<h2>Per condition</h2>\n<div class=\"wide\"><table>\n" + htmlRow(studyTableHeads(s), "th");
  for (const StudyCondition& c : s.conditions) html += htmlRowOfIntervals(studyTableRow(s, c));
  html += fmt::format("</table></div>\n<p class=\"note\">{}</p>\n", escaped(studyNote(s)));
  html += studyTestsHtml(s);
  for (const Picture& picture : pictures) html += htmlFigure(picture, figures_name);
  return html + errors + htmlFoot(s.info, studyFacts(s));
}

}  // namespace

ReportFiles writeStudyReport(const SessionReader& session, const std::string& html_path, const ReportOptions& options) {
  const std::vector<ResponseRecord> responses = session.responses();
  const StudySummary summary = summariseStudy(session, responses);
  std::vector<Picture> pictures = studyPictures(session, summary, responses);
  ReportFiles files;
  const std::string figures_name = plotAndWrite(pictures, html_path, options, files);
  const std::string more =
      htmlNotDrawn(files.not_drawn) + htmlSurvey(session.survey()) + deviceErrorsHtml(deviceErrors(session));
  writeAtomically(html_path, studyHtml(summary, pictures, figures_name, more, options.replay));
  return files;
}

}  // namespace pincer::tasks
