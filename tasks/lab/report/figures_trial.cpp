#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>

#include "pincer/contact/functions/invariants.h"
#include "pincer/tasks/lab/report/figures.h"
#include "pincer/tasks/run/csv.h"

namespace pincer::tasks {

namespace {

constexpr int kTouchingLevel = 1, kSlidingLevel = 2;  // bits of FingerRecord::flags
struct EventStyle {
  const char *kind, *label, *colour;
  int mark;  // gnuplot's point type
};
// From the bottom row of the event panel up.
constexpr EventStyle kEventStyles[] = {
    {"squeeze", "squeeze", palette::kBlue, 7},     {"lift", "lift", palette::kGreen, 9},
    {"try_5mm", "try > 5 mm", palette::kGreen, 5}, {"slip", "slip", palette::kOrange, 13},
    {"drop", "drop", palette::kVermillion, 11},    {"gate_trip", "gate trip", palette::kVermillion, 2},
    {"success", "success", palette::kInk, 7},      {"timeout", "time-out", palette::kInk, 6},
};

std::string samplesCsv(const TrialTrace& trace) {
  PlotTable table{"time_s",     "height_mm",   "f0_normal_N",     "f0_tangential_N", "f0_limit_N",
                  "f0_sliding", "f1_normal_N", "f1_tangential_N", "f1_limit_N",      "f1_sliding"};
  const SampleRecord& first = trace.samples.front();
  for (const SampleRecord& s : trace.samples) {
    table.add(s.time - first.time);
    table.add(1e3 * (s.p_WB[2] - first.p_WB[2]));
    for (const FingerRecord& f : s.fingers) {
      table.add(f.normal_force);
      table.add(f.tangential_force);
      table.add(trace.trial.mu_s * f.normal_force);
      table.add((f.flags & kSlidingLevel) && (f.flags & kTouchingLevel) ? 1 : 0);
    }
    table.endRow();
  }
  return table.take();
}

bool happened(const TrialTrace& trace, const EventStyle& style) {
  return std::any_of(trace.events.begin(), trace.events.end(),
                     [&](const EventRecord& e) { return e.kind == style.kind; });
}

std::vector<EventStyle> stylesOf(const TrialTrace& trace) {
  std::vector<EventStyle> styles;
  std::copy_if(std::begin(kEventStyles), std::end(kEventStyles), std::back_inserter(styles),
               [&](const EventStyle& style) { return happened(trace, style); });
  return styles;
}

std::string eventsCsv(const TrialTrace& trace, const std::vector<EventStyle>& styles) {
  PlotTable table{"time_s", "kind", "detail", "row"};
  for (const EventRecord& e : trace.events) {
    const auto style =
        std::find_if(styles.begin(), styles.end(), [&](const EventStyle& s) { return e.kind == s.kind; });
    if (style != styles.end()) table.row(e.time - trace.samples.front().time, e.kind, e.detail, style - styles.begin());
  }
  return table.take();
}

double largestForce(const TrialTrace& trace, double FingerRecord::*force) {
  double value = 0;
  for (const SampleRecord& s : trace.samples) {
    for (const FingerRecord& f : s.fingers) value = std::max(value, f.*force);
  }
  return value;
}

// The axes of the panels. Each upper end leaves a little air, and is never nothing.
struct Ranges {
  double time, height_low, height_high, normal, tangential;
};

Ranges rangesOf(const TrialTrace& trace) {
  const double start = trace.samples.front().time, ground = trace.samples.front().p_WB[2];
  Ranges r{trace.samples.back().time - start, 0, 55, 0, 0};
  for (const EventRecord& e : trace.events) r.time = std::max(r.time, e.time - start);
  for (const SampleRecord& s : trace.samples) {
    r.height_low = std::min(r.height_low, 1e3 * (s.p_WB[2] - ground));
    r.height_high = std::max(r.height_high, 1e3 * (s.p_WB[2] - ground));
  }
  const double normal = largestForce(trace, &FingerRecord::normal_force);
  r.time = std::max(1e-3, 1.01 * r.time);
  r.height_low -= 3;
  r.height_high *= 1.05;
  r.normal = std::max(0.1, 1.1 * normal);
  r.tangential =
      std::max({0.1, 1.1 * trace.trial.mu_s * normal, 1.1 * largestForce(trace, &FingerRecord::tangential_force)});
  return r;
}

const char* forceFormat(double top) { return top < 0.5 ? "%.2f" : "%.1f"; }

// A panel between two heights of the page; all share the time axis, whose numbers stand under the last.
std::string panel(double bottom, double top, bool last) {
  return fmt::format("set bmargin at screen {:.4f}\nset tmargin at screen {:.4f}\n{}\n", bottom, top,
                     last ? "set format x\nset xlabel 'time in the trial [s]'" : "set format x ''\nunset xlabel");
}

std::string eventPanel(const std::vector<EventStyle>& styles) {
  if (styles.empty()) return "";
  std::string tics, plots;
  for (std::size_t i = 0; i < styles.size(); ++i) {
    tics += fmt::format("{}'{}' {}", i ? ", " : "", styles[i].label, i);
    plots += fmt::format("{} events skip 1 using ($4=={} ? $1 : NaN):4 with points pt {} ps 1.8 lc rgb '{}' notitle",
                         i ? "," : "plot", i, styles[i].mark, styles[i].colour);
  }
  return fmt::format("set ytics ({}) scale 0\nset yrange [-0.7:{}.7]\nunset ylabel\n{}\nset ytics autofreq scale 1\n",
                     tics, styles.size() - 1, plots);
}

std::string heightPanel(const Ranges& r) {
  return fmt::format(
      "set ylabel 'height [mm]'\nset yrange [{}:{}]\n"
      "plot 50 with lines dt 2 lw 0.8 lc rgb '{}' title 'goal, 50 mm', 5 with lines dt 3 lw 1.2 lc rgb '{}' title "
      "'try, 5 mm', "
      "data skip 1 using 1:2 with lines lw 1.3 lc rgb '{}' title 'object above its start'\n",
      r.height_low, r.height_high, palette::kGrey, palette::kGrey, palette::kInk);
}

std::string gripPanel(const Ranges& r) {
  return fmt::format(
      "set ylabel 'normal force [N]'\nset yrange [0:{}]\nset format y '{}'\n"
      "plot data skip 1 using 1:3 with lines lw 1.2 lc rgb '{}' title '{}', '' skip 1 using 1:7 with lines lw 1.2 lc "
      "rgb '{}' title '{}'\n",
      r.normal, forceFormat(r.normal), kFingers[0].colour, kFingers[0].name, kFingers[1].colour, kFingers[1].name);
}

std::string slipPanel(std::size_t finger, const Ranges& r) {
  const int column = finger == 0 ? 4 : 8;
  return fmt::format(
      "set ylabel '{0} [N]'\nset yrange [0:{1}]\nset format y '{8}'\n"
      "plot data skip 1 using 1:(${2} > 0 ? {1} : 0) with filledcurves y=0 fs solid 0.3 noborder lc rgb '{3}' title "
      "'sliding', "
      "'' skip 1 using 1:{4} with lines dt 2 lw 1.0 lc rgb '{5}' title 'limit µₛ N', "
      "'' skip 1 using 1:{6} with lines lw 1.3 lc rgb '{7}' title 'tangential force'\n",
      kFingers[finger].name, r.tangential, column + 2, palette::kOrange, column + 1, palette::kGrey, column,
      kFingers[finger].colour, forceFormat(r.tangential));
}

}  // namespace

std::optional<TrialRecord> representativeTrial(const std::vector<TrialRecord>& trials, const std::string& condition) {
  std::vector<TrialRecord> candidates;
  std::copy_if(trials.begin(), trials.end(), std::back_inserter(candidates),
               [&](const TrialRecord& t) { return t.condition == condition && t.outcome != "fault"; });
  if (candidates.empty()) return std::nullopt;
  std::stable_sort(candidates.begin(), candidates.end(),
                   [](const TrialRecord& a, const TrialRecord& b) { return a.squeezes < b.squeezes; });
  const std::int64_t median = candidates[(candidates.size() - 1) / 2].squeezes;
  return *std::find_if(candidates.begin(), candidates.end(),
                       [&](const TrialRecord& t) { return t.squeezes == median; });
}

TrialTrace traceOf(const SessionReader& session, const TrialRecord& trial, const std::string& label) {
  TrialTrace trace{trial, {}, session.events(trial.trial), label};
  session.forEachSample({.trial = trial.trial}, [&](const SampleRecord& s) { trace.samples.push_back(s); });
  return trace;
}

std::string trialWords(const TrialRecord& t) {
  return fmt::format("trial {} (participant {}, µₛ {:.2f})", t.trial + 1, t.participant + 1, t.mu_s);
}

Figure trialFigure(const TrialTrace& trace) {
  PINCER_ASSERT(!trace.samples.empty());
  const std::vector<EventStyle> styles = stylesOf(trace);
  const Ranges r = rangesOf(trace);
  Figure figure;
  figure.name = "trial_" + fileNamePart(trace.trial.condition);
  figure.title = fmt::format("{}: a representative trial", trace.label);
  figure.caption = fmt::format(
      "This is {}; squeezes: {}, the median of the condition. From the top: events; height of the object above its "
      "start; normal "
      "force "
      "of both fingers; tangential force of the index finger and of the thumb with the limit µₛ N (N: normal force) "
      "beyond which a contact "
      "slides, shaded while it does.",
      trialWords(trace.trial), trace.trial.squeezes);
  figure.height = 1900;
  figure.data = {{figure.name + ".csv", samplesCsv(trace)}, {figure.name + "_events.csv", eventsCsv(trace, styles)}};
  figure.script = figurePrelude(figure.name) +
                  fmt::format("events = '{}_events.csv'\nset xrange [0:{}]\n", figure.name, r.time) +
                  "set multiplot\nset lmargin at screen 0.115\nset rmargin at screen 0.98\n"
                  "set grid xtics ytics lt 1 lw 0.5 lc rgb '#e2e2e2'\nset key at graph 0, graph 1.03 left bottom "
                  "horizontal Left reverse\n" +
                  panel(0.895, 0.99, false) + eventPanel(styles) + panel(0.69, 0.855, false) + heightPanel(r) +
                  panel(0.485, 0.65, false) + gripPanel(r) + panel(0.28, 0.445, false) + slipPanel(0, r) +
                  panel(0.07, 0.235, true) + slipPanel(1, r) + "unset multiplot\n";
  return figure;
}

}  // namespace pincer::tasks
