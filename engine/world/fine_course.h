// fine_course: trees that nothing pushed on in a part of a tick, after all, go by Runge and Kutta's method.
//
// Contacts answer the course of the middle, whose rates are off by h^2 k/(12 m) where a spring of stiffness k swings an
// inertia m (drive_law.h): what rests needs that. What swings freely doesn't, and would seem to gain energy by it. Dry
// friction that slides from the start to the end of the part is a constant force, and joints that it locks stay.
#pragma once
#include "pincer/engine/state.h"
#include "pincer/engine/world/scratch.h"

namespace pincer::engine {

// Finds the trees that some contact of a link, a stop or a drive's limit was looked at for, if any is to be refined.
void noteNearTrees(const WorldModel& model, WorldScratch& scratch);

// Refines the course of a tree, after gatherTrees and noteNearTrees, unless something is near it, one of its elements
// is stiff, or it would run into a stop, or friction would turn round.
void refineCourse(const WorldModel& model, const WorldState& state, WorldScratch& scratch, int tree);

}  // namespace pincer::engine
