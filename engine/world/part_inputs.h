// part_inputs: what drives the world at the end of a part of a tick: points, drives, and bodies with a given motion.
//
// Targets of a part that ends before the tick does lie on the way from those of the last tick to those of
// this one: a cubic between places and rates.
#pragma once
#include <cstdint>

#include "pincer/engine/step.h"
#include "pincer/engine/world/scratch.h"

namespace pincer::engine {

// Fills scratch.point_inputs, motion_inputs and the drives' inputs, of a part of length `h` while `left` of the tick is
// left [s]. `state` holds the targets at the part's start. Returns kInputNotFinite if some input isn't finite (then
// what it drives stays where it is), else kStepOk.
std::uint32_t setPartInputs(const WorldModel& model, const StepInputs& inputs, double h, double left, WorldState& state,
                            WorldScratch& scratch);

}  // namespace pincer::engine
