// island_sides: an island's contacts as its movers see them: the blocks of A (solve/contact_problem.h).
#pragma once
#include "pincer/engine/world/islands.h"
#include "pincer/engine/world/tree_sides.h"

namespace pincer::engine {

// f(mover) for it and, if it is a block, for those before it on the way to the base.
template <class F>
void forEachOf(const IslandScratch& s, int mover, F f) {
  for (; mover >= 0; mover = parentOf(s, mover)) f(mover);
}

// True if a contact of the island has more than two movers: then it is one of many sides.
bool hasManySides(const IslandScratch& s, const Island& island);
void fillManySides(const WorldModel& model, WorldScratch& scratch, Island& island, IslandScratch& s);

// Fills other islands' blocks and their movers' numbers. Grips, which need the numbers alone as a rule, have them from
// numberMovers, and their blocks later, several islands at once.
void fillSides(const WorldModel& model, WorldScratch& scratch, Island& island, IslandScratch& s);
void numberMovers(const WorldModel& model, WorldScratch& scratch, Island& island, IslandScratch& s);

}  // namespace pincer::engine
