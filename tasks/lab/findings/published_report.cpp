// The published figures of the studies with one finger: for a terminal, for machines, for the page.
#include <fmt/format.h>

#include <cmath>

#include "pincer/tasks/lab/findings/published_figures.h"
#include "pincer/tasks/lab/report/figures.h"
#include "pincer/tasks/lab/report/html_page.h"
#include "pincer/tasks/run/csv.h"

namespace pincer::tasks {
namespace {

std::string publishedRange(const PublishedFigure& f) {
  return f.low < f.high ? fmt::format("{:g} to {:g}", f.low, f.high) : fmt::format("{:.3g}", f.low);
}

std::string meanText(const PublishedFigure& f) {
  if (f.mean.n == 0) return "-";
  const std::string bound = 2 * f.unsettled > f.experiments ? "beyond " : "";
  return f.mean.n < 2 ? fmt::format("{}{:.2f}", bound, f.mean.mean)
                      : fmt::format("{}{:.2f} +- {:.2f}", bound, f.mean.mean, f.mean.half_width);
}

std::vector<std::string> figureRow(const PublishedFigure& f) {
  return {f.study,     fmt::format("{} [{}]", f.label, f.unit),          publishedRange(f),
          meanText(f), fmt::format("{} of {}", f.within, f.experiments), verdictOn(f)};
}

std::vector<std::string> orderRow(const PublishedOrder& o) {
  return {o.study, fmt::format("{} < {}", o.lower, o.higher), fmt::format("{} of {}", o.holds, o.experiments),
          fmt::format("{} of {}", o.significant, o.experiments), verdictOn(o)};
}

std::vector<std::string> figureHeads() { return {"study", "figure", "published", "pincer", "published within", "verdict"}; }
std::vector<std::string> orderHeads() { return {"study", "published order", "the same order", "p_t < 0.05", "verdict"}; }

constexpr const char* kPublishedNote =
    "Means with their 95 % intervals (Student t) over the simulated experiments. \"Published within\": experiments in which the published "
    "figure lies in the 95 % interval over that experiment's participants (of a range: the mean lies in it); it follows when the share "
    "that "
    "misses it is compatible with the 5 % of chance. An order follows when it holds in certainly (Wilson, 95 %) more than half of the "
    "experiments; p_t: paired over the participants.";

}  // namespace

std::string publishedText(const PublishedFindings& findings) {
  std::string text = "\nPublished figures of the studies with one finger\n";
  for (const PublishedFigure& f : findings.figures) {
    const auto row = figureRow(f);
    text += fmt::format("  {:<26} {:<46} {:>9}  {:>16}  within {:>8}  {}\n", row[0], row[1], row[2], row[3], row[4], row[5]);
  }
  for (const PublishedOrder& o : findings.orders) {
    const auto row = orderRow(o);
    text += fmt::format("  {:<26} {:<72} {:>8}  t {:>8}  {}\n", row[0], row[1], row[2], row[3], row[4]);
  }
  for (const std::string& line : findings.fingerprints) text += fmt::format("  parameters of {}\n", line);
  return text;
}

std::string publishedCsv(const PublishedFindings& findings) {
  CsvTable table{"study", "figure",      "unit",   "published_low", "published_high", "mean",
                 "ci95",  "experiments", "within", "unsettled",     "verdict"};
  for (const PublishedFigure& f : findings.figures) {
    table.row(f.study, f.key, f.unit, f.low, f.high, f.mean.mean, f.mean.half_width, f.experiments, f.within, f.unsettled, verdictOn(f));
  }
  return table.take();
}

std::string publishedOrdersCsv(const PublishedFindings& findings) {
  CsvTable table{"study", "lower", "higher", "experiments", "holds", "significant", "verdict"};
  for (const PublishedOrder& o : findings.orders)
    table.row(o.study, o.lower, o.higher, o.experiments, o.holds, o.significant, verdictOn(o));
  return table.take();
}

std::string publishedHtml(const PublishedFindings& findings) {
  std::string html =
      "<h2>Published figures of the studies with one finger</h2>\n<div class=\"wide\"><table>\n" + htmlRow(figureHeads(), "th");
  for (const PublishedFigure& f : findings.figures) html += htmlRow(figureRow(f), "td");
  html += "</table></div>\n<div class=\"wide\"><table>\n" + htmlRow(orderHeads(), "th");
  for (const PublishedOrder& o : findings.orders) html += htmlRow(orderRow(o), "td");
  html += fmt::format("</table></div>\n<p class=\"note\">{}</p>\n<p>Parameters of the participants:", escaped(kPublishedNote));
  for (const std::string& line : findings.fingerprints) html += " " + escaped(line) + ";";
  html.back() = '.';
  return html + "</p>\n";
}

Figure publishedForest(const PublishedFindings& findings) {
  Figure figure;
  figure.name = "published";
  figure.title = "pincer over the published figure";
  figure.caption =
      "Mean over the simulated experiments divided by the published figure (of a range: its middle), with its 95 % interval; grey: the "
      "published range. Open: the staircases ended before they had found a threshold.";
  figure.width = 2000;
  figure.height = 240 + 60 * static_cast<int>(findings.figures.size());
  PlotTable table{"figure", "row", "ratio", "low", "high", "range_low", "range_high", "unsettled"};
  std::string tics;
  for (std::size_t i = 0; i < findings.figures.size(); ++i) {
    const PublishedFigure& f = findings.figures[i];
    const std::size_t row = findings.figures.size() - 1 - i;
    const double published = 0.5 * (f.low + f.high), half = f.mean.n < 2 ? 0 : f.mean.half_width;
    tics += fmt::format("{}{} {}", i ? ", " : "", gnuplotString(fmt::format("{}: {}", f.study, f.label)), row);
    if (f.mean.n == 0) continue;
    table.row(f.key, row, f.mean.mean / published, std::max(0.01, (f.mean.mean - half) / published), (f.mean.mean + half) / published,
              f.low / published, f.high / published, static_cast<std::int64_t>(2 * f.unsettled > f.experiments));
  }
  figure.data = {{"published.csv", table.take()}};
  figure.script = figurePrelude("published") +
                  fmt::format(
                      "set yrange [-0.6:{}]\nset lmargin at screen 0.42\nset key off\nset grid xtics\nset logscale x\nset xrange "
                      "[0.1:20]\nset xlabel 'pincer / published'\nset ytics ({}) scale 0 font ',15'\n"
                      "set arrow 1 from 1, graph 0 to 1, graph 1 nohead dt 2 lc rgb '{}'\n",
                      static_cast<double>(findings.figures.size()) - 0.4, tics, palette::kInk) +
                  fmt::format(
                      "plot data skip 1 using 6:2:($7-$6):(0) with vectors nohead lw 8 lc rgb '#cccccc', "
                      "data skip 1 using 3:2:4:5:(0) with xerrorbars pt 0 lw 2 lc rgb '{0}', "
                      "data skip 1 using ($8 == 0 ? $3 : NaN):2 with points pt 7 ps 1.6 lc rgb '{0}', "
                      "data skip 1 using ($8 == 1 ? $3 : NaN):2 with points pt 6 ps 1.6 lw 2 lc rgb '{0}'\n",
                      palette::kBlue);
  return figure;
}

}  // namespace pincer::tasks
