#include "pincer/engine/tree/tree_pattern.h"

#include <algorithm>
#include <set>

#include "pincer/contact/assert.h"
#include "pincer/engine/solve/contact_problem.h"
#include "pincer/engine/tree/slot.h"

namespace pincer::engine {
namespace {

constexpr int kNobody = -1;  // a coordinate that follows none

using Columns = std::set<int>;  // in ascending order

void numberColumns(TreeModel& tree) {
  tree.column_coordinate.clear();
  for (std::size_t i = 0; i < tree.coordinates.size(); ++i) {
    if (tree.coordinates[i].leader != kNobody) continue;
    tree.coordinates[i].column = static_cast<int>(tree.column_coordinate.size());
    tree.column_coordinate.push_back(static_cast<int>(i));
  }
  for (TreeCoordinate& follower : tree.coordinates) {
    if (follower.leader == kNobody) continue;
    PINCER_ASSERT(tree.coordinates[slot(follower.leader)].leader == kNobody);
    follower.column = tree.coordinates[slot(follower.leader)].column;
  }
}

void linkCoordinates(TreeModel& tree) {
  std::vector<int> last(tree.links.size(), kNobody);
  for (std::size_t l = 0; l < tree.links.size(); ++l) {
    const TreeLink& link = tree.links[l];
    last[l] = link.parent == kNobody ? kNobody : last[slot(link.parent)];
    for (int k = 0; k < coordinatesOf(link.kind); ++k) {
      tree.coordinates[slot(link.first_v + k)].parent = last[l];
      last[l] = link.first_v + k;
    }
  }
}

std::vector<Columns> columnsOfLinks(const TreeModel& tree) {
  std::vector<Columns> moving(tree.links.size());
  for (std::size_t l = 0; l < tree.links.size(); ++l) {
    const TreeLink& link = tree.links[l];
    if (link.parent != kNobody) moving[l] = moving[slot(link.parent)];
    for (int k = 0; k < coordinatesOf(link.kind); ++k)
      moving[l].insert(tree.coordinates[slot(link.first_v + k)].column);
  }
  return moving;
}

// Per column those further in that it sees at first.
std::vector<Columns> whoSeesWhom(const TreeModel& tree, const std::vector<Columns>& links) {
  std::vector<Columns> seen(tree.column_coordinate.size());
  const auto see = [&](const Columns& all) {
    for (const int c : all) seen[slot(c)].insert(all.begin(), all.find(c));
  };
  for (const Columns& moving : links) see(moving);
  for (const TreeDrive& drive : tree.drives) {
    Columns tied;
    for (const TreeDrive::Term& term : drive.terms) tied.insert(tree.coordinates[slot(term.coordinate)].column);
    see(tied);
  }
  if (!tree.loops.empty()) {
    Columns all;
    for (std::size_t c = 0; c < seen.size(); ++c) all.insert(static_cast<int>(c));
    see(all);
  }
  return seen;
}

void findPaths(TreeModel& tree, std::vector<Columns> seen) {
  const int n = static_cast<int>(seen.size());
  tree.before.assign(slot(n), kNobody);
  tree.depth.assign(slot(n), 0);
  tree.row.assign(slot(n), 0);
  for (int c = n - 1; c >= 0; --c) {
    if (seen[slot(c)].empty()) continue;
    const int next = *seen[slot(c)].rbegin();
    tree.before[slot(c)] = next;
    seen[slot(c)].erase(next);
    seen[slot(next)].insert(seen[slot(c)].begin(), seen[slot(c)].end());
  }
  tree.entries = 0;
  for (int c = 0; c < n; ++c) {
    if (tree.before[slot(c)] != kNobody) tree.depth[slot(c)] = tree.depth[slot(tree.before[slot(c)])] + 1;
    tree.row[slot(c)] = tree.entries;
    tree.entries += tree.depth[slot(c)] + 1;
  }
}

// Runs of freedoms without a branch (those of a tree with loops are one), cut after as many as a mover has. A run's
// columns needn't be neighbours by number: what lies between belongs to another branch; they are put in order first.
void findBlocks(TreeModel& tree) {
  const std::size_t n = tree.before.size();
  std::vector<int> children(n, 0);
  for (const int before : tree.before) {
    if (before != kNobody) ++children[slot(before)];
  }
  tree.blocks.clear();
  tree.block_of.assign(n, kNobody);
  tree.column_in_block.assign(n, 0);
  for (std::size_t c = 0; c < slot(tree.freedomCount()); ++c) {
    const int before = tree.before[c];
    const int inner = before == kNobody ? kNobody : tree.block_of[slot(before)];
    const bool goes_on =
        before != kNobody && children[slot(before)] == 1 && tree.blocks[slot(inner)].count < kMoverFreedoms;
    if (!goes_on) {
      tree.blocks.push_back({static_cast<int>(c), 0, inner});
    }
    const int block = goes_on ? inner : static_cast<int>(tree.blocks.size()) - 1;
    tree.block_of[c] = block;
    tree.column_in_block[c] = tree.blocks[slot(block)].count++;
  }
}

void findTips(TreeModel& tree, const std::vector<Columns>& links) {
  for (std::size_t l = 0; l < links.size(); ++l) tree.links[l].tip = links[l].empty() ? kNobody : *links[l].rbegin();
}

}  // namespace

void finishTree(TreeModel& tree) {
  numberColumns(tree);
  linkCoordinates(tree);
  const std::vector<Columns> links = columnsOfLinks(tree);
  findPaths(tree, whoSeesWhom(tree, links));
  findBlocks(tree);
  findTips(tree, links);
}

}  // namespace pincer::engine
