#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <cstdlib>
#include <numbers>

#include "pincer/contact/elementary.h"
#include "pincer/contact/functions/invariants.h"
#include "pincer/tasks/lab/report/figures.h"
#include "pincer/tasks/run/csv.h"

namespace pincer::tasks {
namespace {

constexpr double kInDegrees = 180 / std::numbers::pi;  // [deg/rad]
constexpr double kTarget = 0.5 * std::numbers::pi;     // of the flat: towards the monitor, W's +y

// A colour '#rrggbb' as gnuplot counts it, half transparent.
unsigned long colourNumber(const char* colour) { return 0x70000000UL + std::strtoul(colour + 1, nullptr, 16); }

// From the flat's normal, B's x axis, to the target [deg].
double flatErrorOf(const SampleRecord& s) {
  const double w = s.q_WB[0], x = s.q_WB[1], y = s.q_WB[2], z = s.q_WB[3];
  const double angle = math::atan2(2 * (x * y + w * z), 1 - 2 * (y * y + z * z));
  return kInDegrees * std::remainder(angle - kTarget, 2 * std::numbers::pi);
}

}  // namespace

Figure alignmentFigure(const SessionSummary& summary, const std::vector<TrialRecord>& trials) {
  Figure figure;
  figure.name = "alignment";
  figure.title = "Alignment: error and time per condition";
  figure.caption =
      "Each dot a trial: left, how far from the monitor the flat was when the participant answered; right, the time "
      "until then. "
      "Bars: means over all trials. Open circles: time-outs. To see: few large errors make the mean; most answers lie "
      "closer.";
  PlotTable table{"trial", "participant", "condition", "position", "error_deg", "time_s", "timeout", "colour"},
      means{"position", "error_deg", "time_s"};
  std::string tics;
  for (std::size_t c = 0; c < summary.conditions.size(); ++c) {
    double error = 0, time = 0;
    int n = 0, answered = 0;
    tics += fmt::format("{}{} {}", c ? ", " : "", gnuplotTic(summary.labels[c]), c);
    for (const TrialRecord& t : trials) {
      if (t.condition != summary.conditions[c] || t.outcome == "fault") continue;
      const bool timeout = t.outcome == "timeout";
      // so that dots don't hide each other
      const double aside = 0.5 * std::fmod(0.618 * static_cast<double>(t.trial), 1.0) - 0.25;
      table.row(t.trial + 1, t.participant + 1, t.condition, static_cast<double>(c) + aside, kInDegrees * t.error,
                t.duration, timeout ? 1 : 0, colourNumber(conditionColour(c)));
      time += t.duration;
      ++n;
      if (timeout) continue;
      error += kInDegrees * std::abs(t.error);
      ++answered;
    }
    means.row(c, answered > 0 ? error / answered : NAN, n > 0 ? time / n : NAN);
  }
  figure.data = {{"alignment.csv", table.take()}, {"alignment_means.csv", means.take()}};
  const auto panel = [&](const char* place, const char* label, const char* value, const char* mean, const char* range) {
    return fmt::format(
        "{}\nset ylabel '{}'\n{}\nset xtics ({}) scale 0\nset xrange [-0.5:{}.5]\n"
        "plot data skip 1 using 4:($7==0 ? {} : NaN):8 with points pt 7 ps 1.1 lc rgb variable notitle, "
        "'' skip 1 using 4:($7==1 ? {} : NaN):8 with points pt 6 ps 1.4 lc rgb variable notitle, "
        "'alignment_means.csv' skip 1 using 1:{}:(0.35) with xerrorbars pt 0 lw 3 lc rgb '{}' notitle\n",
        place, label, range, tics, summary.conditions.size() - 1, value, value, mean, palette::kInk);
  };
  figure.script = figurePrelude("alignment") + "set multiplot layout 1,2\n" +
                  panel("set lmargin 9", "size of the error [deg]", "abs($5)", "2", "set yrange [0:*]") +
                  panel("set lmargin 9", "time [s]", "$6", "3", "set yrange [0:*]") + "unset multiplot\n";
  return figure;
}

Figure turnFigure(const TrialTrace& trace) {
  PINCER_ASSERT(!trace.samples.empty());
  Figure figure;
  figure.name = "turn_" + fileNamePart(trace.trial.condition);
  figure.title = fmt::format("{}: a trial of alignment", trace.label);
  figure.caption = fmt::format(
      "Trial {}, participant {}. Top: direction of the flat from the monitor; bottom: normal forces of both fingers.",
      trace.trial.trial + 1, trace.trial.participant + 1);
  PlotTable table{"time_s", "flat_deg", "f0_normal_N", "f1_normal_N"};
  const double start = trace.samples.front().time;
  for (const SampleRecord& s : trace.samples) {
    table.row(s.time - start, flatErrorOf(s), s.fingers[0].normal_force, s.fingers[1].normal_force);
  }
  figure.data = {{figure.name + ".csv", table.take()}};
  figure.script =
      figurePrelude(figure.name) +
      fmt::format(
          "set multiplot layout 2,1\nset lmargin 10\nset xrange [0:{:.3f}]\nset ylabel 'flat from target [deg]'\n"
          "set yrange [-190:190]\nset ytics 90\nplot 0 with lines dt 2 lc rgb '{}' notitle, "
          "data skip 1 using 1:2 with points pt 7 ps 0.3 lc rgb '{}' notitle\n"
          "set ylabel 'normal force [N]'\nset yrange [0:*]\nset ytics autofreq\nset xlabel 'time in the trial [s]'\n"
          "plot data skip 1 using 1:3 with lines lc rgb '{}' title '{}', '' skip 1 using 1:4 with lines lc rgb '{}' "
          "title "
          "'{}'\nunset multiplot\n",
          std::max(1e-3, trace.samples.back().time - start), palette::kGrey, palette::kInk, kFingers[0].colour,
          kFingers[0].name, kFingers[1].colour, kFingers[1].name);
  return figure;
}

}  // namespace pincer::tasks
