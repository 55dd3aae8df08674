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

constexpr std::array<std::string_view, 4> kShown{"tries", "pickup_time", "alignment_error", "alignment_time"};

std::vector<const PairedRow*> shownRows(const SessionSummary& s) {
  std::vector<const PairedRow*> rows;
  for (const PairedRow& row : s.pairs) {
    const bool is_shown = std::find(kShown.begin(), kShown.end(), findingMeasures()[row.measure].key) != kShown.end();
    if (is_shown && row.test.n >= 2) rows.push_back(&row);
  }
  return rows;
}

std::string measureText(const FindingMeasure& m) { return *m.unit ? fmt::format("{} [{}]", m.label, m.unit) : m.label; }

// "squeezes per sphere picked up: lower with the display for 10 of 12".
std::string whatIsSeen(const std::vector<const PairedRow*>& rows) {
  std::string words;
  for (const PairedRow* row : rows) {
    words += fmt::format("{}{}, lower with the display for {} of {}", words.empty() ? "" : "; ",
                         findingMeasures()[row->measure].label, row->test.lower, row->test.n);
  }
  return words;
}

// Rows of the panel: means, intervals and participants.
double highest(const PairedRow& row) {
  const Averaged averaged = findingMeasures()[row.measure].averaged;
  double high = std::max({intervalOf(row.force, averaged).high, intervalOf(row.cld, averaged).high, 1e-9});
  for (const auto* values : {&row.force_of, &row.cld_of}) {
    for (const double value : *values) high = std::isfinite(value) ? std::max(high, value) : high;
  }
  return high;
}

std::string panelOf(const PairedRow& row, std::size_t index) {
  std::string label = measureText(findingMeasures()[row.measure]);
  label[0] = static_cast<char>(std::toupper(static_cast<unsigned char>(label[0])));
  const std::string own = fmt::format("skip 1 using ($1=={} ? ", index);
  std::string script = fmt::format("set title {}\nset yrange [0:{:.6g}]\n", gnuplotString(label), 1.08 * highest(row));
  script += fmt::format(
      "plot 'people.csv' {}0 : NaN):3:(1):($4-$3) with vectors nohead lw 0.8 lc rgb '#90222222' notitle", own);
  for (const int condition : {0, 1}) {
    const char* colour = conditionColour(static_cast<std::size_t>(condition));
    script += fmt::format(", 'people.csv' {}{} : NaN):{} with points pt 7 ps 1.5 lc rgb '#40{}' notitle", own,
                          condition, condition + 3, colour + 1);
    script +=
        fmt::format(", 'people_means.csv' {}{} : NaN):{}:{}:{} with yerrorbars pt {} ps 2.2 lw 2 lc rgb '{}' notitle",
                    own, condition == 0 ? -0.25 : 1.25, 3 * condition + 2, 3 * condition + 3, 3 * condition + 4,
                    condition ? 5 : 7, colour);
  }
  return script + "\n";
}

}  // namespace

std::optional<Figure> peopleFigure(const SessionSummary& s) {
  const std::vector<const PairedRow*> rows = shownRows(s);
  if (rows.empty()) return std::nullopt;
  PlotTable people{"panel", "participant", "force", "cld"},
      means{"panel", "force", "force_low", "force_high", "cld", "cld_low", "cld_high"};
  std::string panels;
  for (std::size_t i = 0; i < rows.size(); ++i) {
    const PairedRow& row = *rows[i];
    const Averaged averaged = findingMeasures()[row.measure].averaged;
    const Interval force = intervalOf(row.force, averaged), cld = intervalOf(row.cld, averaged);
    for (std::size_t k = 0; k < row.force_of.size(); ++k) people.row(i, k + 1, row.force_of[k], row.cld_of[k]);
    means.row(i, row.force.mean, force.low, force.high, row.cld.mean, cld.low, cld.high);
    panels += panelOf(row, i);
  }
  Figure figure;
  figure.name = "people";
  figure.title = "Each participant in both conditions";
  figure.caption = fmt::format(
      "To see: {}. Small dots: means of one participant, joined by a line. Large marks: means over the participants "
      "with their 95 % "
      "confidence "
      "intervals.",
      whatIsSeen(rows));
  const std::size_t columns = std::min<std::size_t>(2, rows.size()), lines = (rows.size() + columns - 1) / columns;
  figure.height = static_cast<int>(60 + 560 * lines);
  figure.data = {{"people.csv", people.take()}, {"people_means.csv", means.take()}};
  figure.script =
      figurePrelude(figure.name) +
      fmt::format("set multiplot layout {},{}\nset xtics ('force only' 0, 'CLD + force' 1) scale 0\n", lines, columns) +
      "set xrange [-0.6:1.6]\n" + panels + "unset multiplot\n";
  return figure;
}

}  // namespace pincer::tasks
