#include "pincer/engine/tree/tree_inertia.h"

#include <algorithm>

#include "pincer/engine/tree/slot.h"
#include "pincer/engine/tree/sparse_ldl.h"

namespace pincer::engine {
namespace {

// m (|d|^2 - d d^T)
Mat3 spread(double m, const Vec3& d) { return m * (d.squaredNorm() * Mat3::Identity() - d * d.transpose()); }

CompositeInertia ownInertia(const TreeLink& link, const LinkPlace& at_link) {
  const Mat3 R = at_link.q_WL.toRotationMatrix();
  const Vec3 arm_W = at_link.p_OL - at_link.p_OJ;
  return {link.mass, link.mass * arm_W, R * link.moments.asDiagonal() * R.transpose() + spread(link.mass, arm_W)};
}

// An inertia about a point that lies at `d` from where it is wanted.
void addShifted(const CompositeInertia& part, const Vec3& d, CompositeInertia& sum) {
  const Mat3 across = part.first * d.transpose();
  sum.mass += part.mass;
  sum.first += part.first + part.mass * d;
  sum.second +=
      part.second + spread(part.mass, d) + 2 * across.trace() * Mat3::Identity() - across - across.transpose();
}

// Momentum of a unit of the coordinate's rate: linear, and about the joint.
struct Momentum {
  Vec3 p_W, L_W;
};
Momentum momentumOf(const CompositeInertia& inertia, bool slides, const Vec3& axis_W) {
  if (slides) return {inertia.mass * axis_W, inertia.first.cross(axis_W)};
  return {axis_W.cross(inertia.first), inertia.second * axis_W};
}

void addToColumns(const TreeModel& tree, int a, int b, double value, std::span<double> M) {
  if (a == b) {
    M[entryOf(tree, a, a)] += 2 * value;
  } else {
    M[entryOf(tree, std::max(a, b), std::min(a, b))] += value;
  }
}

// Row of coordinate j: what each coordinate on its way to the base feels of it.
void addCoordinate(const TreeModel& tree, const TreePlace& place, std::size_t j, const CompositeInertia& inertia,
                   std::span<double> M) {
  const TreeCoordinate& own = tree.coordinates[j];
  const int link = own.link;
  const CoordinatePlace& moved = place.coordinates[j];
  const Momentum m = momentumOf(inertia, tree.links[slot(link)].kind == JointKind::kSlider, moved.axis_W);
  forEachCoordinateOf(tree, link, [&](std::size_t i) {
    if (i > j) return;  // of a ball, seen from the other one
    const TreeCoordinate& other = tree.coordinates[i];
    const CoordinatePlace& felt = place.coordinates[i];
    const bool slides = tree.links[slot(other.link)].kind == JointKind::kSlider;
    const Vec3 arm_W = place.links[slot(link)].p_OJ - place.links[slot(other.link)].p_OJ;
    const double value = moved.share * felt.share * felt.axis_W.dot(slides ? m.p_W : Vec3(m.L_W + arm_W.cross(m.p_W)));
    if (i == j) {
      M[entryOf(tree, own.column, own.column)] += value + moved.share * moved.share * own.traits.armature;
    } else {
      addToColumns(tree, own.column, other.column, value, M);
    }
  });
}

}  // namespace

void fillInertia(const TreeModel& tree, const TreePlace& place, std::span<CompositeInertia> composite,
                 std::span<double> M) {
  std::fill(M.begin(), M.end(), 0.0);
  for (std::size_t l = 0; l < tree.links.size(); ++l) composite[l] = ownInertia(tree.links[l], place.links[l]);
  for (std::size_t l = tree.links.size(); l-- > 0;) {
    const TreeLink& link = tree.links[l];
    for (int k = 0; k < coordinatesOf(link.kind); ++k)
      addCoordinate(tree, place, slot(link.first_v + k), composite[l], M);
    if (link.parent >= 0)
      addShifted(composite[l], place.links[l].p_OJ - place.links[slot(link.parent)].p_OJ, composite[slot(link.parent)]);
  }
}

}  // namespace pincer::engine
