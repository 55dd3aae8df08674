// tried_impulses: the answer of one attempt at a tick, as the start of the next one.
//
//   r = s r',   s = h / h' where a contact carries, 1 where it is hit        of the same contact, in its present frame
//
// A tick that is cut is attempted several times from the same state. Where many contacts touch, each attempt's answer
// is nearer to the next one's than the last tick's is: of a wall that is hit, by three digits.
#pragma once
#include "pincer/engine/world/scratch.h"

namespace pincer::engine {

// Keeps the impulses of the attempt just solved, where they are many.
void keepTried(WorldScratch& scratch);

// Begins the solve of the present attempt, whose contacts are filled and sorted, with those kept.
void startFromTried(WorldScratch& scratch);

}  // namespace pincer::engine
