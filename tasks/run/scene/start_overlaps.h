// start_overlaps: bodies that lie in each other as a scene draws them.
#pragma once
#include <vector>

#include "pincer/engine/state.h"

namespace pincer::tasks {

struct StartOverlap {
  int a = 0, b = 0;  // bodies, a < b
  double depth = 0;  // of their deepest contact [m], positive
};

// Pairs that touch deeper than by drawing's round-off (10 um), the deepest first. `start` is a state that makeState or
// startState made; fingers that no body carries aren't judged. Allocates.
std::vector<StartOverlap> overlapsAtStart(const engine::WorldModel& model, const engine::WorldState& start);

}  // namespace pincer::tasks
