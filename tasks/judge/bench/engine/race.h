// race: every contestant through one scene, at every step, each run judged once and timed several times by turns.
#pragma once
#include <string>
#include <vector>

#include "pincer/tasks/judge/bench/engine/bench_scene.h"
#include "pincer/tasks/judge/bench/engine/work_precision.h"
#include "pincer/tasks/run/measure/measurement.h"

namespace pincer::tasks {

struct RaceOptions {
  int rounds = 3;                   // of timing; the least counts
  double seconds = 0.03;            // of processor time that a run of an even scene takes in a round [s]
  std::int64_t least_steps = 1000;  // but at least so many
};

struct RaceRun {
  std::size_t contestant = 0;  // place in the list
  BenchStep step = {};
  std::int64_t steps = 0;      // until the judge had seen enough
  double error = 0;            // in the scene's unit, not below its floor; NaN if it failed
  double judged_per_step = 0;  // processor time, reading included [s]
  double us_per_step = 0;      // least of the rounds, processor time of this thread; NaN if it failed
  std::string failure = {};    // why the run shows nothing
  bool absent = false;         // it failed since the contestant takes no part
  std::string complaint = {};  // of the engine about its steps, though the scene moved as it should

  bool ok() const { return failure.empty(); }
  WorkPoint point() const { return {us_per_step / step.h, error}; }
};

// In the order of contestants and their ladders. Errors are judged first, then rounds of timing go over all runs
// by turns, so that a slow spell of the machine hits all alike; reading results isn't timed. A contestant that
// takes no part has one failed run, with why.
std::vector<RaceRun> race(const BenchScene& scene, const std::vector<Contestant>& contestants,
                          const RaceOptions& options, MeasureContext& context);

}  // namespace pincer::tasks
