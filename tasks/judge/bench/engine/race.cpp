#include "pincer/tasks/judge/bench/engine/race.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "pincer/contact/error.h"
#include "pincer/tasks/run/measure/timing.h"

namespace pincer::tasks {
namespace {

constexpr double kJudging = 0.4;  // share of the progress that judging takes

std::vector<RaceRun> entries(const BenchScene& scene, const std::vector<Contestant>& contestants) {
  std::vector<RaceRun> runs;
  for (std::size_t c = 0; c < contestants.size(); ++c) {
    if (scene.world.robot && !contestants[c].reads_robots) continue;
    if (contestants[c].meant && !contestants[c].meant(scene.world)) continue;
    const std::string lacks = contestants[c].lacks(scene.world);
    if (!lacks.empty()) {
      runs.push_back({.contestant = c, .failure = lacks, .absent = true});
      continue;
    }
    if (contestants[c].ladder.empty()) {
      for (const double h : scene.steps) runs.push_back({.contestant = c, .step = {.h = h}});
    }
    for (const BenchStep& step : contestants[c].ladder) runs.push_back({.contestant = c, .step = step});
  }
  return runs;
}

// Runs the scene once, looking at it; says in `run` how it went.
void judgeRun(const BenchScene& scene, const Contestant& contestant, MeasureContext& context, RaceRun& run) {
  const auto engine = contestant.make(scene.world, run.step);
  const BenchJudge judge = scene.judge();
  const std::int64_t steps = std::lround(scene.duration / run.step.h);
  const double start = threadCpuSeconds();
  for (bool goes_on = true; goes_on && run.steps < steps;) {
    engine->step();
    ++run.steps;
    if (judge.look) goes_on = judge.look(static_cast<double>(run.steps) * run.step.h, *engine);
    if (run.steps % 16 != 0) continue;
    if (context.interrupted()) return;
    const double used = threadCpuSeconds() - start;
    if (used < scene.patience) continue;
    run.failure = fmt::format("too slow: {:.3g} s of processor time for {:.3g} s", used,
                              static_cast<double>(run.steps) * run.step.h);
    return;
  }
  run.judged_per_step = (threadCpuSeconds() - start) / static_cast<double>(run.steps);
  const BenchVerdict verdict = judge.verdict(*engine);
  run.failure = verdict.failure;
  run.complaint = engine->complaint();
  if (run.ok() && !std::isfinite(verdict.error)) run.failure = "a number isn't finite";
  run.error = std::max(verdict.error, scene.floor);
}

double secondsOf(const BenchScene& scene, const Contestant& contestant, const RaceRun& run, std::int64_t steps) {
  const auto engine = contestant.make(scene.world, run.step);
  const double start = threadCpuSeconds();
  for (std::int64_t i = 0; i < steps; ++i) engine->step();
  return threadCpuSeconds() - start;
}

// One round of timing. Short scenes are run several times, to be felt by the clock;
// of long and even ones the first part is.
void timeRun(const BenchScene& scene, const Contestant& contestant, const RaceOptions& options, RaceRun& run) {
  std::int64_t steps = run.steps;
  if (scene.even)
    steps = std::min(steps,
                     std::max<std::int64_t>(options.least_steps, std::llround(options.seconds / run.judged_per_step)));
  const double known = 1e-6 * run.us_per_step * static_cast<double>(steps);
  if (std::isfinite(known) && known > 4 * options.seconds) return;  // once is enough: long runs are even by themselves
  for (std::int64_t done = 0; done < options.least_steps; done += steps) {
    const double seconds = secondsOf(scene, contestant, run, steps);
    run.us_per_step = std::min(run.us_per_step, 1e6 * seconds / static_cast<double>(steps));
    if (seconds > 0.1 * options.seconds) break;
  }
}

}  // namespace

std::vector<RaceRun> race(const BenchScene& scene, const std::vector<Contestant>& contestants,
                          const RaceOptions& options, MeasureContext& context) {
  std::vector<RaceRun> runs = entries(scene, contestants);
  const auto each = [&](double from, double to, const auto& work) {
    for (std::size_t i = 0; i < runs.size() && !context.interrupted(); ++i) {
      if (runs[i].ok()) work(contestants[runs[i].contestant], runs[i]);
      context.progress(from + (to - from) * static_cast<double>(i + 1) / static_cast<double>(runs.size()));
    }
  };
  each(0, kJudging, [&](const Contestant& contestant, RaceRun& run) {
    try {
      judgeRun(scene, contestant, context, run);
    } catch (const InputError& error) {
      run.failure = error.what();
    }
    run.us_per_step = kInfinity;
  });
  for (int k = 0; k < options.rounds; ++k) {
    const double share = (1 - kJudging) / options.rounds;
    each(kJudging + k * share, kJudging + (k + 1) * share,
         [&](const Contestant& contestant, RaceRun& run) { timeRun(scene, contestant, options, run); });
  }
  for (RaceRun& run : runs) {
    if (!run.ok()) run.error = run.us_per_step = std::nan("");
  }
  return runs;
}

}  // namespace pincer::tasks
