#include "pincer/tasks/judge/bench/sweep_plot.h"

#include <fmt/format.h>

#include <array>
#include <filesystem>

#include "pincer/contact/error.h"
#include "pincer/contact/io/atomic_file.h"
#include "pincer/tasks/lab/report/figures.h"
#include "pincer/tasks/lab/report/gnuplot.h"
#include "pincer/tasks/run/csv.h"

namespace pincer::tasks {
namespace {

constexpr double kTravel = 1e3 * 0.1 * kBenchTick;  // of the finger in a tick [mm]

std::string tableOf(const std::vector<NamedTrace>& traces) {
  CsvTable table;
  table.add("tick");
  for (const NamedTrace& t : traces) {
    for (const char* column : {"place_m", "gap_m", "n_x", "n_y", "n_z"})
      table.add(fmt::format("{}_{}", fileNamePart(t.name), column));
  }
  table.endRow();
  for (std::size_t i = 0; i < traces.front().trace.place.size(); ++i) {
    table.add(i);
    for (const NamedTrace& t : traces) {
      table.add(t.trace.place[i]);
      table.add(t.trace.phi[i]);
      for (int k = 0; k < 3; ++k) table.add(t.trace.n[i][k]);
    }
    table.endRow();
  }
  return table.take();
}

// Above the place itself; below, how far each is from the first, where facets show as saw teeth.
std::string scriptOf(const std::string& object, const std::vector<NamedTrace>& traces) {
  // Colours of the lines, in the order of the traces.
  constexpr std::array<const char*, 4> kColours = {palette::kBlue, palette::kGreen, palette::kOrange,
                                                   palette::kVermillion};
  std::string place = "plot ", difference = "plot ";
  for (std::size_t i = traces.size(); i-- > 0;) {  // the first last, on top
    const std::size_t column = 2 + 5 * i;
    const std::string style = fmt::format("with lines lw {} lc rgb '{}' title {}", i == 0 ? 1.6 : 1.0,
                                          kColours[i % kColours.size()], gnuplotString(traces[i].name));
    place += fmt::format("data skip 1 using (${}*{}):(1e3*${}) {}{}", 1, kTravel, column, style, i ? ", " : "\n");
    if (i > 0)
      difference +=
          fmt::format("data skip 1 using (${}*{}):(1e3*(${}-$2)) {}{}", 1, kTravel, column, style, i > 1 ? ", " : "\n");
  }
  return figurePrelude(object) +
         "set multiplot\nset lmargin 10\nset rmargin 3\nset size 1,0.56\nset origin 0,0.44\nset xlabel ''\n" +
         fmt::format("set ylabel 'contact on the finger [mm]'\nset label 1 {} at graph 0.02,0.9 textcolor rgb '{}'\n",
                     gnuplotString(object), palette::kInk) +
         place +
         "unset label 1\nunset key\nset size 1,0.46\nset origin 0,0\nset xlabel 'way of the fingertip [mm]'\nset "
         "ylabel 'off smooth "
         "[mm]'\n" +
         difference + "unset multiplot\n";
}

}  // namespace

void writeSweep(const std::string& directory, const std::string& object, const std::vector<NamedTrace>& traces) {
  std::error_code error;
  std::filesystem::create_directories(directory, error);
  if (error) throw InputError(fmt::format("--out {}: can't make this directory: {}.", directory, error.message()));
  Figure figure;
  figure.name = fileNamePart(object);
  figure.width = 1700;
  figure.height = 1100;
  figure.data = {{figure.name + ".csv", tableOf(traces)}};
  figure.script = scriptOf(figure.name, traces);
  writeAtomically(directory + "/" + figure.name + ".csv", figure.data.front().second);
  writeAtomically(directory + "/" + figure.name + ".png", Gnuplot().plot(figure));
}

}  // namespace pincer::tasks
