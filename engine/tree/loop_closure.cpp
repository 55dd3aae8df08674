#include "pincer/engine/tree/loop_closure.h"

#include <algorithm>
#include <cmath>

#include "pincer/engine/tree/slot.h"
#include "pincer/engine/tree/tree_inertia.h"

namespace pincer::engine {
namespace {

constexpr double kLoopClosed = 1e-16;  // [m, rad]: nothing that a double of a robot's size can tell

// A link or the base: J on it, and a point that moves with it.
struct LoopSide {
  Pose X_OJ;
  Vec3 p_O;  // the point
  Motion motion;
};

LoopSide loopSideOf(const TreeModel& tree, const TreeBase& base, const TreePlace& place, int link, const Pose& X_LJ) {
  if (link < 0) {
    const Vec3& p_BO = tree.links.front().X_PJ.p;
    return {{base.X_WB.q * X_LJ.q, base.X_WB.q * (X_LJ.p - p_BO)}, base.X_WB.q * -p_BO, base.motion};
  }
  const LinkPlace& at = place.links[slot(link)];
  return {{at.q_WL * X_LJ.q, at.p_OL + at.q_WL * X_LJ.p}, at.p_OL, at.motion};
}

struct LoopSides {
  LoopSide a, b;
};
LoopSides loopSidesOf(const TreeModel& tree, const TreeBase& base, const TreePlace& place, const TreeLoop& loop) {
  return {loopSideOf(tree, base, place, loop.a, loop.X_AJ), loopSideOf(tree, base, place, loop.b, loop.X_BJ)};
}

int turnRowsOf(JointKind kind) { return rowsOf(kind) - pointRowsOf(kind); }

// Of a pivot any angle is allowed: a miss is the turn of a's axis.
Vec3 turnMissed(JointKind kind, const Pose& a, const Pose& b) {
  if (kind == JointKind::kPivot) return (b.q * Vec3::UnitZ()).cross(a.q * Vec3::UnitZ());
  const Quat q = b.q.conjugate() * a.q;
  return b.q * ((q.w() < 0 ? -2.0 : 2.0) * q.vec());
}

// f(row, direction, True if of the point) of each row of a loop; returns the next loop's first row.
template <class F>
std::size_t forEachRow(JointKind kind, const Quat& q_OJ, std::size_t first, F f) {
  const Mat3 axes_W = q_OJ.toRotationMatrix();
  for (int k = 0; k < pointRowsOf(kind); ++k) f(first++, Vec3(axes_W.col(k)), true);
  for (int k = 0; k < turnRowsOf(kind); ++k) f(first++, Vec3(axes_W.col(k)), false);
  return first;
}

void addLinkRow(const TreeModel& tree, const TreePlace& place, int link, const Vec3& p_OX, double sign,
                const Vec3& axis_W, bool is_point, std::span<double> G) {
  if (link < 0) return;
  const Vec3 along_W = sign * axis_W;
  addJacobian(tree, place, link, p_OX, is_point ? along_W : Vec3(Vec3::Zero()), is_point ? Vec3(Vec3::Zero()) : along_W,
              G);
}

struct CentreAcceleration {
  Vec3 a_W, alpha_W;
};
CentreAcceleration centreOf(const TreeBase& base, const Vec3& gravity_W, std::span<const LinkBias> biases, int link) {
  if (link < 0) return {base.a_W - gravity_W, base.alpha_W};
  return {biases[slot(link)].a_W, biases[slot(link)].alpha_W};
}
Vec3 accelerationOfPoint(const Vec3& p_OX, const LoopSide& side, const CentreAcceleration& centre) {
  const Vec3 r_W = p_OX - side.p_O;
  return centre.a_W + centre.alpha_W.cross(r_W) + side.motion.w_W.cross(side.motion.w_W.cross(r_W));
}
Vec3 velocityOfPoint(const Vec3& p_OX, const LoopSide& side) {
  return side.motion.v_W + side.motion.w_W.cross(p_OX - side.p_O);
}

// rows.change <- the least change in the metric of the factor with G times it = rows.want.
void findChange(const TreeModel& tree, const TreeFactor& factor, const LoopBasis& basis, LoopRows& rows) {
  basis.closing(rows.want, rows.change);
  unscale(tree, factor, rows.change);
}

void factoriseLoops(const TreeModel& tree, const TreeFactor& factor, LoopRows& rows, LoopBasis& basis) {
  for (std::size_t k = 0; k < rows.want.size(); ++k) {
    const std::span<double> scaled = basis.row(static_cast<int>(k)), own = rows.row(k);
    std::copy(own.begin(), own.end(), scaled.begin());
    scaleOpenRow(tree, factor, tree.columnCount() - 1, scaled);
  }
  basis.factorise();
}

}  // namespace

LoopRows::LoopRows(const TreeModel& tree) : change(tree.loops.empty() ? 0 : tree.before.size()) {
  std::size_t count = 0;
  for (const TreeLoop& loop : tree.loops) count += slot(rowsOf(loop.kind));
  G.resize(count * change.size());
  miss.resize(count);
  want.resize(count);
}

void fillLoops(const TreeModel& tree, const TreeBase& base, const TreePlace& place, LoopRows& rows) {
  std::fill(rows.G.begin(), rows.G.end(), 0.0);
  std::size_t next = 0;
  for (const TreeLoop& loop : tree.loops) {
    const LoopSides sides = loopSidesOf(tree, base, place, loop);
    const LoopSide &a = sides.a, &b = sides.b;
    const Vec3 apart_W = a.X_OJ.p - b.X_OJ.p, turned_W = turnMissed(loop.kind, a.X_OJ, b.X_OJ);
    next = forEachRow(loop.kind, b.X_OJ.q, next, [&](std::size_t k, const Vec3& axis_W, bool is_point) {
      addLinkRow(tree, place, loop.a, a.X_OJ.p, 1, axis_W, is_point, rows.row(k));
      addLinkRow(tree, place, loop.b, a.X_OJ.p, -1, axis_W, is_point, rows.row(k));
      rows.miss[k] = axis_W.dot(is_point ? apart_W : turned_W);
    });
  }
}

bool factoriseClosed(const TreeModel& tree, LoopRows& rows, TreeFactor& factor) {
  const bool is_positive = factorise(tree, factor);
  if (!tree.loops.empty()) factoriseLoops(tree, factor, rows, factor.loops);
  return is_positive;
}

void wantNoOpening(std::span<const double> u, LoopRows& rows) {
  for (std::size_t k = 0; k < rows.want.size(); ++k) {
    const std::span<const double> G = rows.row(k);
    rows.want[k] = 0;
    for (std::size_t c = 0; c < u.size(); ++c) rows.want[k] -= G[c] * u[c];
  }
}

void wantBend(const TreeModel& tree, const TreeBase& base, const Vec3& gravity_W, const TreePlace& place,
              std::span<const LinkBias> biases, double share, LoopRows& rows) {
  std::size_t next = 0;
  for (const TreeLoop& loop : tree.loops) {
    const LoopSides sides = loopSidesOf(tree, base, place, loop);
    const LoopSide &a = sides.a, &b = sides.b;
    const Vec3 p_OX = a.X_OJ.p, u_W = velocityOfPoint(p_OX, a) - velocityOfPoint(p_OX, b);
    const CentreAcceleration of_a = centreOf(base, gravity_W, biases, loop.a),
                             of_b = centreOf(base, gravity_W, biases, loop.b);
    const Vec3 point_W =
        accelerationOfPoint(p_OX, a, of_a) - accelerationOfPoint(p_OX, b, of_b) - 2 * b.motion.w_W.cross(u_W);
    const Vec3 turn_W = of_a.alpha_W - of_b.alpha_W - b.motion.w_W.cross(a.motion.w_W - b.motion.w_W);
    next = forEachRow(loop.kind, b.X_OJ.q, next, [&](std::size_t k, const Vec3& axis_W, bool is_point) {
      rows.want[k] -= share * axis_W.dot(is_point ? point_W : turn_W);
    });
  }
}

void addWanted(const TreeModel& tree, const TreeFactor& factor, LoopRows& rows, std::span<double> x) {
  findChange(tree, factor, factor.loops, rows);
  for (std::size_t c = 0; c < x.size(); ++c) x[c] += rows.change[c];
}

double closeLoops(const TreeModel& tree, const TreeBase& base, const TreeFactor& factor, int passes, LoopRows& rows,
                  LoopBasis& basis, std::span<double> q, std::span<double> u, TreePlace& place) {
  double worst = 0;
  for (int pass = 0;; ++pass) {
    fillLoops(tree, base, place, rows);
    factoriseLoops(tree, factor, rows, basis);
    worst = 0;
    for (std::size_t k = 0; k < rows.miss.size(); ++k) {
      worst = std::max(worst, std::abs(rows.miss[k]));
      rows.want[k] = -rows.miss[k];
    }
    if (worst <= kLoopClosed || pass == passes) break;
    findChange(tree, factor, basis, rows);
    growCoordinates(tree, q, rows.change, q);
    placeLinks(tree, base, q, place);
  }
  wantNoOpening(u, rows);
  findChange(tree, factor, basis, rows);
  for (std::size_t c = 0; c < u.size(); ++c) u[c] += rows.change[c];
  moveLinks(tree, base, q, u, place);
  return worst;
}

int blockedNear(const TreeModel& tree, std::span<double> q) {
  constexpr int kPasses = 30;         // from a start that is off by much of a turn
  constexpr double kIsClosed = 1e-9;  // [m, rad]
  TreePlace place(tree);
  placeLinks(tree, {}, q, place);
  std::vector<CompositeInertia> composite(tree.links.size());
  TreeFactor factor(tree);
  fillInertia(tree, place, composite, factor.entries);
  LoopRows rows(tree);
  if (!factorise(tree, factor)) return 0;
  std::vector<double> u(tree.before.size());
  const double miss = closeLoops(tree, {}, factor, kPasses, rows, factor.loops, q, u, place);
  return miss <= kIsClosed ? factor.loops.rank() : 0;
}

}  // namespace pincer::engine
