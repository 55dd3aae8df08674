// scene_sweep: a scene of bodies and fingers, run for many values of its numbers, and what
// its quantities (docs/scenes.md) came to.
#pragma once
#include <string>
#include <vector>

#include "pincer/tasks/lab/sweep/sweep.h"
#include "pincer/tasks/run/scene/builtin_scenes.h"

namespace pincer::tasks {

struct SceneSweep {
  SweepGrid grid;  // paths as in tasks/run/scene/json_change.h
  // Quantities: at the end, or with ":min" or ":max" the least or largest over the whole
  // run. Empty: those that the scene records.
  std::vector<std::string> measures;
};

constexpr std::size_t kMostSceneCases = 100'000;  // runs of one sweep: bounds a mistaken grid; chosen

// The last measure is how many of the scene's expectations fail, where it has some. Throws InputError where no case can
// be read: for a path or measure that doesn't fit the scene. `text`: the scene's, by which it is known again.
SweepJob sceneSweep(const NamedJson& scene, std::string_view text, const SceneSweep& sweep);

}  // namespace pincer::tasks
