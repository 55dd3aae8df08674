// facing_tree: boxes with normal cones in a tree, for finding the parts of a
// surface that are near a point and may face it.
//
// Each node holds the bounds of its up to four children side by side (four_lanes.h): one visit tests all of them. Built
// top-down: items are split at the median along the axis on which their centres spread most, so that leaves of four are
// full and the depth is the logarithm of their number. Bounds are kept in single precision, rounded outwards.
#pragma once
#include <algorithm>
#include <array>
#include <cstdint>
#include <functional>
#include <span>
#include <utility>
#include <vector>

#include "pincer/contact/assert.h"
#include "pincer/contact/surface/four_lanes.h"

namespace pincer::contact {

struct FacingBox {
  std::array<float, 3> low, high;  // [m]
  NormalCone cone;
  float hollow = 0;  // the largest concave curvature [1/m]
};

// Which parts are looked for: those whose normal may point to the point searched from, or also
// those that have it straight behind them.
enum class Facing : std::uint8_t { front, both };

class FacingTree {
 public:
  FacingTree() = default;
  // Requires at least one box. `progress` is told the share of the work done.
  FacingTree(const std::vector<FacingBox>& boxes, const std::function<void(double)>& progress);

  // The boxes' numbers in the order of the tree's leaves: leaf i has those at the places 4 i
  // to 4 i + 3, the last one fewer if need be.
  const std::vector<std::int32_t>& order() const { return order_; }
  std::size_t memoryBytes() const {
    return nodes_.capacity() * sizeof(Node) + order_.capacity() * sizeof(std::int32_t);
  }

  // Calls visit(leaf) on all leaves that are nearer to `p` than sqrt(bound2) and may face it, nearer ones first;
  // `bound2` [m^2] may shrink meanwhile. Stops once visit returns false. Allocates nothing.
  template <class Visit>
  void visitFacing(const Vec3& p, const double& bound2, Facing facing, Visit&& visit) const;

  // Calls visit(leaf) on all leaves that `p` may come to be nearer to than `reach` and to face before it has
  // moved by `horizon` [m], which may shrink meanwhile; without those whose cones are `passed`. Allocates nothing.
  template <class Visit>
  void visitNear(const Vec3& p, double reach, const double& horizon, const ConesAlong& passed, Visit&& visit) const;

  // Calls visit(leaf) on all leaves that the box touches, until it returns false.
  template <class Visit>
  void visitInBox(const Vec3& low, const Vec3& high, Visit&& visit) const;

  // Calls visit(leaf) on all leaves for which, and for all that holds them,
  // test(Children) is true, until it returns false.
  template <class Test, class Visit>
  void visitWhere(Test&& test, Visit&& visit) const;

  // The bounds of a node's children; of a lane without one the box is inside out.
  struct Children {
    std::array<Lanes, 3> low, high;
    Lanes radius;  // of the balls around the boxes [m]
    Lanes hollow;
    LaneCones cones;

    struct Distances {
      Lanes box2, centre2, along;
    };
    Distances distancesFrom(const LanesPoint& p, Lanes widening) const;
    std::array<Lanes, 3> centre() const {
      return {0.5f * (low[0] + high[0]), 0.5f * (low[1] + high[1]), 0.5f * (low[2] + high[2])};
    }
  };

  // Largest error of single precision in a distance to `p`, and some more [m].
  double rounding(const Vec3& p) const { return 4e-7 * (p.cwiseAbs().maxCoeff() + extent_); }

 private:
  static constexpr std::size_t kMostWaiting = 64;  // nodes: three per level at most, of at most sixteen levels

  struct Node : Children {
    std::array<std::int32_t, kLanes> child;  // >= 0: a node; < 0: leaf -1 - child
  };
  struct Range {
    std::int32_t begin, end;  // of places
  };

  struct Bounds {
    FacingBox box;
    float radius;
  };
  Bounds build(std::size_t node, Range range, const std::vector<FacingBox>& boxes);
  Bounds boundsOfLeaf(Range range, const std::vector<FacingBox>& boxes) const;
  std::int32_t halve(Range range, std::int32_t child, const std::vector<FacingBox>& boxes);
  const Node& at(std::int32_t i) const { return nodes_[static_cast<std::size_t>(i)]; }

