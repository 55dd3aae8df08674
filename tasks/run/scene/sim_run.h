// sim_run: runs a scene from start to end: times each tick, records, checks the expectations.
#pragma once
#include <atomic>
#include <functional>
#include <optional>
#include <string>
#include <vector>

#include "pincer/tasks/run/scene/start_overlaps.h"
#include "pincer/tasks/run/scene/step_status_text.h"
#include "pincer/tasks/run/scene/tick_times.h"
#include "pincer/tasks/run/simulation.h"

namespace pincer::tasks {

struct SimOptions {
  std::optional<double> duration;  // in place of the scene's [s]
  std::optional<double> every;     // in place of the scene's recording interval [s]
  std::string csv;                 // file for the recorded quantities; empty: none
  bool grasp = false;              // say how well the fingers hold at the end
  bool awake = false;              // no sleep
  bool timing = false;             // also in JSON, which is the same bytes at each run without
};

struct SimResult {
  ExpectationLog log;
  TickTimes times;
  StatusCounts statuses;
  std::int64_t ticks_wanted = 0;
  bool interrupted = false;
  std::vector<StartOverlap> overlaps;  // of the start
  bool broke = false;                  // a state that isn't finite ended the run
};

// Changes `scene` as the options say. Throws InputError when they don't fit it.
void applyOptions(const SimOptions& options, Scene& scene);

// `progress` is called after every tick with the ticks done. Throws InputError when the
// CSV can't be written (then none is left).
SimResult runScene(Simulation& simulation, const SimOptions& options, const std::atomic<bool>& interrupted,
                   const std::function<void(std::int64_t)>& progress);

// For a person, and for machines.
std::string simText(const Simulation& simulation, const SimOptions& options, const SimResult& result);
std::string simJson(const Simulation& simulation, const SimOptions& options, const SimResult& result);

}  // namespace pincer::tasks
