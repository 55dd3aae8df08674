#include "pincer/tasks/judge/bench/study_bench.h"

#include <fmt/format.h>

#include <cmath>
#include <map>

#include "pincer/tasks/lab/study/counterbalance.h"
#include "pincer/tasks/lab/study/known_observer.h"

namespace pincer::tasks {
namespace {

constexpr std::uint64_t kBenchSeed = 1971;  // any number: the figures are the same in each run

// An observer of the population above whose level of probability `p` is 1.
PsychometricFunction drawObserver(double p, Random& random, Sigmoid shape = Sigmoid::kNormal) {
  PsychometricFunction f{shape, 0, random.uniform(0.2, 0.5), 0.5, random.uniform(0, 0.02)};
  f.alpha = 1 - f.levelOf(p);
  return f;
}

struct Spread {
  double bias = 0, sd = 0, trials = 0;
  int lost = 0;  // staircases without a threshold
};

Spread overObservers(const StaircaseRule& rule, int observers, MeasureContext& context) {
  Random random(kBenchSeed);
  double sum = 0, squares = 0, trials = 0;
  int lost = 0;
  for (int k = 0; k < observers && !context.interrupted(); ++k) {
    const PsychometricFunction observer = drawObserver(convergencePoint(rule.down), random);
    const Staircase staircase = runStaircase(rule, observer, random);
    const double error = staircase.threshold() - 1;
    trials += staircase.trials();
    if (std::isnan(error)) {
      ++lost;
      continue;
    }
    sum += error;
    squares += error * error;
    context.progress(static_cast<double>(k) / observers);
  }
  const double n = observers - lost, mean = sum / n;
  return {mean, std::sqrt(squares / n - mean * mean), trials / observers, lost};
}

// Long enough, and in steps small enough, to forget the start and reach the point of convergence: what a study
// that needs the threshold itself should take.
StaircaseRule carefulRule() {
  return {.start = 2, .large_step = 0.2, .small_step = 0.05, .large_reversals = 6, .reversals = 36, .averaged = 24};
}

std::vector<Record> staircaseRecords(const StaircaseRule& rule, int observers, double bound, MeasureContext& context) {
  const Spread s = overObservers(rule, observers, context);
  std::vector<Record> records{
      atMost("bias of the 70.7 % point, of it", 100 * std::abs(s.bias), "%", bound),
      unbounded("with its sign", 100 * s.bias, "%"), unbounded("SD of a threshold, of it", 100 * s.sd, "%"),
      unbounded("trials", s.trials, "-"), exactly("staircases without a threshold", s.lost, "-", 0)};
  return records;
}

Measurement staircaseMeasurement(const std::string& name, const StaircaseRule& rule, int observers, double bound) {
  return {name, [=](MeasureContext& context) { return staircaseRecords(rule, observers, bound, context); }};
}

// Thresholds that the published designs' staircases make of the same observers: theirs are
// shorter. Levels in units of the threshold.
std::vector<Measurement> publishedStaircases(int observers) {
  // A bound that nothing exceeds: told, not judged.
  constexpr double kNoPromise = std::numeric_limits<double>::infinity();
  const StaircaseRule smoothness{.start = 2,
                                 .large_step = 0.4,
                                 .small_step = 0.1,
                                 .large_reversals = 3,
                                 .reversals = 11,
                                 .averaged = 6,
                                 .lowest = 0.01};
  const StaircaseRule backlash{.start = 2,
                               .large_step = 0.3 / 0.46,
                               .small_step = 0.06 / 0.46,
                               .large_reversals = 4,
                               .reversals = 14,
                               .averaged = 10,
                               .lowest = 0.01};
  const StaircaseRule delay{.start = 2,
                            .large_step = 15. / 61,
                            .small_step = 6. / 61,
                            .large_reversals = 4,
                            .reversals = 14,
                            .averaged = 10,
                            .lowest = 0.01};
  return {staircaseMeasurement("staircase/as-smoothness", smoothness, observers, kNoPromise),
          staircaseMeasurement("staircase/as-backlash", backlash, observers, kNoPromise),
          staircaseMeasurement("staircase/as-delay", delay, observers, kNoPromise)};
}

// Bias against the step: Garcia-Perez (1998) found that equal steps up and down miss Levitt's point by more, the larger
// they are beside the spread. The start is the true threshold, so that nothing but the step differs.
std::vector<Record> stepSizes(int observers, MeasureContext& context) {
  std::vector<Record> records;
  for (const double step : {0.05, 0.1, 0.2, 0.4, 0.8}) {
    const StaircaseRule rule{.start = 1,
                             .large_step = step,
                             .small_step = step,
                             .large_reversals = 0,
                             .reversals = 42,
                             .averaged = 40,
                             .lowest = -10};
    const Spread s = overObservers(rule, observers, context);
    records.push_back(unbounded(fmt::format("bias at a step of {:g} of the threshold", step), 100 * s.bias, "%"));
  }
  return records;
}

// Bias of the threshold and how often its interval holds the true one.
std::vector<Record> constantStimuli(Sigmoid shape, int observers, MeasureContext& context) {
  constexpr double kPoint = 0.75;  // probability halfway between a guess and certainty [-]
  const std::vector<double> levels{0.2, 0.5, 0.8, 1.0, 1.2, 1.5, 1.8};
  Random random(kBenchSeed);
  double sum = 0;
  int covered = 0;
  for (int k = 0; k < observers && !context.interrupted(); ++k) {
    const PsychometricFunction observer = drawObserver(kPoint, random, shape);
    const auto counts = runConstantStimuli(levels, 50, observer, random);
    const PsychometricFit fit = fitPsychometric(counts, shape, 0.5, kPoint);
    sum += fit.threshold - 1;
    covered += fit.interval.low <= 1 && 1 <= fit.interval.high;
    context.progress(static_cast<double>(k) / observers);
  }
  const double share = 100.0 * covered / observers;
  return {atMost("bias of the 75 % point, of it", 100 * std::abs(sum / observers), "%", 2),
          atLeast("95 % intervals that hold it", share, "%", 92),
          atMost("95 % intervals that hold it", share, "%", 98)};
}

// Of all squares up to 12 conditions: how far the counts of places and of neighbours are from equal.
std::vector<Record> squares(MeasureContext&) {
  int uneven = 0;
  for (int n = 2; n <= 12; ++n) {
    std::map<std::pair<int, int>, int> places, neighbours;
    const auto rows = carryOverSquare(n);
    for (const Order& row : rows) {
      for (int place = 0; place < n; ++place) ++places[{row[static_cast<std::size_t>(place)], place}];
      for (std::size_t place = 1; place < row.size(); ++place) ++neighbours[{row[place - 1], row[place]}];
    }
    const int each = static_cast<int>(rows.size()) / n;
    uneven += static_cast<int>(places.size()) != n * n || static_cast<int>(neighbours.size()) != n * (n - 1);
    for (const auto& [key, count] : places) uneven += count != each;
    for (const auto& [key, count] : neighbours) uneven += count != each;
  }
  return {exactly("uneven places or neighbours, 2 to 12 conditions", uneven, "-", 0)};
}

}  // namespace

std::vector<Measurement> studyMeasurements(const StudyBenchOptions& options) {
  const int n = options.observers;
  std::vector<Measurement> list{staircaseMeasurement("staircase/careful", carefulRule(), n, 2)};
  for (Measurement& m : publishedStaircases(n)) list.push_back(std::move(m));
  list.push_back({"staircase/step-size", [n](MeasureContext& c) { return stepSizes(n, c); }});
  list.push_back(
      {"constant-stimuli/normal", [n](MeasureContext& c) { return constantStimuli(Sigmoid::kNormal, n, c); }});
  list.push_back(
      {"constant-stimuli/logistic", [n](MeasureContext& c) { return constantStimuli(Sigmoid::kLogistic, n, c); }});
  list.push_back({"latin-squares", squares});
  return list;
}

}  // namespace pincer::tasks
