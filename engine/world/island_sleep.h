// island_sleep: what of the world is at rest isn't computed while something else moves.
//
// A tick is a function of state and inputs, and an island's share of it is one of its bodies, its contacts and what
// these remember (islands.h). Where a whole tick left all of that as it was, to the bit, the next one will, too: the
// island sleeps, its contacts put aside as they are. Results are those of a world without sleep, to the bit; it is
// memory, no heuristic (rest.h, which does the same for all of the world at once).
//
// It wakes where anything differs: a bit of its state, or of what it stands on, set from outside; something awake
// that comes within the contact margin or may hit it; a driven body that begins to move; a tick that is cut into
// parts; more contacts than there is room for. Never asleep is what a point or a moving driven body touches, what
// joints bind, and any island in a world with a position tolerance. With a budget what sleeps leaves its share to
// the others, so that theirs runs out later.
#pragma once
#include "pincer/engine/world/stages.h"

namespace pincer::engine {

// At the start of a tick: whether state and inputs are those that islands fell
// asleep with; wakes all where they aren't.
void wakeChanged(const WorldModel& model, const WorldState& state, const StepInputs& inputs, WorldScratch& scratch);

// Of the contacts found, awake with awake and awake with asleep: wakes the islands that they touch. Whether there were
// any; then poses and contacts have to be found again.
bool wakeTouched(WorldScratch& scratch);

void wakeAll(WorldScratch& scratch);

// At the end of a tick in one part: islands that it left as they were fall asleep.
void fallAsleep(const WorldModel& model, const WorldState& state, WorldScratch& scratch);

inline bool isSomethingAsleep(const WorldScratch& scratch) { return scratch.sleep.bodies > 0; }

// True if the tick neither moves the body nor looks for contacts with others of which that is true.
inline bool isIdle(const WorldScratch& scratch, int body) {
  return isSomethingAsleep(scratch) && scratch.sleep.idle[static_cast<std::size_t>(body)];
}

}  // namespace pincer::engine
