#include "pincer/engine/world/tree_sides.h"

#include <algorithm>
#include <cmath>

#include "pincer/contact/functions/invariants.h"
#include "pincer/engine/world/joint_rows.h"

namespace pincer::engine {
namespace {

int firstBlock(const WorldModel& model) { return static_cast<int>(model.bodies.size() + model.points.size()); }

int moverOfColumn(const WorldModel& model, const TreeModel& tree, int column) {
  const int tip = tipOfRow(tree, column);
  return tip < 0 ? -1 : firstBlock(model) + tree.first_block + tree.block_of[tip];
}

int outermostOf(const TreeModel& tree, const JointRowScratch& row) {
  if (row.kind != JointRowKind::kDrive) return tree.coordinates[row.element].column;
  int tip = -1;
  for (const TreeDrive::Term& term : tree.drives[row.element].terms)
    tip = std::max(tip, tree.coordinates[term.coordinate].column);
  return tip;
}

// The columns of a block out of a row that is 0 but on the path of `tip`.
void takeBlock(const TreeModel& tree, int block, int tip, std::span<const double> row, double* A) {
  for (int c = tip; c >= 0; c = tree.before[c]) {
    if (tree.block_of[c] == block) A[tree.column_in_block[c]] = row[c];
  }
}

void fillLinkSide(const WorldModel& model, WorldScratch& scratch, const Contact& c, int rows, bool is_a, int block,
                  ContactSide& out) {
  const BodyModel& body = model.bodies[(is_a ? c.a : c.b).index];
  const TreeModel& tree = model.trees[body.tree];
  TreeScratch& s = scratch.trees[body.tree];
  const Vec3 p_OX = s.course.mid.links[body.link].p_OL + (is_a ? c.arm_a_W : c.arm_b_W);
  const double sign = is_a ? 1 : -1;
  const int tip = tree.links[body.link].tip;
  for (int k = 0; k < rows; ++k) {
    std::fill(s.row.begin(), s.row.end(), 0.0);
    const bool turns = k >= kTorsionRow;
    const Vec3 n_W = turns ? Vec3(Vec3::Zero()) : Vec3(sign * c.R_WC.col(k)),
               m_W = turns ? Vec3((sign * radiusOf(c, k)) * axisOf(c, k)) : Vec3(Vec3::Zero());
    addJacobian(tree, s.course.mid, body.link, p_OX, n_W, m_W, s.row);
    takeBlock(tree, block, scaleRow(tree, s.course.factor, tip, s.row), s.row, out.A[k]);
  }
}

// Fills the columns of the row's own mover: joint_rows.h.
void fillOwnSide(const JointRowScratch& row, ContactSide& out) {
  const double root = std::sqrt(row.mobility);
  if (!row.isBrake()) {
    out.A[0][0] = out.A[1][1] = root;
    return;
  }
  out.A[1][0] = root;
  out.A[2][1] = std::sqrt(row.grip);
  if (row.kind == JointRowKind::kDrive) out.A[0][2] = std::sqrt(row.compliance);
}

}  // namespace

std::size_t moverCount(const WorldModel& model) {
  std::size_t count = static_cast<std::size_t>(firstBlock(model) + model.tree_block_count);
  if (!model.trees.empty()) count += static_cast<std::size_t>(3 * model.tree_coordinate_count) + model.drives.size();
  return count;
}

void findBlocks(const WorldModel& model, IslandScratch& s) {
  s.first_block = firstBlock(model);
  int longest = 1;
  for (const TreeModel& tree : model.trees) {
    for (const TreeBlock& block : tree.blocks) {
      int depth = 1;
      for (int before = block.parent; before >= 0; before = tree.blocks[before].parent) ++depth;
      longest = std::max(longest, depth);
      s.block_parent.push_back(block.parent < 0 ? -1 : s.first_block + tree.first_block + block.parent);
    }
  }
  s.sides_per_contact = 2 * longest;
}

bool holdsTrees(const IslandScratch& s, const Island& island) {
  const int* const order = s.order.data() + island.place;
  return !s.block_parent.empty() && std::any_of(order, order + island.contacts, [&](int i) {
    return std::max(s.ends[i].a, s.ends[i].b) >= s.first_block;
  });
}

int moverOfLink(const WorldModel& model, const BodyModel& link) {
  const TreeModel& tree = model.trees[link.tree];
  return moverOfColumn(model, tree, tree.links[link.link].tip);
}

int moverOfRow(const WorldModel& model, const WorldScratch& scratch, const Contact& c, bool is_a) {
  if (!is_a) return firstBlock(model) + model.tree_block_count + c.a.index;
  const JointRowScratch& row = scratch.joint_rows[c.a.index];
  const TreeModel& tree = model.trees[row.tree];
  return moverOfColumn(model, tree, outermostOf(tree, row));
}

void fillTreeSide(const WorldModel& model, WorldScratch& scratch, const Contact& c, int rows, bool is_a, int mover,
                  ContactSide& out) {
  for (int k = 0; k < rows; ++k) std::fill(out.A[k], out.A[k] + kMoverFreedoms, 0.0);
  const Side& side = is_a ? c.a : c.b;
  if (side.kind == SideKind::kBody) {
    const TreeModel& tree = model.trees[model.bodies[side.index].tree];
    return fillLinkSide(model, scratch, c, rows, is_a, mover - firstBlock(model) - tree.first_block, out);
  }
  const JointRowScratch& row = scratch.joint_rows[c.a.index];
  if (!is_a) return fillOwnSide(row, out);
  TreeScratch& s = scratch.trees[row.tree];
  const int tip = scaledRow(model, row, s);
  const TreeModel& tree = model.trees[row.tree];
  takeBlock(tree, mover - firstBlock(model) - tree.first_block, tip, s.row, out.A[row.isBrake() ? 0 : kNormalRow]);
}

}  // namespace pincer::engine
