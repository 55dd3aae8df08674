#include "pincer/tasks/lab/findings/published_figures.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <map>

#include "pincer/contact/error.h"
#include "pincer/tasks/lab/report/paired_test.h"

namespace pincer::tasks {
namespace {

constexpr int kFewestExperiments = 4;
constexpr double kChance = 0.05;
constexpr double kPercent = 100, kMillimetres = 1e3;

using Responses = std::vector<const ResponseRecord*>;

// What one experiment says of a figure.
struct MeasuredFigure {
  std::string key, label, unit;
  double low = 0, high = 0;
  std::vector<double> people;  // shown; NaN of who has none
  bool unsettled = false;
};

// Share of the answers to `shown` (empty: to all) that are `named` (empty: right) [%].
double shareNamed(const Responses& trials, const std::string& shown, const std::string& named) {
  int asked = 0, said = 0;
  for (const ResponseRecord* r : trials) {
    if (!shown.empty() && r->stimulus != shown) continue;
    ++asked;
    said += named.empty() ? r->correct != 0 : r->answer == named;
  }
  return asked > 0 ? kPercent * said / asked : std::numeric_limits<double>::quiet_NaN();
}

double meanSpeed(const Responses& trials, double ResponseRecord::*speed) {
  double sum = 0;
  int n = 0;
  for (const ResponseRecord* r : trials) {
    if (!std::isfinite(r->*speed)) continue;
    sum += r->*speed;
    ++n;
  }
  return n > 0 ? kMillimetres * sum / n : std::numeric_limits<double>::quiet_NaN();
}

struct ExtraFigure {
  const char *key, *label, *unit;
  double low, high;
  double (*of)(const Responses& trials);
};

constexpr std::array<ExtraFigure, 2> kSpeeds{{
    {"finger-speed", "finger speed", "mm/s", 32, 74, [](const Responses& t) { return meanSpeed(t, &ResponseRecord::finger_speed); }},
    {"tactor-speed", "tactor speed", "mm/s", 5, 19, [](const Responses& t) { return meanSpeed(t, &ResponseRecord::tactor_speed); }},
}};

constexpr std::array<ExtraFigure, 4> kShapes{{
    {"right", "right answers, all conditions", "%", 81.9, 81.9, [](const Responses& t) { return shareNamed(t, "", ""); }},
    {"sphere", "spheres named right", "%", 97.6, 97.6, [](const Responses& t) { return shareNamed(t, "sphere", ""); }},
    {"triangle", "extruded triangles named right", "%", 68.4, 68.4, [](const Responses& t) { return shareNamed(t, "triangle", ""); }},
    {"tetrahedron-cone", "tetrahedra taken for cones", "%", 20.1, 20.1,
     [](const Responses& t) { return shareNamed(t, "tetrahedron", "cone"); }},
}};

struct OrderOfStudy {
  const char *study, *lower, *higher;  // keys
};
constexpr std::array<OrderOfStudy, 8> kOrders{{{"smoothness-discrimination", "C3", "C1"},
                                               {"smoothness-discrimination", "C1", "C2"},
                                               {"smoothness-discrimination", "C1", "C4"},
                                               {"smoothness-discrimination", "C3", "C4"},
                                               {"backlash-discrimination", "low-curvature", "edge"},
                                               {"delay-discrimination", "whole", "front-end"},
                                               {"shape-identification", "triangle", "right"},
                                               {"shape-identification", "right", "sphere"}}};

template <std::size_t N>
void addExtras(const std::array<ExtraFigure, N>& extras, const std::map<std::int64_t, Responses>& people,
               std::vector<MeasuredFigure>& figures) {
  for (const ExtraFigure& extra : extras) {
    MeasuredFigure figure{extra.key, extra.label, extra.unit, extra.low, extra.high, {}};
    for (const auto& [person, trials] : people) figure.people.push_back(extra.of(trials));
    figures.push_back(std::move(figure));
  }
}

std::vector<MeasuredFigure> figuresOf(const StudySummary& summary, const std::vector<ResponseRecord>& responses) {
  std::vector<MeasuredFigure> figures;
  const bool shapes = summary.info.task == "shape-identification";
  for (const StudyCondition& c : summary.conditions) {
    if (std::isnan(c.published) || shapes) continue;  // of shapes one figure was published over all conditions
    const double published = summary.headline.scale * c.published;
    const std::string label = fmt::format("{}{}", summary.headline.name, c.name == summary.info.task ? "" : ", " + c.label);
    MeasuredFigure figure{c.name, label, summary.headline.unit, published, published, {}, isUnsettled(c)};
    for (const StudyPerson& person : c.people) figure.people.push_back(summary.headline.scale * person.headline);
    figures.push_back(std::move(figure));
  }
  std::map<std::int64_t, Responses> people;
  for (const ResponseRecord& r : responses) {
    if (r.outcome == "answered") people[r.participant].push_back(&r);
  }
  if (shapes) addExtras(kShapes, people, figures);
  if (shapes || summary.info.task == "smoothness-discrimination") addExtras(kSpeeds, people, figures);
  return figures;
}

std::vector<double> finiteOf(const std::vector<double>& values) {
  std::vector<double> finite;
  std::copy_if(values.begin(), values.end(), std::back_inserter(finite), [](double x) { return std::isfinite(x); });
  return finite;
}

PublishedFigure overExperiments(const std::string& study, const std::vector<std::vector<MeasuredFigure>>& experiments, std::size_t place) {
  const MeasuredFigure& first = experiments.front()[place];
  PublishedFigure figure{study, first.key, first.label, first.unit, first.low, first.high, {}};
  std::vector<double> means;
  for (const auto& experiment : experiments) {
    const Estimate own = estimateMean(finiteOf(experiment[place].people));
    figure.unsettled += experiment[place].unsettled;
    if (own.n == 0) continue;
    means.push_back(own.mean);
    const double half_width = first.low < first.high || own.n < 2 ? 0 : own.half_width;
    figure.within += !experiment[place].unsettled && own.mean + half_width >= first.low && own.mean - half_width <= first.high;
  }
  figure.experiments = static_cast<int>(means.size());
  figure.mean = estimateMean(means);
  return figure;
}

const MeasuredFigure& figureOf(const std::vector<MeasuredFigure>& figures, const std::string& key) {
  return *std::find_if(figures.begin(), figures.end(), [&](const MeasuredFigure& f) { return f.key == key; });
}

PublishedOrder overExperiments(const OrderOfStudy& order, const std::vector<std::vector<MeasuredFigure>>& experiments) {
  const auto label = [&](const char* key) { return figureOf(experiments.front(), key).label; };
  PublishedOrder result{order.study, label(order.lower), label(order.higher)};
  for (const auto& experiment : experiments) {
    const PairedTest test = comparePairs(figureOf(experiment, order.lower).people, figureOf(experiment, order.higher).people);
    if (test.n < 2) continue;
    ++result.experiments;
    const bool holds = test.difference.mean > 0;
    result.holds += holds;
    result.significant += holds && test.p_t < kChance;
  }
  return result;
}

}  // namespace

void judgeStudy(const std::vector<std::string>& sessions, PublishedFindings& findings) {
  std::vector<std::vector<MeasuredFigure>> experiments;
  std::string study, fingerprint;
  for (const std::string& path : sessions) {
    const SessionReader session(path);
    if (!session.complete()) continue;
    const std::vector<ResponseRecord> responses = session.responses();
    const StudySummary summary = summariseStudy(session, responses);
    experiments.push_back(figuresOf(summary, responses));
    if (study.empty()) {
      study = summary.info.task;
      fingerprint = summary.fingerprint;
    }
    if (summary.info.task != study || summary.fingerprint != fingerprint || experiments.back().size() != experiments.front().size()) {
      throw InputError(fmt::format("{}: isn't of the same study and participants as the experiments before it. Give another --out.", path));
    }
  }
  if (experiments.empty()) return;
  findings.fingerprints.push_back(fmt::format("{}: {}", study, fingerprint));
  for (std::size_t i = 0; i < experiments.front().size(); ++i) findings.figures.push_back(overExperiments(study, experiments, i));
  for (const OrderOfStudy& order : kOrders) {
    if (study == order.study) findings.orders.push_back(overExperiments(order, experiments));
  }
}

std::string verdictOn(const PublishedFigure& f) {
  if (f.experiments < kFewestExperiments) return "too few experiments";
  if (2 * f.unsettled > f.experiments) return "no threshold";
  const int missed = f.experiments - f.within;
  if (f.low < f.high ? missed == 0 : wilsonInterval(missed, f.experiments).first <= kChance) return "follows";
  return fmt::format("no: {:.3g} times", f.ratio());
}

std::string verdictOn(const PublishedOrder& o) {
  if (o.experiments < kFewestExperiments) return "too few experiments";
  const auto [low, high] = wilsonInterval(o.holds, o.experiments);
  return low > 0.5 ? "follows" : high < 0.5 ? "the other way round" : "can't be told";
}

}  // namespace pincer::tasks
