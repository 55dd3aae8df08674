// tree_builder: makes trees (engine/tree.h) of the groups of joints that need one: whose joints have limits, springs,
// drives, dry friction or armatures, or that are too large for one mover.
//
//   links, rates, freedoms: depth first, the children of a link in the order of their joints
//   blocks: runs of freedoms without a branch, at most kMoverFreedoms long
// Branches that a drive or a coupling ties together are one path: their equations have no branches.
#pragma once
#include <vector>

#include "pincer/engine/model.h"

namespace pincer::engine {

// After groupJoints. Groups that became trees are groups no more. Throws InputError where all joints of a loop
// have more than a kind, or nothing holds a tree.
void findTrees(const std::vector<CouplingModel>& couplings, WorldModel& model);

// Notes which trees something may touch. After pairs are listed.
void findTouchedTrees(WorldModel& model);

}  // namespace pincer::engine