  std::vector<Node> nodes_;
  std::vector<std::int32_t> order_;
  double extent_ = 0;  // the largest coordinate of all boxes [m]
  std::function<void(double)> progress_;
};

inline FacingTree::Children::Distances FacingTree::Children::distancesFrom(const LanesPoint& p, Lanes widening) const {
  Distances d{};
  for (std::size_t k = 0; k < 3; ++k) {
    const Lanes D = p.x[k] - 0.5f * (low[k] + high[k]);
    const Lanes out = greaterOf(greaterOf(low[k] - p.x[k], p.x[k] - high[k]) - widening, Lanes{});
    d.box2 += out * out;
    d.centre2 += D * D;
    d.along += cones.axis[k] * D;
  }
  return d;
}

template <class Visit>
void FacingTree::visitFacing(const Vec3& p, const double& bound2, Facing facing, Visit&& visit) const {
  struct Entry {
    std::int32_t node;
    float distance2;
  };
  std::array<Entry, kMostWaiting> stack;
  std::size_t size = 0;
  const LanesPoint x(p);
  const Lanes widening = LanesPoint::toLanes(rounding(p));
  stack[size++] = {0, 0};
  while (size > 0) {
    const Entry entry = stack[--size];
    if (entry.distance2 >= bound2) continue;
    if (entry.node < 0) {
      if (!visit(-1 - entry.node)) return;
      continue;
    }
    const Node& node = at(entry.node);
    const auto d = node.distancesFrom(x, widening);
    LaneMask may_face = node.cones.mayFace(d.along, d.centre2, node.radius + widening);
    if (facing == Facing::both) may_face |= node.cones.mayFace(-d.along, d.centre2, node.radius + widening);
    const std::size_t first = size;
    for (int i = 0; i < kLanes; ++i) {
      if (!may_face[i] || !(d.box2[i] < bound2)) continue;
      PINCER_ASSERT(size < stack.size());
      std::size_t to = size++;
      for (; to > first && stack[to - 1].distance2 < d.box2[i]; --to) stack[to] = stack[to - 1];
      stack[to] = {node.child[static_cast<std::size_t>(i)], d.box2[i]};
    }
  }
}

template <class Test, class Visit>
void FacingTree::visitWhere(Test&& test, Visit&& visit) const {
  std::array<std::int32_t, kMostWaiting> waiting;
  std::size_t size = 0;
  waiting[size++] = 0;
  while (size > 0) {
    const std::int32_t top = waiting[--size];
    if (top < 0) {
      if (!visit(-1 - top)) return;
      continue;
    }
    const Node& node = at(top);
    const LaneMask wanted = test(node);
    for (int i = kLanes - 1; i >= 0; --i) {
      PINCER_ASSERT(!wanted[i] || size < waiting.size());
      if (wanted[i]) waiting[size++] = node.child[static_cast<std::size_t>(i)];
    }
  }
}

template <class Visit>
void FacingTree::visitNear(const Vec3& p, double reach, const double& horizon, const ConesAlong& passed,
                           Visit&& visit) const {
  const LanesPoint x(p);
  const double rounded = rounding(p);
  const Lanes widening = LanesPoint::toLanes(rounded);
  const auto comesNear = [&](const Children& c) {
    const auto d = c.distancesFrom(x, widening);
    const Lanes outer = LanesPoint::toLanes(reach + horizon + rounded);
    return (d.box2 < outer * outer) &
           c.cones.mayFace(d.along, d.centre2, c.radius + LanesPoint::toLanes(horizon + rounded)) &
           ~passed.hold(c.cones);
  };
  visitWhere(comesNear, [&](std::int32_t leaf) {
    visit(leaf);
    return true;
  });
}

template <class Visit>
void FacingTree::visitInBox(const Vec3& low, const Vec3& high, Visit&& visit) const {
  std::array<Lanes, 3> from, to;
  for (int k = 0; k < 3; ++k) {
    from[static_cast<std::size_t>(k)] = inAllLanes(below(low[k]));
    to[static_cast<std::size_t>(k)] = inAllLanes(above(high[k]));
  }
  const auto touches = [&](const Children& c) {
    LaneMask touch = (c.low[0] <= to[0]) & (c.high[0] >= from[0]);
    for (std::size_t k = 1; k < 3; ++k) touch &= (c.low[k] <= to[k]) & (c.high[k] >= from[k]);
    return touch;
  };
  visitWhere(touches, visit);
}

}  // namespace pincer::contact
