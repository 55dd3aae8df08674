#include "pincer/tasks/lab/findings/findings_report.h"

#include <fmt/format.h>

#include <cmath>

#include "pincer/contact/io/atomic_file.h"
#include "pincer/tasks/lab/experiments/manipulation_file.h"
#include "pincer/tasks/lab/report/figures.h"
#include "pincer/tasks/lab/report/html_page.h"
#include "pincer/tasks/run/csv.h"

namespace pincer::tasks {
namespace {

std::string interval(const Estimate& e, int digits) {
  if (e.n == 0) return "-";
  const std::string mean = fmt::format("{:.{}f}", e.mean, digits);
  return e.n < 2 ? mean : fmt::format("{} +- {:.{}f}", mean, e.half_width, digits);
}

std::string shareOf(int k, int n) { return fmt::format("{} of {}", k, n); }

std::string directionOf(const FindingResult& r) {
  return r.less >= r.more ? fmt::format("less in {}", shareOf(r.less, r.experiments))
                          : fmt::format("more in {}", shareOf(r.more, r.experiments));
}

std::vector<std::string> rowOf(const FindingMeasure& m, const FindingResult& r) {
  const std::string unit = *m.unit ? fmt::format(" [{}]", m.unit) : "";
  return {m.label + unit,
          m.published,
          interval(r.force, 2),
          interval(r.cld, 2),
          interval(r.difference, 2),
          interval(r.effect, 2),
          shareOf(r.significant_t, r.experiments),
          shareOf(r.significant_w, r.experiments),
          directionOf(r),
          verdictOn(m, r)};
}

std::vector<std::string> heads() {
  return {"measure", "published",  "force only", "CLD + force", "difference",
          "d_z",     "p_t < 0.05", "p_W < 0.05", "direction",   "verdict"};
}

std::string runCost(const FindingsResult& r) {
  if (r.simulated == 0) return "Every experiment was there already.";
  return fmt::format("{:.0f} s of trials in {:.0f} s on {} threads: {:.0f} times real time per processor.", r.simulated,
                     r.wall, r.options.threads, r.simulated / r.processor);
}

std::string designOf(const FindingsResult& r) {
  const FindingsOptions& o = r.options;
  return fmt::format(
      "{} simulated experiments of the primary analysis, {} of each other variant, of {} participants each, in two "
      "conditions: {} spheres "
      "({} frictions) and {} cylinders per participant and condition. Seed {}.{}",
      o.experiments, o.control_experiments, o.participants,
      o.pickups * static_cast<int>(r.study.pickup.frictions.size()), r.study.pickup.frictions.size(), o.alignments,
      o.seed, r.interrupted ? " Interrupted: the tables say how many experiments were whole." : "");
}

// How to read the tables; stands above them.
constexpr const char* kReading =
    "Means with their 95 % intervals (Student t) over the simulated experiments; difference: with the CLD minus "
    "without; d_z: mean over "
    "standard deviation of the participants' differences. \"k of n\": experiments in which the paired test over the "
    "participants is "
    "significant at 0.05, in either direction. A published effect follows when its share, in the published direction, "
    "is certainly "
    "(Wilson, "
    "95 %) more than half; a published absence follows when the share of significant experiments is compatible with "
    "the 5 % of chance. "
    "Time-outs are censored: counts and times are per success.";

// One block per measure, a line per variant: the difference with its interval, in units of the force-only mean.
Figure forestFigure(const FindingsResult& r) {
  constexpr std::array<std::size_t, 4> kShown = {0, 2, 4, 6};  // places in findingMeasures()
  Figure figure;
  figure.name = "findings";
  figure.title = "Every variant beside the primary analysis";
  figure.caption =
      "Difference (CLD + force minus force only) as a share of the force-only mean, with its 95 % interval over the "
      "experiments. From the "
      "left: tries, pickup time, alignment error, alignment time. Intervals of few experiments go on beyond the "
      "borders.";
  figure.width = 2000;
  figure.height = 260 + 90 * static_cast<int>(r.variants.size());
  PlotTable table{"measure", "variant", "row", "share", "low", "high"};
  std::string tics, bare_tics;
  for (std::size_t v = 0; v < r.variants.size(); ++v) {
    const std::size_t row = r.variants.size() - 1 - v;
    tics += fmt::format("{}{} {}", v ? ", " : "", gnuplotString(r.variants[v].name), row);
    bare_tics += fmt::format("{}'' {}", v ? ", " : "", row);
    for (const std::size_t m : kShown) {
      const FindingResult& f = r.variants[v].findings[m];
      const double scale = std::abs(f.force.mean) > 0 ? 100 / std::abs(f.force.mean) : 0;
      const double half = f.difference.n < 2 ? 0 : f.difference.half_width;
      table.row(findingMeasures()[m].key, r.variants[v].name, row, scale * f.difference.mean,
                scale * (f.difference.mean - half), scale * (f.difference.mean + half));
    }
  }
  figure.data = {{"findings.csv", table.take()}};
  figure.script = figurePrelude("findings") +
                  fmt::format(
                      "set yrange [-0.6:{}]\nset xtics rotate by 45 right font ',15'\nset multiplot\nset key "
                      "off\nset grid xtics\nset xrange [-160:160]\n",
                      static_cast<double>(r.variants.size()) - 0.4);
  const char* titles[] = {"tries", "pickup time", "alignment error", "alignment time"};
  for (std::size_t k = 0; k < kShown.size(); ++k) {
    const double left = 0.21 + 0.2 * static_cast<double>(k);
    figure.script += fmt::format(
        "set lmargin at screen {:.3f}\nset rmargin at screen {:.3f}\nset title '{}'\nset xlabel 'change [%]'\n{}\n"
        "set arrow 1 from 0, graph 0 to 0, graph 1 nohead dt 2 lc rgb '#999999'\n"
        "plot data skip 1 using (strcol(1) eq '{}' ? $4 : NaN):3:5:6 with xerrorbars pt 7 ps 1.6 lw 2 lc rgb '{}'\n",
        left, left + 0.18, titles[k], "set ytics (" + (k == 0 ? tics : bare_tics) + ") scale 0",
        findingMeasures()[kShown[k]].key, palette::kBlue);
  }
  figure.script += "unset multiplot\n";
  return figure;
}

std::string variantTable(const VariantResult& variant) {
  std::string html =
      fmt::format("<h2>{}</h2>\n<p>{}; parameters of the participants: {}</p>\n<div class=\"wide\"><table>\n",
                  escaped(variant.name), escaped(variant.what), variant.hash) +
      htmlRow(heads(), "th");
  for (std::size_t m = 0; m < variant.findings.size(); ++m)
    html += htmlRow(rowOf(findingMeasures()[m], variant.findings[m]), "td");
  return html + "</table></div>\n";
}

}  // namespace

std::string findingsText(const FindingsResult& result) {
  std::string text = designOf(result) + "\n" + runCost(result) + "\n";
  for (const VariantResult& variant : result.variants) {
    text += fmt::format("\n{}: {} (parameters {})\n", variant.name, variant.what, variant.hash);
    for (std::size_t m = 0; m < variant.findings.size(); ++m) {
      const auto row = rowOf(findingMeasures()[m], variant.findings[m]);
      text += fmt::format("  {:<38} {:>15}  {:>15}  diff {:>15}  d_z {:>14}  t {:>8}  W {:>8}  {:<15} {}\n", row[0],
                          row[2], row[3], row[4], row[5], row[6], row[7], row[8], row[9]);
    }
  }
  return text;
}

std::string findingsCsv(const FindingsResult& result) {
  CsvTable table{"variant",         "parameters", "measure",     "unit",          "force",         "cld",  "difference",
                 "difference_ci95", "d_z",        "experiments", "significant_t", "significant_w", "less", "more",
                 "verdict"};
  for (const VariantResult& v : result.variants) {
    for (std::size_t m = 0; m < v.findings.size(); ++m) {
      const FindingMeasure& measure = findingMeasures()[m];
      const FindingResult& r = v.findings[m];
      table.row(v.name, v.hash, measure.key, measure.unit, r.force.mean, r.cld.mean, r.difference.mean,
                r.difference.half_width, r.effect.mean, r.experiments, r.significant_t, r.significant_w, r.less, r.more,
                verdictOn(measure, r));
    }
  }
  return table.take();
}

void writeFindingsPage(const FindingsResult& result, const ClaimTable& claims, const std::string& path) {
  std::vector<Picture> pictures;
  if (!result.variants.empty()) pictures.push_back({forestFigure(result), "", ""});
  ReportFiles files;
  const std::string figures = plotAndWrite(pictures, path, {}, files);
  std::string html = htmlHead("Do the published findings follow?", "") + claimTableHtml(claims);
  makeDirectory(files.figures_directory);
  writeAtomically(files.figures_directory + "/claims.csv", claimTableCsv(claims));
  if (!result.variants.empty()) {
    writeAtomically(files.figures_directory + "/table.csv", findingsCsv(result));
    html += fmt::format("<p>{}</p>\n<p>{}</p>\n<p class=\"note\">{}</p>\n", escaped(designOf(result)),
                        escaped(runCost(result)), escaped(kReading));
  }
  for (std::size_t v = 0; v < result.variants.size(); ++v) {
    html += variantTable(result.variants[v]);
    if (v == 0) html += htmlFigure(pictures[0], figures);
  }
  SessionInfo info;
  info.protocol_json = studyFile(result.study);
  writeAtomically(path, html + htmlFoot(info));
}

}  // namespace pincer::tasks
