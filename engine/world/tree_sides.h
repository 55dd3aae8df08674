// tree_sides: contacts on links and joint rows, in terms of movers (contact_sides.h).
//
//   A_c = J_c L^-1 D^-1/2 on the path of the link, cut into blocks
//   (engine/tree/sparse_ldl.h);   W = A A^T = J M^^-1 J^T
//
// Out of line: most worlds have no trees, and their ticks are to be as short as without these.
// Movers of a world, in this order: bodies, points, blocks of trees, what joint rows have of their own.
#pragma once
#include "pincer/engine/model.h"
#include "pincer/engine/world/scratch.h"

namespace pincer::engine {

std::size_t moverCount(const WorldModel& model);

// Which block comes before which, and how many movers a contact has at most.
void findBlocks(const WorldModel& model, IslandScratch& s);

// The outermost block that moves a link, -1 if none does; of a joint row's side the coordinate's, or the row's own.
[[gnu::noinline]] int moverOfLink(const WorldModel& model, const BodyModel& link);
[[gnu::noinline]] int moverOfRow(const WorldModel& model, const WorldScratch& scratch, const Contact& c, bool is_a);

// The mover before a block on the way to the base; -1 of all others.
inline int parentOf(const IslandScratch& s, int mover) {
  const int block = mover - s.first_block;
  return block >= 0 && block < static_cast<int>(s.block_parent.size()) ? s.block_parent[static_cast<std::size_t>(block)]
                                                                       : -1;
}

// Fills Island::holds_trees.
bool holdsTrees(const IslandScratch& s, const Island& island);

// A's block of a contact's side and one of the movers of that.
[[gnu::noinline]] void fillTreeSide(const WorldModel& model, WorldScratch& scratch, const Contact& c, int rows,
                                    bool is_a, int mover, ContactSide& out);

}  // namespace pincer::engine
