#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cctype>
#include <cmath>
#include <map>

#include "pincer/tasks/lab/report/figures.h"
#include "pincer/tasks/run/csv.h"

namespace pincer::tasks {

namespace {

// On the category axis, whose unit is the step from one friction to the next.
constexpr double kWidth = 0.6;        // that the conditions of a friction share, of two
constexpr double kDotsAside = -0.33;  // of a condition's width: the trials' dots stand left of their mean
constexpr double kSpread = 0.4;       // of it that they fill

// From one condition to the next.
double dodgeOf(const SessionSummary& s) {
  return kWidth / static_cast<double>(std::max<std::size_t>(2, s.conditions.size()));
}

double positionOf(const SessionSummary& s, double mu_s, std::size_t condition) {
  const auto friction = std::lower_bound(s.frictions.begin(), s.frictions.end(), mu_s) - s.frictions.begin();
  return static_cast<double>(friction) +
         dodgeOf(s) * (static_cast<double>(condition) - 0.5 * static_cast<double>(s.conditions.size() - 1));
}

std::size_t placeOf(const SessionSummary& s, const std::string& condition) {
  return static_cast<std::size_t>(std::find(s.conditions.begin(), s.conditions.end(), condition) -
                                  s.conditions.begin());
}

std::string meansCsv(const SessionSummary& s, std::size_t m) {
  PlotTable table{"condition", "condition_index", "mu_s",      "position",   "trials",
                  "mean",      "ci95_low",        "ci95_high", "lower_bound"};
  for (const CellSummary& c : s.cells) {
    if (c.allFrictions()) continue;
    const Estimate& e = c.measures[m];
    const Interval interval = intervalOf(e, Averaged::kPositive);
    const std::size_t k = placeOf(s, c.condition);
    table.row(c.condition, k, c.mu_s, positionOf(s, c.mu_s, k), c.trials, e.mean, interval.low,
              c.timeouts > 0 ? e.mean : interval.high, c.timeouts > 0 ? 1 : 0);
  }
  return table.take();
}

// The dots of a cell stand side by side in the order of the trials, so that equal counts don't hide each other.
std::string trialsCsv(const SessionSummary& s, const std::vector<TrialRecord>& trials, std::size_t m) {
  PlotTable table{"trial", "participant", "condition", "condition_index", "mu_s", "position", "outcome", "value"};
  std::map<std::pair<std::size_t, double>, std::vector<TrialRecord>> cells;
  for (const TrialRecord& t : trials) cells[{placeOf(s, t.condition), t.mu_s}].push_back(t);
  for (const auto& [cell, of_cell] : cells) {
    for (std::size_t i = 0; i < of_cell.size(); ++i) {
      const TrialRecord& t = of_cell[i];
      const double share =
          of_cell.size() < 2 ? 0 : static_cast<double>(i) / static_cast<double>(of_cell.size() - 1) - 0.5;
      table.row(t.trial + 1, t.participant + 1, t.condition, cell.first, t.mu_s,
                positionOf(s, t.mu_s, cell.first) + dodgeOf(s) * (kDotsAside + kSpread * share), t.outcome,
                kMeasures[m].of(t));
    }
  }
  return table.take();
}

std::string frictionTics(const SessionSummary& s) {
  std::string tics;
  for (std::size_t i = 0; i < s.frictions.size(); ++i)
    tics += fmt::format("{}'{:.2f}' {}", i ? ", " : "", s.frictions[i], i);
  return fmt::format("set xtics ({}) scale 0\nset xrange [-0.6:{}]\n", tics,
                     static_cast<double>(s.frictions.size()) - 0.4);
}

// Open circles are drawn over the means that are lower bounds.
std::string conditionPlots(const SessionSummary& s, const std::string& name) {
  std::string plots;
  for (std::size_t k = 0; k < s.conditions.size(); ++k) {
    const char* colour = conditionColour(k);
    plots += fmt::format(
        "{} '{}_trials.csv' skip 1 using ($4=={} ? $6 : NaN):8 with points pt 7 ps 1.6 lc rgb '#90{}' notitle",
        k ? "," : "plot", name, k, colour + 1);
    plots += fmt::format(
        ", data skip 1 using ($2=={} ? $4 : NaN):6:7:8 with yerrorbars pt {} ps 2.6 lw 2 lc rgb '{}' title {}", k,
        conditionPoint(k), colour, gnuplotString(s.labels[k]));
    plots += fmt::format(
        ", data skip 1 using ($2=={} && $9==1 ? $4 : NaN):6 with points pt 7 ps 1.3 lc rgb '#ffffff' notitle", k);
  }
  return plots + "\n";
}

// At how many frictions each condition's mean is smaller than the first's.
std::string orderWords(const SessionSummary& s, std::size_t m) {
  if (s.conditions.size() < 2) return "how the means rise or fall with friction";
  std::map<double, std::vector<double>> means;
  for (const CellSummary& c : s.cells) {
    if (!c.allFrictions())
      means.try_emplace(c.mu_s, s.conditions.size(), NAN).first->second[placeOf(s, c.condition)] = c.measures[m].mean;
  }
  std::string words;
  for (std::size_t k = 1; k < s.conditions.size(); ++k) {
    const auto lower =
        std::count_if(means.begin(), means.end(), [k](const auto& at) { return at.second[k] < at.second[0]; });
    words += fmt::format("{} {} at {} of {} frictions", k == 1 ? "the mean of" : ", that of", s.labels[k], lower,
                         means.size());
    if (k == 1) words.insert(words.rfind(" at "), fmt::format(" lies below that of {}", s.labels[0]));
  }
  return words;
}

}  // namespace

const char* conditionColour(std::size_t condition) {
  // Colours of conditions: all but the fingers' green and purple.
  constexpr std::array<const char*, 6> kColours{palette::kBlue,    palette::kVermillion, palette::kOrange,
                                                palette::kSkyBlue, palette::kInk,        palette::kGrey};
  return kColours[condition % kColours.size()];
}

int conditionPoint(std::size_t condition) {
  constexpr std::array<int, 4> kDiscSquareTriangleDiamond{7, 5, 9, 13};  // gnuplot's numbers of filled marks
  return kDiscSquareTriangleDiamond[condition % kDiscSquareTriangleDiamond.size()];
}

std::string figurePrelude(const std::string& name) {
  return fmt::format(
      "set encoding utf8\nset datafile separator comma\nset datafile missing 'nan'\n"
      "set border 3 lw 0.7 lc rgb '{0}'\nset tics nomirror out textcolor rgb '{0}'\n"
      "set grid ytics lt 1 lw 0.5 lc rgb '#e2e2e2'\nset key outside top center horizontal Left reverse samplen 1.5 "
      "textcolor rgb '{0}'\n"
      "set xlabel textcolor rgb '{0}'\nset ylabel textcolor rgb '{0}'\ndata = '{1}.csv'\n",
      palette::kInk, name);
}

std::string fileNamePart(const std::string& text) {
  std::string name = text;
  for (char& c : name) {
    if (!std::isalnum(static_cast<unsigned char>(c)) && c != '-') c = '_';
  }
  return name;
}

Figure measureFigure(const SessionSummary& s, const std::vector<TrialRecord>& trials, std::size_t m) {
  const bool is_time = m == kTime;
  Figure figure;
  figure.name = is_time ? "time" : kMeasures[m].key;
  figure.title = fmt::format("{} per condition and friction", is_time ? "Time" : "Squeezes");
  figure.caption = fmt::format(
      "To see: {}. Small dots: single trials. Large marks: means with their 95 % confidence intervals (Student t, of "
      "the logarithm). A "
      "white "
      "centre marks a lower bound, without an upper end: a trial of the cell timed out.{}",
      orderWords(s, m),
      is_time ? "" : " A squeeze is counted when both normal forces exceed 0.2 N with the intent to lift.");
  figure.data = {{figure.name + ".csv", meansCsv(s, m)}, {figure.name + "_trials.csv", trialsCsv(s, trials, m)}};
  figure.script = figurePrelude(figure.name) + frictionTics(s) +
                  "set xlabel 'friction coefficient µₛ [-]'\nset yrange [0:*]\nset offsets 0, 0, graph 0.03, 0\n" +
                  fmt::format("set ylabel '{}'\n", is_time ? "time of a trial [s]" : "squeezes per trial [-]") +
                  conditionPlots(s, figure.name);
  return figure;
}

}  // namespace pincer::tasks
