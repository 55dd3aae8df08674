// tree_pattern: which columns the equations of a tree have, and which of them see each other.
//
// A column is the rate of a coordinate that follows no other. Two columns see each other where both move one link, or
// where both change the length that a drive acts along, or where the tree has a loop: what closes it answers all over
// the tree. Each column's `before` is the nearest of those further in that it sees, once all further out are
// eliminated: then a column sees only what lies on its path, and nothing fills in.
// Source: J. W. H. Liu, SIAM J. Matrix Anal. Appl. 11 (1990) 134-172 (elimination trees).
#pragma once
#include "pincer/engine/tree.h"

namespace pincer::engine {

// Fills columns, paths, blocks and the links' tips of a tree whose links, coordinates and
// drives are there. A leader follows nobody.
void finishTree(TreeModel& tree);

}  // namespace pincer::engine
