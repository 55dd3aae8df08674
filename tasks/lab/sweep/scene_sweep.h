// scene_sweep: a scene of bodies and fingers, run for many values of its numbers, and what its quantities (docs/scenes.md) came to.
#pragma once
#include <atomic>
#include <string>
#include <vector>

#include "pincer/tasks/lab/sweep/sweep.h"
#include "pincer/tasks/run/scene/builtin_scenes.h"

namespace pincer::tasks {

struct SceneSweep {
  std::vector<Variation> variations;  // one or two; paths as in tasks/run/scene/json_change.h
  // Quantities: at the end, or with ":min" or ":max" the least or largest over the whole run. Empty: those that the scene records.
  std::vector<std::string> measures;
};

// Every point is read before the first is run. The table's last measure is how many of the scene's expectations fail, where it has some.
// Throws InputError for a path, value or measure that doesn't fit the scene.
SweepTable sweepScene(const NamedJson& scene, const SceneSweep& sweep, const SweepOptions& options, const std::atomic<bool>& interrupted);

}  // namespace pincer::tasks
