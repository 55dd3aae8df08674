#include <fmt/format.h>

#include <cmath>
#include <filesystem>
#include <map>

#include "pincer/contact/error.h"
#include "pincer/contact/io/atomic_file.h"
#include "pincer/tasks/judge/bench/engine/engine_bench.h"
#include "pincer/tasks/lab/report/figures.h"
#include "pincer/tasks/lab/report/gnuplot.h"
#include "pincer/tasks/run/csv.h"

namespace pincer::tasks {
namespace {

const char* colourOf(const std::string& engine) {
  const std::map<std::string, const char*> colours = {{"pincer", palette::kBlue},
                                                      {"Bullet", palette::kVermillion},
                                                      {"MuJoCo", palette::kPurple},
                                                      {"ODE", palette::kGreen},
                                                      {"DART", palette::kOrange}};
  const auto found = colours.find(engine);
  return found == colours.end() ? palette::kGrey : found->second;
}

std::string tableOfRace(const std::vector<Contestant>& contestants, const std::vector<RaceRun>& runs) {
  PlotTable table{"contestant", "name", "step_ms", "tolerance_m", "us_per_simulated_second", "error"};
  for (const RaceRun& run : runs) {
    table.row(run.contestant, std::string_view(contestants[run.contestant].name()), 1e3 * run.step.h,
              run.step.tolerance, run.ok() ? run.point().cost : std::nan(""), run.error);
  }
  return table.take();
}

// One curve per contestant that has a point; the engine's settings differ by their dashes and marks.
std::string curves(const std::vector<Contestant>& contestants, const std::vector<RaceRun>& runs) {
  std::map<std::string, int> seen;
  std::string plot;
  for (std::size_t k = 0; k < contestants.size(); ++k) {
    const int setting = seen[contestants[k].engine]++;
    bool any = false;
    for (const RaceRun& run : runs) any = any || (run.contestant == k && run.ok());
    if (!any) continue;
    plot += fmt::format(
        "{}data skip 1 using ($1=={}?$5:1/0):6 with linespoints lw {} dt {} pt {} ps 1.4 lc rgb '{}' title {}",
        plot.empty() ? "plot " : ", ", k, contestants[k].engine == "pincer" ? 4 : 2, setting + 1, 7 - 2 * (setting % 3),
        colourOf(contestants[k].engine), gnuplotString(contestants[k].name()));
  }
  return plot + "\n";
}

}  // namespace

void plotRace(const std::string& directory, const BenchScene& scene, const std::vector<Contestant>& contestants,
              const std::vector<RaceRun>& runs) {
  std::error_code error;
  std::filesystem::create_directories(directory, error);
  if (error)
    throw InputError(
        fmt::format("{}: can't be created: {}. Give --out a directory that may be.", directory, error.message()));
  Figure figure;
  figure.name = fileNamePart(scene.name);
  figure.width = 1400;
  figure.height = 1000;
  figure.data = {{figure.name + ".csv", tableOfRace(contestants, runs)}};
  figure.script =
      figurePrelude(figure.name) +
      fmt::format(
          "set key outside right center vertical Left reverse samplen 2.5\nset logscale xy\nset format xy '%g'\n"
          "set title {} noenhanced textcolor rgb '{}'\nset xlabel 'processor time per simulated second [µs]'\n"
          "set ylabel {} noenhanced\nset grid xtics ytics\n",
          gnuplotString(scene.name), palette::kInk, gnuplotString(fmt::format("{} [{}]", scene.metric, scene.unit))) +
      curves(contestants, runs);
  writeAtomically(directory + "/" + figure.name + ".csv", figure.data.front().second);
  for (const RaceRun& run : runs) {
    if (run.ok()) return writeAtomically(directory + "/" + figure.name + ".png", Gnuplot().plot(figure));
  }
}

}  // namespace pincer::tasks
