#include "pincer/tasks/lab/report/report.h"

#include <filesystem>

#include "pincer/contact/io/atomic_file.h"
#include "pincer/tasks/lab/report/device_errors.h"
#include "pincer/tasks/lab/report/figures.h"
#include "pincer/tasks/lab/report/html_page.h"

namespace pincer::tasks {

namespace {

std::vector<Picture> wantedPictures(const SessionReader& session, const SessionSummary& summary,
                                    const std::vector<TrialRecord>& trials) {
  std::vector<Picture> pictures;
  std::vector<TrialRecord> pickups, alignments;
  for (const TrialRecord& t : trials) {
    if (t.training == 0) (t.task == "cylinder-alignment" ? alignments : pickups).push_back(t);
  }
  if (auto people = peopleFigure(summary)) pictures.push_back({*std::move(people), "", ""});
  if (!alignments.empty()) pictures.push_back({alignmentFigure(summary, alignments), "", ""});
  if (!pickups.empty()) {
    pictures.push_back({measureFigure(summary, pickups, kSqueezes), "", ""});
    pictures.push_back({measureFigure(summary, pickups, kTime), "", ""});
  }
  for (const std::string& condition : summary.conditions) {
    const std::string& label = summary.labelOf(condition);
    const auto alignment = representativeTrial(alignments, condition);  // none squeezes: the first
    if (alignment) {
      const TrialTrace trace = traceOf(session, *alignment, label);
      if (!trace.samples.empty()) pictures.push_back({turnFigure(trace), "", std::to_string(alignment->trial + 1)});
    }
    const auto trial = representativeTrial(pickups, condition);
    if (!trial) continue;
    const TrialTrace trace = traceOf(session, *trial, label);
    if (trace.samples.empty()) continue;  // recorded without samples
    pictures.push_back({trialFigure(trace), "", std::to_string(trial->trial + 1)});
    if (isShownByTactors(trace)) pictures.push_back({tactorFigure(trace), "", std::to_string(trial->trial + 1)});
  }
  if (auto ticks = tickFigure(session)) pictures.push_back({*std::move(ticks), "", ""});
  return pictures;
}

bool isDrawn(Gnuplot& gnuplot, Picture& picture) {
  try {
    picture.png = gnuplot.plot(picture.figure);
    picture.svg = gnuplot.svg(picture.figure);
    return true;
  } catch (const NothingToDraw&) {
    return false;
  }
}

std::string writeFigure(const std::string& directory, const Picture& picture) {
  const std::string png = directory + "/" + picture.figure.name + ".png";
  for (const auto& [name, content] : picture.figure.data) writeAtomically(directory + "/" + name, content);
  writeAtomically(png, picture.png);
  writeAtomically(directory + "/" + picture.figure.name + ".svg", picture.svg);
  return png;
}

}  // namespace

std::string plotAndWrite(std::vector<Picture>& pictures, const std::string& html_path, const ReportOptions& options,
                         ReportFiles& files) {
  const std::filesystem::path path(html_path);
  const std::string figures_name = path.stem().string() + "_figures";
  files = {html_path, (path.parent_path() / figures_name).string(), {}, {}};
  Gnuplot gnuplot(options.gnuplot, options.interrupted);
  std::erase_if(pictures, [&](Picture& picture) {
    const bool drawn = isDrawn(gnuplot, picture);
    if (!drawn) files.not_drawn.push_back(picture.figure.title);
    return !drawn;
  });
  makeDirectory(files.figures_directory);
  for (const Picture& picture : pictures) files.figures.push_back(writeFigure(files.figures_directory, picture));
  return figures_name;
}

ReportFiles writeReport(const SessionReader& session, const std::string& html_path, const ReportOptions& options) {
  const SessionSummary summary = summariseSession(session);
  const std::vector<TrialRecord> trials = session.trials();
  std::vector<Picture> pictures = wantedPictures(session, summary, trials);
  ReportFiles files;
  const std::string figures_name = plotAndWrite(pictures, html_path, options, files);
  const std::string more =
      htmlNotDrawn(files.not_drawn) + htmlSurvey(session.survey()) + deviceErrorsHtml(deviceErrors(session));
  writeAtomically(html_path, reportHtml(summary, trials, pictures, figures_name, more, options.replay));
  return files;
}

}  // namespace pincer::tasks
