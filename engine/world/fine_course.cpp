#include "pincer/engine/world/fine_course.h"

#include <algorithm>
#include <cmath>

#include "pincer/engine/world/joint_row_parts.h"
#include "pincer/engine/world/rest.h"
#include "pincer/engine/world/tree_motion.h"

namespace pincer::engine {
namespace {

bool isFriction(const WorldScratch& scratch, const Side& side) {
  return side.kind == SideKind::kJoint && scratch.joint_rows[side.index].kind == JointRowKind::kFriction;
}

int treeOf(const WorldModel& model, const WorldScratch& scratch, const Side& side) {
  if (side.kind == SideKind::kJoint) return scratch.joint_rows[side.index].tree;
  return side.kind == SideKind::kBody ? model.bodies[side.index].tree : -1;
}

// Calls f(row) of each brake of the tree that has a row.
template <typename F>
void forEachBrake(WorldScratch& scratch, int tree, F f) {
  for (JointRowScratch& row : scratch.joint_rows) {
    if (row.tree == tree && row.kind == JointRowKind::kFriction && row.wanted) f(row);
  }
}

// A brake that gives all it has, against the motion, from the start to the end.
bool slidesThroughout(const TreeModel& tree, const TreeScratch& s, std::span<const double> u,
                      const JointRowScratch& row) {
  const double r = row.impulse_W.x(), start = rateOf(tree, s.course.mid, row.element, u);
  return row.touched && std::abs(r) >= (1 - kResidue) * row.limit && endRate(tree, s, row.element) * r < 0 &&
         start * r <= 0;
}

// A brake that holds what stood at the start.
bool holdsThroughout(const TreeModel& tree, std::span<const double> u, const JointRowScratch& row) {
  return !tree.has_couplings && tree.loops.empty() && u[tree.coordinates[row.element].column] == 0 &&
         std::abs(row.impulse_W.x()) < (1 - kResidue) * row.limit;
}

bool goesFree(const WorldModel& model, const WorldState& state, WorldScratch& scratch, int t) {
  const TreeModel& tree = model.trees[t];
  const TreeScratch& s = scratch.trees[t];
  const std::span<const double> u = treeRates(tree, state);
  if (s.is_near || s.course.fine || !s.course.soft || s.course.rough || !scratch.impact_pairs.empty()) return false;
  bool moves = false, is_free = true;
  for (std::size_t c = 0; c < u.size(); ++c) {
    moves = moves || std::abs(u[c]) > kRestSpeed || std::abs(s.course.u_free[c]) > kRestSpeed;
    if (s.has_locked && s.locked[c] && u[c] != 0) is_free = false;
  }
  forEachBrake(scratch, t, [&](const JointRowScratch& row) {
    is_free = is_free && (holdsThroughout(tree, u, row) || slidesThroughout(tree, s, u, row));
  });
  return moves && is_free;
}

// Stops and friction let it go this way.
bool isAllowed(const TreeModel& tree, const TreeScratch& s, std::span<const double> q) {
  for (int i = 0; i < tree.coordinateCount(); ++i) {
    if (s.constant[i] * rateOf(tree, s.course.mid, i, s.course.u_free) > 0) return false;
    const TreeCoordinate& own = tree.coordinates[i];
    if (own.q < 0) continue;
    const double end = q[own.q] + rateOf(tree, s.course.mid, i, s.course.way_free);
    if (!(end >= own.traits.lower && end <= own.traits.upper)) return false;
  }
  return true;
}

}  // namespace

void noteNearTrees(const WorldModel& model, WorldScratch& scratch) {
  const auto may_be_refined = [](const TreeScratch& s) { return s.course.soft && !s.course.fine; };
  if (std::none_of(scratch.trees.begin(), scratch.trees.end(), may_be_refined)) return;
  for (TreeScratch& s : scratch.trees) s.is_near = false;
  forEachContact(scratch, [&](const Contact& c) {
    for (const Side* side : {&c.a, &c.b}) {
      const int tree = treeOf(model, scratch, *side);
      if (tree >= 0 && !isFriction(scratch, *side)) scratch.trees[tree].is_near = true;
    }
  });
}

void refineCourse(const WorldModel& model, const WorldState& state, WorldScratch& scratch, int t) {
  if (!goesFree(model, state, scratch, t)) return;
  const TreeModel& tree = model.trees[t];
  TreeScratch& s = scratch.trees[t];
  const std::span<const double> q = treeCoordinates(tree, state), u = treeRates(tree, state);
  const bool had_locked = s.has_locked;
  forEachBrake(scratch, t, [&](const JointRowScratch& row) {
    const bool holds = holdsThroughout(tree, u, row);
    s.has_locked = s.has_locked || holds;
    s.locked[tree.coordinates[row.element].column] = holds ? 1 : 0;
    s.constant[row.element] = holds ? 0 : row.impulse_W.x() / scratch.h;
  });
  s.old_free = s.course.u_free;
  s.old_way = s.course.way_free;
  goByRungeKutta(tree, s.base, pushOn(scratch, tree, s), q, u, scratch.h, s.course);
  const bool is_allowed = isAllowed(tree, s, q);
  s.has_locked = had_locked;
  forEachBrake(scratch, t, [&](const JointRowScratch& row) {
    s.locked[tree.coordinates[row.element].column] = 0;
    s.constant[row.element] = 0;
  });
  if (is_allowed) {
    std::fill(s.gained.begin(), s.gained.end(), 0.0);
  } else {
    s.course.fine = false;
    s.course.u_free = s.old_free;
    s.course.way_free = s.old_way;
  }
}

}  // namespace pincer::engine
