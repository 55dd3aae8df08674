#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "pincer/contact/functions/invariants.h"
#include "pincer/tasks/lab/report/figures.h"
#include "pincer/tasks/run/csv.h"

namespace pincer::tasks {

namespace {

constexpr int kParked = 8;            // bit of FingerRecord::flags
constexpr double kSmallestReach = 3;  // [mm] so that a tactor that stands still looks still

std::string placesCsv(const TrialTrace& trace) {
  PlotTable table{"time_s",
                  "f0_wanted_distal_mm",
                  "f0_wanted_radial_mm",
                  "f0_shown_distal_mm",
                  "f0_shown_radial_mm",
                  "f1_wanted_distal_mm",
                  "f1_wanted_radial_mm",
                  "f1_shown_distal_mm",
                  "f1_shown_radial_mm"};
  for (const SampleRecord& s : trace.samples) {
    table.add(s.time - trace.samples.front().time);
    for (const FingerRecord& f : s.fingers) {
      for (const auto& place : {f.place_wanted_L, f.place_shown_L}) {
        for (const double x : place) table.add(1e3 * x);
      }
    }
    table.endRow();
  }
  return table.take();
}

// The largest coordinate of any place [mm].
double reachOf(const TrialTrace& trace) {
  double reach = kSmallestReach;
  for (const SampleRecord& s : trace.samples) {
    for (const FingerRecord& f : s.fingers) {
      for (const auto& place : {f.place_wanted_L, f.place_shown_L}) {
        for (const double x : place) {
          if (std::isfinite(x)) reach = std::max(reach, 1e3 * std::abs(x));
        }
      }
    }
  }
  return reach;
}

template <class Is>
bool inEverySample(const TrialTrace& trace, Is is) {
  return std::all_of(trace.samples.begin(), trace.samples.end(),
                     [&](const SampleRecord& s) { return std::all_of(s.fingers.begin(), s.fingers.end(), is); });
}

std::string caption(const TrialTrace& trace) {
  std::string text = fmt::format(
      "The same {}. Where each tactor was told to be on its fingerpad, and where it was; the fingertip is at the top.",
      trialWords(trace.trial));
  if (inEverySample(trace, [](const FingerRecord& f) { return !std::isfinite(f.place_shown_L[0]); })) {
    text += " The devices didn't measure the tactors' places.";
  }
  return text;
}

// Distal up, radial to the right. A circle marks where the wanted path starts, a square
// its end: a path may stand still in between.
std::string padPanel(std::size_t finger, double half, std::size_t last) {
  const int column = finger == 0 ? 2 : 6;
  return fmt::format(
      "set title '{0}' textcolor rgb '{7}'\nset xrange [-{1}:{1}]\nset yrange [-{1}:{1}]\n"
      "plot data skip 1 using {3}:{2} with lines lw 2.4 lc rgb '#bbbbbb' title 'wanted', "
      "'' skip 1 using {5}:{4} with lines lw 1.0 lc rgb '{6}' title 'shown', "
      "'' skip 1 every ::0::0 using {3}:{2} with points pt 6 ps 2 lc rgb '{7}' title 'start', "
      "'' skip 1 every ::{8}::{8} using {3}:{2} with points pt 4 ps 2 lc rgb '{7}' title 'end'\n",
      kFingers[finger].name, half, column, column + 1, column + 2, column + 3, kFingers[finger].colour, palette::kInk,
      last);
}

}  // namespace

bool isShownByTactors(const TrialTrace& trace) {
  return !inEverySample(trace, [](const FingerRecord& f) { return (f.flags & kParked) != 0; });
}

Figure tactorFigure(const TrialTrace& trace) {
  PINCER_ASSERT(!trace.samples.empty());
  const double half = 1.1 * reachOf(trace);
  const std::size_t last = trace.samples.size() - 1;
  Figure figure;
  figure.name = "tactor_" + fileNamePart(trace.trial.condition);
  figure.title = fmt::format("{}: tactors on the fingerpads", trace.label);
  figure.caption = caption(trace);
  figure.height = 900;
  figure.data = {{figure.name + ".csv", placesCsv(trace)}};
  figure.script = figurePrelude(figure.name) +
                  "set multiplot layout 1,2\nset size ratio -1\nset grid xtics ytics lt 1 lw 0.5 lc rgb '#e2e2e2'\n" +
                  fmt::format("set xtics {0}\nset ytics {0}\n", half > 6 ? 4 : 1) +
                  "set xlabel 'towards the radial side [mm]'\nset ylabel 'towards the fingertip [mm]'\n" +
                  padPanel(0, half, last) + padPanel(1, half, last) + "unset multiplot\n";
  return figure;
}

}  // namespace pincer::tasks
