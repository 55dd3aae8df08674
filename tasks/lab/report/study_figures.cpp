#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <map>
#include <set>

#include "pincer/tasks/lab/report/figures.h"
#include "pincer/tasks/lab/report/study_report.h"
#include "pincer/tasks/run/csv.h"

namespace pincer::tasks {
namespace {

constexpr double kDotsLeft = -0.16, kDotsWidth = 0.2;  // the participants' dots stand left of their mean, side by side
constexpr double kPublishedAside = 0.22;               // and the published figure right of it

std::string conditionTics(const StudySummary& s) {
  std::string tics;
  for (std::size_t i = 0; i < s.conditions.size(); ++i)
    tics += fmt::format("{}{} {}", i ? ", " : "", gnuplotTic(s.conditions[i].name), i);
  return fmt::format("set xtics ({}) scale 0\nset xrange [-0.6:{}]\n", tics,
                     static_cast<double>(s.conditions.size()) - 0.4);
}

struct SpeedKind {
  const char *name, *colour;
  Estimate StudyCondition::*of;
  double published_low, published_high;  // [mm/s]
};
// Speeds that are drawn, with the ends of the published ones [mm/s].
constexpr std::array<SpeedKind, 2> kSpeeds{{{"finger", palette::kGreen, &StudyCondition::finger_speed, 32, 74},
                                            {"tactor", palette::kPurple, &StudyCondition::tactor_speed, 5, 19}}};

}  // namespace

Figure headlineFigure(const StudySummary& s) {
  PlotTable means{"condition", "position", "mean", "ci95_low", "ci95_high", "published"};
  PlotTable people{"condition", "participant", "position", "value"};
  for (std::size_t k = 0; k < s.conditions.size(); ++k) {
    const StudyCondition& c = s.conditions[k];
    const double x = static_cast<double>(k), scale = s.headline.scale;
    const Interval interval = intervalOf(c.headline, s.headline.averaged);
    means.row(c.name, x, scale * c.headline.mean, scale * interval.low, scale * interval.high, scale * c.published);
  }
  std::map<std::int64_t, std::vector<std::pair<std::size_t, double>>> of_person;
  for (std::size_t k = 0; k < s.conditions.size(); ++k) {
    for (const StudyPerson& person : s.conditions[k].people)
      of_person[person.participant].push_back({k, person.headline});
  }
  for (const auto& [person, values] : of_person) {
    const double share = of_person.size() < 2
                             ? 0.5
                             : static_cast<double>(std::distance(of_person.begin(), of_person.find(person))) /
                                   static_cast<double>(of_person.size() - 1);
    for (const auto& [k, value] : values) {
      people.row(s.conditions[k].name, person + 1, static_cast<double>(k) + kDotsLeft + kDotsWidth * (share - 0.5),
                 s.headline.scale * value);
    }
    people.endRow();  // an empty line breaks gnuplot's from one participant to the next
  }
  Figure figure;
  figure.name = "headline";
  figure.title =
      fmt::format("{}{} per condition", static_cast<char>(std::toupper(s.headline.name[0])), s.headline.name.substr(1));
  figure.caption =
      "Small dots: participants, a line joins one's. Large marks: their mean with its 95 % confidence interval. "
      "Diamonds: the figure "
      "published by Doxon (2014), with people. To see: which intervals reach the diamond beside them.";
  figure.data = {{"headline.csv", means.take()}, {"headline_people.csv", people.take()}};
  const bool wide_range = s.info.task == "smoothness-discrimination";
  figure.script =
      figurePrelude(figure.name) + conditionTics(s) +
      (wide_range ? "set logscale y\nset yrange [1:5000]\n" : "set yrange [0:*]\nset offsets 0, 0, graph 0.05, 0\n") +
      fmt::format("set ylabel {}\n", gnuplotString(fmt::format("{} [{}]", s.headline.name, s.headline.unit))) +
      fmt::format(
          "plot 'headline_people.csv' skip 1 using 3:4 with linespoints pt 7 ps 1.4 lw 0.6 lc rgb '#90{}' title "
          "'participant', "
          "data skip 1 using 2:3:4:5 with yerrorbars pt 7 ps 2.4 lw 2 lc rgb '{}' title 'mean of pincer''s "
          "participants', "
          "data skip 1 using ($2+{}):6 with points pt 13 ps 3 lc rgb '{}' title 'published'\n",
          palette::kBlue + 1, palette::kBlue, kPublishedAside, palette::kOrange);
  return figure;
}

Figure staircaseFigure(const StudySummary& s, const std::vector<ResponseRecord>& responses) {
  PlotTable table{"condition", "condition_index", "participant", "trial_in_run", "level", "correct", "reversal"};
  for (std::size_t k = 0; k < s.conditions.size(); ++k) {
    std::map<std::int64_t, std::vector<const ResponseRecord*>> people;
    for (const ResponseRecord& r : responses)
      if (r.condition == s.conditions[k].name) people[r.participant].push_back(&r);
    for (const auto& [person, trials] : people) {
      for (const ResponseRecord* r : trials)
        table.row(r->condition, k, person, r->index + 1, s.headline.level_scale * r->level, r->correct, r->reversal);
      table.endRow();  // an empty line breaks gnuplot's from one participant to the next
    }
  }
  Figure figure;
  figure.name = "staircases";
  figure.title = "Staircases";
  figure.caption =
      "The level shown from trial to trial, one line per participant; dots: reversals. Dashed: the mean threshold of "
      "pincer's "
      "participants; "
      "dotted: the published one.";
  const std::size_t columns = std::min<std::size_t>(3, s.conditions.size()),
                    rows = (s.conditions.size() + columns - 1) / columns;
  figure.height = static_cast<int>(150 + 420 * rows);
  figure.data = {{"staircases.csv", table.take()}};
  figure.script =
      figurePrelude(figure.name) + "unset key\nset tics font ',15'\n" +
      (s.info.task == "smoothness-discrimination" ? "set logscale y\nset yrange [0.05:50]\n" : "set yrange [0:*]\n") +
      fmt::format("set multiplot layout {},{}\n", rows, columns);
  for (std::size_t k = 0; k < s.conditions.size(); ++k) {
    const StudyCondition& c = s.conditions[k];
    if (c.trials == 0) continue;  // gnuplot refuses a plot of nothing
    figure.script += fmt::format("set title {} offset 0,-0.5\nset xlabel 'trial'\nset ylabel '{} [{}]'\n",
                                 gnuplotString(c.name), "level", s.headline.level_unit);
    figure.script += fmt::format(
        "plot data skip 1 using ($2=={0} ? $4 : NaN):5 with lines lw 0.7 lc rgb '#80{1}', "
        "data skip 1 using ($2=={0} && $7==1 ? $4 : NaN):5 with points pt 7 ps 0.5 lc rgb '{2}'",
        k, palette::kBlue + 1, palette::kBlue);
    if (c.headline.n > 0)
      figure.script +=
          fmt::format(", {} with lines dt 2 lw 1.2 lc rgb '{}'", levelShown(s, c.headline.mean), palette::kInk);
    if (std::isfinite(c.published))
      figure.script +=
          fmt::format(", {} with lines dt 3 lw 1.6 lc rgb '{}'", levelShown(s, c.published), palette::kOrange);
    figure.script += "\n";
  }
  figure.script += "unset multiplot\n";
  return figure;
}

Figure placesFigure(const std::vector<ResponseRecord>& responses) {
  PlotTable answers{"participant", "true_mm", "named_mm"},
      means{"true_mm", "mean_named_mm", "ci95_low", "ci95_high", "mean_absolute_error_mm"};
  std::map<double, std::map<std::int64_t, std::vector<double>>> places;
  for (const ResponseRecord& r : responses) {
    if (std::isnan(r.answer_value)) continue;
    answers.row(r.participant + 1, 1e3 * r.level, 1e3 * r.answer_value);
    places[r.level][r.participant].push_back(1e3 * r.answer_value);
  }
  for (const auto& [place, people] : places) {
    std::vector<double> named, errors;
    for (const auto& [person, values] : people) {
      double sum = 0, error = 0;
      for (const double v : values) sum += v, error += std::abs(v - 1e3 * place);
      named.push_back(sum / static_cast<double>(values.size()));
      errors.push_back(error / static_cast<double>(values.size()));
    }
    const Estimate e = estimateMean(named);
    const Interval interval = intervalOf(e, Averaged::kAny);
    means.row(1e3 * place, e.mean, interval.low, interval.high, estimateMean(errors).mean);
  }
  Figure figure;
  figure.name = "places";
  figure.title = "Places named against places shown";
  figure.width = 1100;
  figure.caption =
      "Small dots: answers. Large marks: participants' means with their 95 % confidence interval. Line: where every "
      "answer would be right; "
      "flatter than it is a bias towards the centre, as published.";
  figure.data = {{"places.csv", means.take()}, {"places_answers.csv", answers.take()}};
  figure.script = figurePrelude(figure.name) +
                  "set xlabel 'place of the contact on the pad [mm]'\nset ylabel 'place named [mm]'\n" +
                  fmt::format(
                      "plot x with lines lw 1 lc rgb '{}' title 'right', 'places_answers.csv' skip 1 using 2:3 with "
                      "points pt 7 ps 0.8 lc rgb "
                      "'#90{}' title 'answer', data skip 1 using 1:2:3:4 with yerrorbars pt 7 ps 2.4 lw 2 lc rgb '{}' "
                      "title 'mean'\n",
                      palette::kGrey, palette::kBlue + 1, palette::kBlue);
  return figure;
}

Figure confusionFigure(const std::vector<ResponseRecord>& responses) {
  std::set<std::string> set;
  std::map<std::pair<std::string, std::string>, int> counts;
  std::map<std::string, int> shown;
  for (const ResponseRecord& r : responses) {
    if (r.outcome != "answered") continue;
    set.insert(r.stimulus);
    ++counts[{r.stimulus, r.answer}];
    ++shown[r.stimulus];
  }
  const std::vector<std::string> names(set.begin(), set.end());
  PlotTable table{"shown", "named", "column", "row", "percent"};
  std::string tics;
  for (std::size_t i = 0; i < names.size(); ++i) {
    tics += fmt::format("{}{} {}", i ? ", " : "", gnuplotTic(names[i]), i);
    for (std::size_t j = 0; j < names.size(); ++j)
      table.row(names[i], names[j], j, i, 100.0 * counts[{names[i], names[j]}] / shown[names[i]]);
  }
  Figure figure;
  figure.name = "confusions";
  figure.title = "Shapes named against shapes shown";
  figure.width = figure.height = 1200;
  figure.caption =
      "Share of the answers [%], all conditions together; each row is a shape shown. Published (Doxon 2014): sphere "
      "97.6 % right, extruded "
      "triangle 68.4 %, tetrahedron taken for a cone 20.1 %, all together 81.9 %.";
  figure.data = {{"confusions.csv", table.take()}};
  figure.script = figurePrelude(figure.name) +
                  fmt::format(
                      "unset grid\nunset key\nset border 0\nset tics scale 0\nset xtics ({0}) rotate by 40 right\nset "
                      "ytics ({0})\n",
                      tics) +
                  fmt::format("set xrange [-0.5:{0}]\nset yrange [{0}:-0.5]\nset cbrange [0:100]\nunset colorbox\n",
                              static_cast<double>(names.size()) - 0.5) +
                  fmt::format(
                      "set palette defined (0 '#ffffff', 100 '{}')\nset xlabel 'named'\nset ylabel 'shown'\nset "
                      "bmargin 8\nset lmargin 16\n",
                      palette::kBlue) +
                  "plot data skip 1 using 3:4:5 with image pixels, data skip 1 using 3:4:(sprintf('%.1f', $5)):($5 > "
                  "55 ? 0xffffff : 0x222222) with "
                  "labels textcolor rgb variable\n";
  return figure;
}

Figure speedFigure(const StudySummary& s) {
  PlotTable table{"condition", "what", "position", "mean_mm_per_s", "ci95_low", "ci95_high"};
  for (std::size_t k = 0; k < s.conditions.size(); ++k) {
    for (std::size_t i = 0; i < kSpeeds.size(); ++i) {
      const Estimate& e = s.conditions[k].*kSpeeds[i].of;
      const Interval interval = intervalOf(e, Averaged::kPositive);
      table.row(s.conditions[k].name, kSpeeds[i].name, static_cast<double>(k) + 0.2 * (static_cast<double>(i) - 0.5),
                1e3 * e.mean, 1e3 * interval.low, 1e3 * interval.high);
    }
  }
  Figure figure;
  figure.name = "speeds";
  figure.title = "Speeds of finger and tactor";
  figure.caption =
      "Means over participants with their 95 % confidence intervals, while the finger touched and moved, and while the "
      "tactor moved. "
      "Bands: "
      "the ranges published by Doxon (2014), 32-74 mm/s for the finger and 5-19 mm/s for the tactor; the simulated "
      "hand's own speed is "
      "drawn from the first.";
  figure.data = {{"speeds.csv", table.take()}};
  figure.script = figurePrelude(figure.name) + conditionTics(s) +
                  "set yrange [0:80<*]\nset ylabel 'speed [mm/s]'\nset offsets 0, 0, graph 0.1, 0\n";
  std::string plots;
  for (std::size_t i = 0; i < kSpeeds.size(); ++i) {
    const SpeedKind& kind = kSpeeds[i];
    figure.script += fmt::format(
        "set object {} rectangle from graph 0, first {} to graph 1, first {} fillcolor rgb '#d0{}' fillstyle solid "
        "noborder behind\n",
        i + 1, kind.published_low, kind.published_high, kind.colour + 1);
    plots += fmt::format(
        "{}data skip 1 using (stringcolumn(2) eq '{}' ? $3 : NaN):4:5:6 with yerrorbars pt 7 ps 2.2 lw 2 lc rgb '{}' "
        "title '{}'",
        i ? ", " : "plot ", kind.name, kind.colour, kind.name);
  }
  figure.script += plots + "\n";
  return figure;
}

Figure timeFigure(const StudySummary& s) {
  PlotTable table{"condition", "position", "shown_s", "ci95_low", "ci95_high", "answer_after_s"};
  for (std::size_t k = 0; k < s.conditions.size(); ++k) {
    const StudyCondition& c = s.conditions[k];
    const Interval interval = intervalOf(c.duration, Averaged::kPositive);
    table.row(c.name, static_cast<double>(k), c.duration.mean, interval.low, interval.high, c.response_time.mean);
  }
  Figure figure;
  figure.name = "times";
  figure.title = "Time with the stimuli";
  figure.caption =
      "Time of a trial in which the stimuli were there to be felt: mean over participants with its 95 % confidence "
      "interval. Simulated "
      "participants answer after their reaction time, which is a constant.";
  figure.data = {{"times.csv", table.take()}};
  figure.script =
      figurePrelude(figure.name) + conditionTics(s) +
      "unset key\nset yrange [0:*]\nset ylabel 'time [s]'\nset offsets 0, 0, graph 0.1, 0\n" +
      fmt::format("plot data skip 1 using 2:3:4:5 with yerrorbars pt 7 ps 2.2 lw 2 lc rgb '{}'\n", palette::kBlue);
  return figure;
}

}  // namespace pincer::tasks
