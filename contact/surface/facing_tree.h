// facing_tree: boxes with normal cones in a binary tree, for finding the parts of a surface that are near a point and may face it.
//
// Built top-down: each node splits its items at the median along the axis on which their centres spread most, so the depth is the
// logarithm of their number. Bounds are kept in single precision, rounded outwards.
#pragma once
#include <algorithm>
#include <array>
#include <cstdint>
#include <functional>
#include <vector>

#include "contact/surface/normal_cone.h"

namespace pincer::contact {

struct FacingBox {
  std::array<float, 3> low, high;  // [m]
  NormalCone cone;
};

// Which parts are looked for: those whose normal may point to the point searched from, or also those that have it straight behind them.
enum class Facing : std::uint8_t { front, both };

class FacingTree {
 public:
  FacingTree() = default;
  // Requires at least one box. `progress` is told the share of the work done.
  FacingTree(const std::vector<FacingBox>& boxes, const std::function<void(double)>& progress);

  // The boxes' numbers in the order of the tree's leaves: visitors name items by their place in it.
  const std::vector<std::int32_t>& order() const { return order_; }
  std::size_t memoryBytes() const { return nodes_.capacity() * sizeof(Node) + order_.capacity() * sizeof(std::int32_t); }

  // Calls visit(i), for places i of `order`, on the items of all leaves that are nearer to `p` than sqrt(bound2) and may face it, nearer
  // leaves first; `bound2` [m^2] may shrink meanwhile. Stops once visit returns false. Allocates nothing.
  template <class Visit>
  void visitFacing(const Vec3& p, const double& bound2, Facing facing, Visit&& visit) const;

  // Calls visit(i) on the items of all leaves that `p` may come to be nearer to than `reach` and to face before it has moved by `horizon`
  // [m], which may shrink meanwhile; without nodes for whose cone isPassed(cone). Allocates nothing.
  template <class IsPassed, class Visit>
  void visitNear(const Vec3& p, double reach, const double& horizon, IsPassed&& isPassed, Visit&& visit) const;

  // Calls visit(i) on the items of all leaves that the box touches, until it returns false.
  template <class Visit>
  void visitInBox(const Vec3& low, const Vec3& high, Visit&& visit) const;

 private:
  struct Node {
    std::array<float, 3> low, high;
    float radius;  // of the ball around the box [m]
    FacingTest cone;
    std::int32_t left;  // >= 0: the children are left and left + 1; < 0: a leaf of -1 - left = 8 begin + count, its items and their number

    bool isLeaf() const { return left < 0; }
    std::int32_t begin() const { return (-1 - left) / 8; }
    std::int32_t end() const { return begin() + (-1 - left) % 8; }
  };
  static constexpr std::int32_t kLeafSize = 6;
  static constexpr std::size_t kMaxDepth = 64;
  static constexpr double kNever = 1e300;

  NormalCone split(std::size_t node, std::int32_t begin, std::int32_t end, const std::vector<FacingBox>& boxes);
  // Squared distance of `p` from the node's box [m^2], or kNever where the node can be left out.
  static double squaredDistance(const Node& node, const Vec3& p, double bound2, Facing facing);
  // Whether `p` may come to be nearer to the node's box than `outer - horizon` and to face it before it has moved by `horizon` [m].
  static bool comesNear(const Node& node, const Vec3& p, double outer, double horizon);
  static bool overlaps(const Node& node, const Vec3& low, const Vec3& high);
  const Node& at(std::int32_t i) const { return nodes_[static_cast<std::size_t>(i)]; }

