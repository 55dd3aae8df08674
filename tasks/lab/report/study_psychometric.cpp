// All answers of a condition, whoever gave them, as a psychometric function: a second way to the threshold, which uses
// every trial and not only the staircases' reversals.
#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <map>
#include <optional>

#include "pincer/contact/elementary.h"
#include "pincer/tasks/lab/report/figures.h"
#include "pincer/tasks/lab/report/study_report.h"
#include "pincer/tasks/lab/study/psychometric.h"
#include "pincer/tasks/run/csv.h"

namespace pincer::tasks {
namespace {

constexpr double kGuess = 0.5, kStaircasePoint = 0.70710678118654752;  // two intervals; where 1-up 2-down settles
constexpr int kCurvePoints = 200;  // of a drawn curve, for one that looks smooth; chosen

// Levels that staircases with ratios visit are spread evenly over their logarithm, and so is the sigmoid.
struct LevelAxis {
  bool logarithmic = false;
  double of(double level) const { return logarithmic ? math::log(level) : level; }
  double level(double x) const { return logarithmic ? math::exp(x) : x; }
};

std::vector<LevelCount> countsOf(const StudyCondition& condition, const std::vector<ResponseRecord>& responses,
                                 const LevelAxis& axis) {
  std::map<double, LevelCount> counts;
  for (const ResponseRecord& r : responses) {
    if (r.condition != condition.name || r.outcome != "answered") continue;
    LevelCount& count = counts[r.level];
    count.level = axis.of(r.level);
    ++count.trials;
    count.right += r.correct == 1;
  }
  std::vector<LevelCount> list;
  for (const auto& [level, count] : counts) list.push_back(count);
  return list;
}

void addCurve(PlotTable& curve, const std::string& name, std::size_t k, const PsychometricFit& fit,
              const std::vector<LevelCount>& counts, const LevelAxis& axis, double scale) {
  for (int i = 0; i <= kCurvePoints; ++i) {
    const double x = counts.front().level + (counts.back().level - counts.front().level) * i / kCurvePoints;
    curve.row(name, k, scale * axis.level(x), fit.function.at(x));
  }
  curve.endRow();  // an empty line breaks gnuplot's
}

std::string levelPanel(const StudySummary& s, std::size_t k, const std::optional<PsychometricFit>& fit,
                       const LevelAxis& axis) {
  std::string script =
      fmt::format("set title {} offset 0,-0.5\nset xlabel 'level [{}]'\nset ylabel 'right answers [-]'\n",
                  gnuplotString(s.conditions[k].name), s.headline.level_unit);
  script += fmt::format(
      "plot data skip 1 using ($2=={0} ? $3 : NaN):4:(0.15 + 0.25 * sqrt($5)) with points pt 7 ps variable lc rgb "
      "'#90{1}'",
      k, palette::kBlue + 1);
  if (fit) {
    script += fmt::format(", 'psychometric_curves.csv' skip 1 using ($2=={} ? $3 : NaN):4 with lines lw 2 lc rgb '{}'",
                          k, palette::kBlue);
    script += fmt::format(", {} with lines dt 2 lw 1.2 lc rgb '{}'", kStaircasePoint, palette::kInk);
    script += fmt::format(", '+' using ({}):({}) every ::::0 with points pt 2 ps 2 lw 2 lc rgb '{}'",
                          s.headline.level_scale * axis.level(fit->threshold), kStaircasePoint, palette::kInk);
  }
  return script + "\n";
}

}  // namespace

Figure psychometricFigure(const StudySummary& s, const std::vector<ResponseRecord>& responses) {
  const LevelAxis axis{s.info.task == "smoothness-discrimination"};
  PlotTable points{"condition", "condition_index", "level", "right_share", "trials"},
      curves{"condition", "condition_index", "level", "right_share"};
  PlotTable fits{"condition", "threshold_at_70.7_percent", "ci95_low", "ci95_high", "spread", "lapse_rate"};
  const std::size_t columns = std::min<std::size_t>(3, s.conditions.size()),
                    rows = (s.conditions.size() + columns - 1) / columns;
  Figure figure;
  std::string panels, words;
  for (std::size_t k = 0; k < s.conditions.size(); ++k) {
    const std::vector<LevelCount> counts = countsOf(s.conditions[k], responses, axis);
    if (counts.empty()) continue;  // gnuplot refuses a plot of nothing
    for (const LevelCount& c : counts)
      points.row(s.conditions[k].name, k, s.headline.level_scale * axis.level(c.level),
                 static_cast<double>(c.right) / c.trials, c.trials);
    std::optional<PsychometricFit> fit;
    if (counts.size() >= 2) fit = fitPsychometric(counts, Sigmoid::kNormal, kGuess, kStaircasePoint);
    if (fit) {
      const auto shown = [&](double x) { return s.headline.level_scale * axis.level(x); };
      fits.row(s.conditions[k].name, shown(fit->threshold), shown(fit->interval.low), shown(fit->interval.high),
               fit->function.beta, fit->function.lambda);
      addCurve(curves, s.conditions[k].name, k, *fit, counts, axis, s.headline.level_scale);
      words += fmt::format("{}{}: {:.3g} [{:.3g}, {:.3g}]", words.empty() ? "" : "; ", s.conditions[k].name,
                           shown(fit->threshold), shown(fit->interval.low), shown(fit->interval.high));
    }
    panels += levelPanel(s, k, fit, axis);
  }
  figure.name = "psychometric";
  figure.title = "Psychometric functions";
  figure.height = static_cast<int>(150 + 420 * rows);
  figure.caption = fmt::format(
      "Share of right answers at each level, all participants together (areas: numbers of trials), and the cumulative "
      "normal function of "
      "most "
      "likelihood, with guesses of 50 % and lapses up to 6 %. Cross: its point of 70.7 % [{}] with the profile "
      "likelihood's 95 % interval, "
      "which "
      "takes all answers for one person's: {}.",
      s.headline.level_unit, words);
  figure.data = {{"psychometric.csv", points.take()},
                 {"psychometric_curves.csv", curves.take()},
                 {"psychometric_fits.csv", fits.take()}};
  figure.script = figurePrelude(figure.name) + "unset key\nset tics font ',15'\nset yrange [0:1.05]\n" +
                  (axis.logarithmic ? "set logscale x\n" : "") +
                  fmt::format("set multiplot layout {},{}\n", rows, columns) + panels + "unset multiplot\n";
  return figure;
}

}  // namespace pincer::tasks
