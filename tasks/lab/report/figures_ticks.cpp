#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <map>

#include "pincer/contact/elementary.h"
#include "pincer/tasks/lab/report/figures.h"
#include "pincer/tasks/run/csv.h"

namespace pincer::tasks {

namespace {

constexpr double kBinsPerDecade = 60;  // of a histogram over logarithms: 4 % wide

std::vector<double> tickTimes(const SessionReader& session) {
  std::vector<double> times;  // [us]
  session.forEachSample({}, [&](const SampleRecord& s) {
    if (std::isfinite(s.tick_us) && s.tick_us > 0) times.push_back(s.tick_us);
  });
  return times;
}

std::string histogramCsv(const std::vector<double>& times) {
  std::map<long, long> bins;
  for (const double t : times) ++bins[std::lround(std::floor(kBinsPerDecade * math::log10(t)))];
  PlotTable table{"from_us", "to_us", "ticks", "share_percent"};
  const auto edge = [](long bin) { return math::pow(10, static_cast<double>(bin) / kBinsPerDecade); };
  for (const auto& [bin, ticks] : bins) {
    table.row(edge(bin), edge(bin + 1), ticks, 100 * static_cast<double>(ticks) / static_cast<double>(times.size()));
  }
  return table.take();
}

struct Percentile {
  const char* label;
  double share;
};
// Shares of the ticks that have a line [-]; 1.0: the longest of all.
constexpr Percentile kPercentiles[] = {{"median", 0.5}, {"99 % ≤", 0.99}, {"99.9 % ≤", 0.999}, {"largest", 1.0}};

std::string threeDigits(double value) {
  return value < 1000 ? fmt::format("{:.3g}", value) : fmt::format("{:.0f}", value);
}

// Labels step down the page, above the bars, so that close percentiles don't overprint each
// other; in the right half they end at the line.
std::string percentileLines(const std::vector<double>& times, double middle) {
  std::string script;
  double height = 0.96;
  for (const Percentile& p : kPercentiles) {
    const double t = percentile(times, p.share);
    script += fmt::format("set arrow from {0}, graph 0 to {0}, graph {1} nohead front lw 0.8 dt 2 lc rgb '{2}'\n", t,
                          height, palette::kInk);
    script += fmt::format("set label '{} {} µs' at {}, graph {} {} front textcolor rgb '{}' font ',18'\n", p.label,
                          threeDigits(t), t, height,
                          t > middle ? "right offset character -0.5,0" : "left offset character 0.5,0", palette::kInk);
    height -= 0.065;
  }
  return script;
}

// Several in each decade where the range is short, else one.
std::string timeTics(double least, double most) {
  const std::vector<double> digits =
      most < 100 * least ? std::vector<double>{1, 1.5, 2, 3, 4, 5, 7} : std::vector<double>{1};
  std::string tics;
  for (double decade = 1e-2; decade < 1e7; decade *= 10) {
    for (const double digit : digits)
      tics += fmt::format("{}'{:g}' {}", tics.empty() ? "" : ", ", digit * decade, digit * decade);
  }
  return fmt::format("set xtics ({})\n", tics);
}

std::string percentilesCsv(const std::vector<double>& times) {
  PlotTable table{"share", "tick_us"};
  for (const Percentile& p : kPercentiles) table.row(p.share, percentile(times, p.share));
  return table.take();
}

}  // namespace

std::optional<Figure> tickFigure(const SessionReader& session) {
  const std::vector<double> times = tickTimes(session);
  if (times.empty()) return std::nullopt;
  const auto [least, most] = std::minmax_element(times.begin(), times.end());
  const double smallest_share = 100 / static_cast<double>(times.size());
  Figure figure;
  figure.name = "tick_times";
  figure.title = "Time that a tick took";
  figure.caption = fmt::format(
      "Share of {} recorded ticks per bin, both axes logarithmic. A tick at 1 kHz may take 1000 µs.", times.size());
  figure.height = 800;
  figure.data = {{"tick_times.csv", histogramCsv(times)}, {"tick_times_percentiles.csv", percentilesCsv(times)}};
  figure.script = figurePrelude(figure.name) + percentileLines(times, std::sqrt(*least * *most)) +
                  timeTics(*least, *most) +
                  fmt::format(
                      "set logscale xy\nset xrange [{0}:{1}]\nset yrange [{2}:2e4]\nset xlabel 'tick time [µs]'\nset "
                      "ylabel 'share of ticks [%]'\n"
                      "set ytics ('100' 100, '10' 10, '1' 1, '0.1' 0.1, '0.01' 0.01, '0.001' 0.001, '0.0001' 0.0001)\n"
                      "unset key\nset style fill solid 0.55 noborder\n"
                      "plot data skip 1 using (sqrt($1*$2)):4:1:2:({2}):4 with boxxyerror lc rgb '{3}'\n",
                      *least / 1.2, *most * 1.6, 0.5 * smallest_share, palette::kBlue);
  return figure;
}

}  // namespace pincer::tasks