  std::vector<Node> nodes_;
  std::vector<std::int32_t> order_;
  std::function<void(double)> progress_;
};

inline double FacingTree::squaredDistance(const Node& node, const Vec3& p, double bound2, Facing facing) {
  double box2 = 0, centre2 = 0, along = 0;
  const auto addAxis = [&](std::size_t k) {
    const double low = node.low[k], high = node.high[k], x = p[static_cast<int>(k)];
    const double D = x - 0.5 * (low + high), out = std::max(std::max(low - x, x - high), 0.0);
    box2 += out * out;
    centre2 += D * D;
    along += node.cone.axis[k] * D;
  };
  addAxis(0);
  addAxis(1);
  addAxis(2);
  if (box2 >= bound2) return kNever;
  const double R = node.radius;
  const bool may_face = node.cone.mayFace(along, centre2, R) || (facing == Facing::both && node.cone.mayFace(-along, centre2, R));
  return may_face ? box2 : kNever;
}

inline bool FacingTree::comesNear(const Node& node, const Vec3& p, double outer, double horizon) {
  double box2 = 0, centre2 = 0, along = 0;
  const auto addAxis = [&](std::size_t k) {
    const double low = node.low[k], high = node.high[k], x = p[static_cast<int>(k)];
    const double D = x - 0.5 * (low + high), out = std::max(std::max(low - x, x - high), 0.0);
    box2 += out * out;
    centre2 += D * D;
    along += node.cone.axis[k] * D;
  };
  addAxis(0);
  addAxis(1);
  addAxis(2);
  return box2 < outer * outer && node.cone.mayFace(along, centre2, node.radius + horizon);
}

inline bool FacingTree::overlaps(const Node& node, const Vec3& low, const Vec3& high) {
  for (int k = 0; k < 3; ++k) {
    const auto i = static_cast<std::size_t>(k);
    if (node.low[i] > high[k] || node.high[i] < low[k]) return false;
  }
  return true;
}

template <class Visit>
void FacingTree::visitFacing(const Vec3& p, const double& bound2, Facing facing, Visit&& visit) const {
  struct Entry {
    std::int32_t node;
    double distance2;
  };
  std::array<Entry, kMaxDepth> stack;
  std::size_t size = 0;
  stack[size++] = {0, 0};
  while (size > 0) {
    const Entry entry = stack[--size];
    if (entry.distance2 >= bound2) continue;
    const Node& node = at(entry.node);
    if (node.isLeaf()) {
      for (std::int32_t i = node.begin(); i < node.end(); ++i) {
        if (!visit(i)) return;
      }
      continue;
    }
    std::array<Entry, 2> children{Entry{node.left, squaredDistance(at(node.left), p, bound2, facing)},
                                  Entry{node.left + 1, squaredDistance(at(node.left + 1), p, bound2, facing)}};
    if (children[1].distance2 < children[0].distance2) std::swap(children[0], children[1]);
    if (children[1].distance2 < kNever) stack[size++] = children[1];
    if (children[0].distance2 < kNever) stack[size++] = children[0];
  }
}

template <class IsPassed, class Visit>
void FacingTree::visitNear(const Vec3& p, double reach, const double& horizon, IsPassed&& isPassed, Visit&& visit) const {
  std::array<std::int32_t, kMaxDepth> stack;
  std::size_t size = 0;
  stack[size++] = 0;
  while (size > 0) {
    const Node& node = at(stack[--size]);
    if (!comesNear(node, p, reach + horizon, horizon) || isPassed(node.cone)) continue;
    if (node.left >= 0) {
      stack[size++] = node.left + 1;
      stack[size++] = node.left;
      continue;
    }
    for (std::int32_t i = node.begin(); i < node.end(); ++i) visit(i);
  }
}

template <class Visit>
void FacingTree::visitInBox(const Vec3& low, const Vec3& high, Visit&& visit) const {
  std::array<std::int32_t, kMaxDepth> stack;
  std::size_t size = 0;
  stack[size++] = 0;
  while (size > 0) {
    const Node& node = at(stack[--size]);
    if (!overlaps(node, low, high)) continue;
    if (node.left >= 0) {
      stack[size++] = node.left + 1;
      stack[size++] = node.left;
      continue;
    }
    for (std::int32_t i = node.begin(); i < node.end(); ++i) {
      if (!visit(i)) return;
    }
  }
}

}  // namespace pincer::contact
