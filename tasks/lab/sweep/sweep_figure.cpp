// The picture of a sweep: a line per value of the second number, small multiples over the
// third; a heat map where two have many values.
#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>

#include "pincer/contact/elementary.h"
#include "pincer/tasks/lab/report/figures.h"
#include "pincer/tasks/lab/sweep/sweep.h"
#include "pincer/tasks/run/csv.h"

namespace pincer::tasks {
namespace {

// Colours of a panel's lines; more lines than colours aren't drawn.
constexpr std::array kLineColours = {palette::kBlue,   palette::kVermillion, palette::kGreen,
                                     palette::kPurple, palette::kOrange,     palette::kInk};
// Lines of a panel, and panels side by side: as many as a page shows legibly, chosen.
constexpr std::size_t kMostLines = kLineColours.size(), kMostColumns = 4;
constexpr double kNoChange = 1e-9;  // of a number: less is drawn as no change

// The values of a parameter, rising; one of none.
std::vector<double> parameterValues(const SweepTable& table, std::size_t parameter) {
  if (parameter >= table.parameters.size()) return {0};
  std::vector<double> values;
  for (const std::vector<double>& point : table.points) values.push_back(point[parameter]);
  std::sort(values.begin(), values.end());
  values.erase(std::unique(values.begin(), values.end()), values.end());
  return values;
}

bool isHeatMap(const SweepTable& table) {
  return table.parameters.size() == 2 && parameterValues(table, 0).size() > 2 &&
         parameterValues(table, 1).size() > kMostLines;
}

// Positive, and a ratio apart rather than a difference.
bool isLogarithmic(const std::vector<double>& values) {
  if (values.size() < 3 || !(values.front() > 0)) return false;
  return values.back() / values.front() > 20 && values[1] / values[0] > 1.05 &&
         (values[1] - values[0]) < 0.3 * (values.back() - values[0]) / static_cast<double>(values.size() - 1);
}

// The borders of the cell about the i-th value: half way to its neighbours.
std::pair<double, double> cellBorders(const std::vector<double>& values, std::size_t i, bool logarithmic) {
  const auto place = [&](std::size_t k) { return logarithmic ? math::log(values[k]) : values[k]; };
  const double here = place(i), step = values.size() < 2 ? 1 : i > 0 ? here - place(i - 1) : place(1) - here;
  const double low = here - 0.5 * step, high = i + 1 < values.size() ? 0.5 * (here + place(i + 1)) : here + 0.5 * step;
  return logarithmic ? std::pair{math::exp(low), math::exp(high)} : std::pair{low, high};
}

// Rows in the order in which lines are drawn; with the borders of their cells.
std::string plottedTable(const SweepTable& table) {
  std::vector<std::size_t> order;
  for (std::size_t i = 0; i < table.points.size(); ++i) {
    if (table.results[i].done) order.push_back(i);
  }
  std::stable_sort(order.begin(), order.end(), [&](std::size_t a, std::size_t b) {
    return std::lexicographical_compare(table.points[a].rbegin(), table.points[a].rend(), table.points[b].rbegin(),
                                        table.points[b].rend());
  });
  const std::vector<double> xs = parameterValues(table, 0), ys = parameterValues(table, 1);
  PlotTable csv;
  for (const std::string& name : table.parameters) csv.add(name);
  for (const std::string& name : table.measures) csv.add(name);
  if (isHeatMap(table)) {
    for (const char* border : {"x_low", "x_high", "y_low", "y_high"}) csv.add(border);
  }
  csv.endRow();
  for (const std::size_t i : order) {
    for (const double value : table.points[i]) csv.add(value);
    for (const double value : table.results[i].values) csv.add(value);
    if (isHeatMap(table)) {
      const auto at = [](const std::vector<double>& values, double x) {
        return static_cast<std::size_t>(std::lower_bound(values.begin(), values.end(), x) - values.begin());
      };
      const auto [x_low, x_high] = cellBorders(xs, at(xs, table.points[i][0]), isLogarithmic(xs));
      const auto [y_low, y_high] = cellBorders(ys, at(ys, table.points[i][1]), isLogarithmic(ys));
      for (const double border : {x_low, x_high, y_low, y_high}) csv.add(border);
    }
    csv.endRow();
  }
  return csv.take();
}

// The axis of a measure: as many digits as tell its tics apart; a change by round-off is drawn as none.
std::string measureAxis(const SweepTable& table, std::size_t measure, const char* axis) {
  double low = std::numeric_limits<double>::infinity(), high = -low;
  for (const CaseResult& result : table.results) {
    if (!result.done || measure >= result.values.size() || !std::isfinite(result.values[measure])) continue;
    low = std::min(low, result.values[measure]);
    high = std::max(high, result.values[measure]);
  }
  const double size = std::max(std::abs(low), std::abs(high));
  if (!(high >= low) || size == 0) return fmt::format("set {0}range [*:*]\nset format {0} '%g'\n", axis);
  if (high - low <= kNoChange * size)
    return fmt::format("set {0}range [{1:.17g}:{2:.17g}]\nset format {0} '%g'\n", axis, low - 0.1 * size,
                       high + 0.1 * size);
  const int digits = std::clamp(static_cast<int>(std::ceil(math::log10(size / (high - low)))) + 2, 3, 12);
  return fmt::format("set {0}range [*:*]\nset format {0} '%.{1}g'\n", axis, digits);
}

std::string parameterAxis(const std::vector<double>& values, const char* axis) {
  if (isLogarithmic(values)) {
    const double aside = math::pow(values.back() / values.front(), 0.04);
    return fmt::format("set logscale {0}\nset {0}range [{1:.17g}:{2:.17g}]\n", axis, values.front() / aside,
                       values.back() * aside);
  }
  const double size = values.back() - values.front(),
               aside = size > 0 ? 0.04 * size : std::max(0.1 * std::abs(values.front()), 1e-9);
  return fmt::format("set {}range [{:.17g}:{:.17g}]\n", axis, values.front() - aside, values.back() + aside);
}

// The lines of a measure at one value of the third parameter.
std::string linePanel(const SweepTable& table, std::size_t measure, std::size_t column, bool has_key) {
  const std::vector<double> lines = parameterValues(table, 1), columns = parameterValues(table, 2);
  std::string script =
      fmt::format("set ylabel {}\n{}set key {}\n", column == 0 ? gnuplotString(table.measures[measure]) : "''",
                  measureAxis(table, measure, "y"), has_key ? "on" : "off");
  if (columns.size() > 1)
    script +=
        fmt::format("set title {}\n", gnuplotString(fmt::format("{} = {:.6g}", table.parameters[2], columns[column])));
  for (std::size_t k = 0; k < lines.size(); ++k) {
    std::string x = "1", title = "notitle";
    if (table.parameters.size() > 1) {
      const std::string own = table.parameters.size() > 2 ? fmt::format(" && $3 == {:.17g}", columns[column]) : "";
      x = fmt::format("($2 == {:.17g}{} ? $1 : NaN)", lines[k], own);
      title = "title " + gnuplotString(fmt::format("{} = {:.6g}", table.parameters[1], lines[k]));
    }
    script +=
        fmt::format("{}data skip 1 using {}:{} with linespoints pt 7 ps 0.8 lw 2 lc rgb '{}' {}", k ? ", " : "plot ", x,
                    table.parameters.size() + 1 + measure, kLineColours[k % kLineColours.size()], title);
  }
  return script + "\n";
}

std::string heatPanel(const SweepTable& table, std::size_t measure) {
  const std::size_t borders = table.parameters.size() + table.measures.size() + 1;
  return fmt::format(
      "set cblabel {}\n{}plot data skip 1 using 1:2:{}:{}:{}:{}:{} with boxxyerror fillstyle solid noborder linecolor "
      "palette notitle\n",
      gnuplotString(table.measures[measure]), measureAxis(table, measure, "cb"), borders, borders + 1, borders + 2,
      borders + 3, table.parameters.size() + 1 + measure);
}

}  // namespace

bool isDrawable(const SweepTable& table) {
  return table.parameters.size() < 3 ||
         (table.parameters.size() == 3 && parameterValues(table, 1).size() <= kMostLines &&
          parameterValues(table, 2).size() <= kMostColumns);
}

Figure sweepFigure(const SweepTable& table) {
  const auto panels = static_cast<std::size_t>(std::count(table.plotted.begin(), table.plotted.end(), true));
  const std::size_t columns = parameterValues(table, 2).size();
  Figure figure;
  figure.name = "sweep";
  figure.title = table.what;
  figure.width = columns > 1 ? static_cast<int>(900 * columns) : 1600;
  figure.height = static_cast<int>(140 + 520 * panels);
  figure.data = {{"sweep.csv", plottedTable(table)}};
  figure.script =
      figurePrelude("sweep") +
      fmt::format("set multiplot layout {},{} title {}\nset grid\nset lmargin 16\nset tmargin 3\nset key {}\n", panels,
                  columns, gnuplotString(table.what),
                  columns > 1 ? "inside top left vertical opaque" : "outside right top vertical") +
      fmt::format("set xlabel {}\n{}set offsets 0, 0, graph 0.06, graph 0.06\n", gnuplotString(table.parameters[0]),
                  parameterAxis(parameterValues(table, 0), "x"));
  if (isHeatMap(table)) {
    figure.script += fmt::format(
        "unset grid\nset offsets\nset ylabel {}\n{}set palette defined (0 '#440154', 1 '#3b528b', 2 '#21918c', 3 "
        "'#5ec962', 4 "
        "'#fde725')\nset rmargin 22\n",
        gnuplotString(table.parameters[1]), parameterAxis(parameterValues(table, 1), "y"));
  }
  bool first = true;
  for (std::size_t m = 0; m < table.measures.size(); ++m) {
    if (!table.plotted[m]) continue;
    for (std::size_t c = 0; c < columns; ++c) {
      const bool has_key = table.parameters.size() > 1 && first && c + 1 == columns;
      figure.script += isHeatMap(table) ? heatPanel(table, m) : linePanel(table, m, c, has_key);
    }
    first = false;
  }
  figure.script += "unset multiplot\n";
  return figure;
}

}  // namespace pincer::tasks
