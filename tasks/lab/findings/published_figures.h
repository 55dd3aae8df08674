// published_figures: do the published figures of the five experiments with one finger follow from what people can feel, without tuning?
//
// A simulated experiment is the published design with 12 participants; many of them, each with other participants, tell
//   - a figure's mean over the experiments, with its 95 % interval (Student t), and in how many experiments the published figure lies within the
//     interval of that experiment's own participants: what somebody who repeated it would call the same;
//   - of two figures that were published one below the other, in how many experiments the means are, and in how many a paired t-test over the
//     participants says so (p < 0.05).
// Published: A. J. Doxon, dissertation, University of Utah, 2014. What C1 to C4, the 2-degree edge and the frozen front end are is our reading
// (tasks/lab/experiments/arc_study.h).
#pragma once
#include <string>
#include <vector>

#include "pincer/tasks/lab/report/gnuplot.h"
#include "pincer/tasks/lab/report/study_summary.h"

namespace pincer::tasks {

struct PublishedFigure {
  std::string study, key, label, unit;  // of the shown values
  double low = 0, high = 0;             // published, shown; the same where it isn't a range
  Estimate mean;                        // over the experiments' means, shown
  int experiments = 0;                  // in which somebody had a value
  int within = 0;                       // in which the published figure lies in the interval over the participants; a range: the mean in it
  int unsettled = 0;                    // in which the staircases ended before they had risen to a threshold: the mean is a lower bound

  double ratio() const { return mean.mean / (0.5 * (low + high)); }
};

struct PublishedOrder {
  std::string study, lower, higher;  // labels
  int experiments = 0, holds = 0, significant = 0;
};

struct PublishedFindings {
  std::vector<PublishedFigure> figures;
  std::vector<PublishedOrder> orders;
  std::vector<std::string> fingerprints;  // "study: of its participants' parameters"
};

// Adds what the sessions of one study say, each an experiment. Unfinished ones are left out. Throws InputError for one that can't be read, and where
// two don't have the same design and participants.
void judgeStudy(const std::vector<std::string>& sessions, PublishedFindings& findings);

// "follows", "no: 1.4 times", "no threshold", "too few experiments". A figure follows when the share of experiments that miss it is compatible
// (Wilson, 95 %) with the 5 % of chance; a range when every mean lies in it.
std::string verdictOn(const PublishedFigure& figure);
// "follows" when it holds in certainly (Wilson, 95 %) more than half of the experiments.
std::string verdictOn(const PublishedOrder& order);

std::string publishedText(const PublishedFindings& findings);
std::string publishedCsv(const PublishedFindings& findings);
std::string publishedOrdersCsv(const PublishedFindings& findings);
std::string publishedHtml(const PublishedFindings& findings);
// Each figure over the published one, with its interval.
Figure publishedForest(const PublishedFindings& findings);

}  // namespace pincer::tasks
