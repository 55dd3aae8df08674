// study_report: a psychophysical session as one HTML page with its figures, as report.h does for picking up.
//
//   headline    each participant and the mean with its interval, beside the published figure
//   staircases  the level from trial to trial, one panel per condition
//   psychometric  all answers by level, with the function of most likelihood
//   confusions  shapes shown against shapes named; places: places shown against places named
//   speeds      of finger and tactor, beside the published ranges; times of the stimuli
//   tick_times  how long the recorded ticks took
#pragma once
#include "pincer/tasks/lab/report/report.h"
#include "pincer/tasks/lab/report/study_summary.h"

namespace pincer::tasks {

ReportFiles writeStudyReport(const SessionReader& session, const std::string& html_path,
                             const ReportOptions& options = {});

Figure headlineFigure(const StudySummary& summary);
Figure staircaseFigure(const StudySummary& summary, const std::vector<ResponseRecord>& responses);
Figure psychometricFigure(const StudySummary& summary, const std::vector<ResponseRecord>& responses);
Figure placesFigure(const std::vector<ResponseRecord>& responses);
Figure confusionFigure(const std::vector<ResponseRecord>& responses);
Figure speedFigure(const StudySummary& summary);
Figure timeFigure(const StudySummary& summary);

}  // namespace pincer::tasks
