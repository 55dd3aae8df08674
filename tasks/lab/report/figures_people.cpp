#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cctype>
#include <cmath>
#include <string_view>

#include "pincer/tasks/lab/report/figures.h"
#include "pincer/tasks/run/csv.h"

namespace pincer::tasks {
namespace {

// Measures whose people are drawn.
constexpr std::array<std::string_view, 4> kShown{"tries", "pickup_time", "alignment_error", "alignment_time"};

std::vector<const MeasureRow*> shownRows(const SessionSummary& s) {
  std::vector<const MeasureRow*> rows;
  for (const MeasureRow& row : s.rows) {
    const bool is_shown = std::find(kShown.begin(), kShown.end(), findingMeasures()[row.measure].key) != kShown.end();
    const bool paired = std::any_of(row.tests.begin(), row.tests.end(), [](const PairedTest& t) { return t.n >= 2; });
    if (is_shown && paired) rows.push_back(&row);
  }
  return rows;
}

std::string measureText(const FindingMeasure& m) { return *m.unit ? fmt::format("{} [{}]", m.label, m.unit) : m.label; }

// "squeezes per sphere picked up, lower in CLD + force than in force only for 10 of 12".
std::string whatIsSeen(const SessionSummary& s, const std::vector<const MeasureRow*>& rows) {
  std::string words;
  for (const MeasureRow* row : rows) {
    words += fmt::format("{}{}, lower than in {}", words.empty() ? "" : "; ", findingMeasures()[row->measure].label,
                         s.labels[0]);
    for (std::size_t k = 0; k < row->tests.size(); ++k)
      words +=
          fmt::format("{} in {} for {} of {}", k > 0 ? "," : "", s.labels[k + 1], row->tests[k].lower, row->tests[k].n);
  }
  return words;
}

// Of means, intervals and participants.
double highest(const MeasureRow& row) {
  const Averaged averaged = findingMeasures()[row.measure].averaged;
  double high = 1e-9;
  for (std::size_t c = 0; c < row.means.size(); ++c) {
    const double end = intervalOf(row.means[c], averaged).high;
    high = std::isfinite(end) ? std::max(high, end) : high;
    for (const double value : row.of[c]) high = std::isfinite(value) ? std::max(high, value) : high;
  }
  return high;
}

// Columns of people.csv: panel, participant, condition, value, the next condition's; of people_means.csv: panel,
// condition, mean, its interval.
std::string panelOf(const MeasureRow& row, std::size_t index) {
  std::string label = measureText(findingMeasures()[row.measure]);
  label[0] = static_cast<char>(std::toupper(static_cast<unsigned char>(label[0])));
  std::string script = fmt::format("set title {}\nset yrange [0:{:.6g}]\n", gnuplotString(label), 1.08 * highest(row));
  script += fmt::format(
      "plot 'people.csv' skip 1 using ($1=={} ? $3 : NaN):4:(1):($5-$4) with vectors nohead lw 0.8 lc rgb '#90222222' "
      "notitle",
      index);
  for (std::size_t c = 0; c < row.means.size(); ++c) {
    const char* colour = conditionColour(c);
    const std::string own = fmt::format("skip 1 using ($1=={} && ", index);
    script += fmt::format(", 'people.csv' {}$3=={} ? $3 : NaN):4 with points pt 7 ps 1.5 lc rgb '#40{}' notitle", own,
                          c, colour + 1);
    // at the ends beside the dots, else among them
    const double aside = c == 0 ? -0.25 : c + 1 == row.means.size() ? 0.25 : 0.12;
    script += fmt::format(
        ", 'people_means.csv' {}$2=={} ? $2+{} : NaN):3:4:5 with yerrorbars pt {} ps 2.2 lw 2 lc rgb '{}' notitle", own,
        c, aside, conditionPoint(c), colour);
  }
  return script + "\n";
}

void addRows(const MeasureRow& row, std::size_t panel, PlotTable& people, PlotTable& means) {
  for (std::size_t c = 0; c < row.means.size(); ++c) {
    const Interval interval = intervalOf(row.means[c], findingMeasures()[row.measure].averaged);
    means.row(panel, c, row.means[c].mean, interval.low, interval.high);
    for (std::size_t k = 0; k < row.of[c].size(); ++k)
      people.row(panel, k + 1, c, row.of[c][k], c + 1 < row.of.size() ? row.of[c + 1][k] : NAN);
  }
}

}  // namespace

std::optional<Figure> peopleFigure(const SessionSummary& s) {
  const std::vector<const MeasureRow*> rows = shownRows(s);
  if (rows.empty()) return std::nullopt;
  PlotTable people{"panel", "participant", "condition_index", "value", "in_the_next"},
      means{"panel", "condition_index", "mean", "ci95_low", "ci95_high"};
  std::string panels, tics;
  for (std::size_t c = 0; c < s.labels.size(); ++c)
    tics += fmt::format("{}{} {}", c ? ", " : "", gnuplotTic(s.labels[c]), c);
  for (std::size_t i = 0; i < rows.size(); ++i) {
    addRows(*rows[i], i, people, means);
    panels += panelOf(*rows[i], i);
  }
  Figure figure;
  figure.name = "people";
  figure.title = "Each participant in all conditions";
  figure.caption = fmt::format(
      "To see: {}. Small dots: means of one participant, joined by a line. Large marks: means over the participants "
      "with their 95 % confidence intervals.",
      whatIsSeen(s, rows));
  // more than two labels need the width
  const std::size_t columns = s.labels.size() > 2 ? 1 : std::min<std::size_t>(2, rows.size()),
                    lines = (rows.size() + columns - 1) / columns;
  figure.height = static_cast<int>(60 + 560 * lines);
  figure.data = {{"people.csv", people.take()}, {"people_means.csv", means.take()}};
  figure.script = figurePrelude(figure.name) +
                  fmt::format("set multiplot layout {},{}\nset xtics ({}) scale 0\nset xrange [-0.6:{}.6]\n", lines,
                              columns, tics, s.labels.size() - 1) +
                  panels + "unset multiplot\n";
  return figure;
}

}  // namespace pincer::tasks
