// aabb_tree: boxes in a binary tree, for finding the ones near a point.
//
// Built top-down: each node splits its items at the median along the axis on which their centres spread most, so the depth is the
// logarithm of their number. Node bounds are kept in single precision, rounded outwards.
#pragma once
#include <algorithm>
#include <array>
#include <cstdint>
#include <vector>

#include "contact/math.h"

namespace pincer::contact {

struct Aabb {
  Vec3 low, high;  // [m]
};

class AabbTree {
 public:
  // Requires at least one box.
  explicit AabbTree(const std::vector<Aabb>& boxes);

  // The boxes' numbers in the order of the tree's leaves: visitNear() names items by their place in it.
  const std::vector<std::int32_t>& order() const { return order_; }

  // Calls visit(i), for places i of `order`, on every item whose box is nearer to `p` than sqrt(bound2), nearer boxes first; `bound2` [m^2]
  // may shrink meanwhile. Stops after `max_visits` items. Allocates nothing.
  template <class Visit>
  void visitNear(const Vec3& p, const double& bound2, int max_visits, Visit&& visit) const;

  // Calls visit(i), for places i of `order`, on every item of the leaves whose box meets [low, high], in increasing order. Stops after
  // `max_visits` items. Allocates nothing.
  template <class Visit>
  void visitBox(const Vec3& low, const Vec3& high, int max_visits, Visit&& visit) const;

 private:
  struct Node {
    std::array<float, 3> low, high;
    std::int32_t left;   // >= 0: the children are left and left + 1; < 0: a leaf, items begin at place -1 - left
    std::int32_t count;  // of items in a leaf
  };
  static constexpr std::int32_t kLeafSize = 12;
  static constexpr std::size_t kMaxDepth = 64;

  void split(std::size_t node, std::int32_t begin, std::int32_t end, const std::vector<Aabb>& boxes);
  static double squaredDistance(const Node& node, const Vec3& p);

  std::vector<Node> nodes_;
  std::vector<std::int32_t> order_;
};

template <class Visit>
void AabbTree::visitBox(const Vec3& low, const Vec3& high, int max_visits, Visit&& visit) const {
  const auto meets = [&](const Node& node) {
    for (int k = 0; k < 3; ++k) {
      const auto i = static_cast<std::size_t>(k);
      if (node.high[i] < low[k] || node.low[i] > high[k]) return false;
    }
    return true;
  };
  std::array<std::int32_t, kMaxDepth> stack;
  std::size_t size = 0;
  stack[size++] = 0;
  while (size > 0) {
    const Node& node = nodes_[static_cast<std::size_t>(stack[--size])];
    if (!meets(node)) continue;
    if (node.left >= 0) {
      stack[size++] = node.left + 1;
      stack[size++] = node.left;
      continue;
    }
    for (std::int32_t i = 0; i < node.count; ++i) visit(-1 - node.left + i);
    max_visits -= node.count;
    if (max_visits <= 0) return;
  }
}

inline double AabbTree::squaredDistance(const Node& node, const Vec3& p) {
  double sum = 0;
  for (int k = 0; k < 3; ++k) {
    const auto i = static_cast<std::size_t>(k);
    const double d = std::max({node.low[i] - p[k], 0.0, p[k] - node.high[i]});
    sum += d * d;
  }
  return sum;
}

template <class Visit>
void AabbTree::visitNear(const Vec3& p, const double& bound2, int max_visits, Visit&& visit) const {
  struct Entry {
    std::int32_t node;
    double distance2;
  };
  std::array<Entry, kMaxDepth> stack;
  std::size_t size = 0;
  stack[size++] = {0, squaredDistance(nodes_[0], p)};
  while (size > 0) {
    const Entry entry = stack[--size];
    if (entry.distance2 >= bound2) continue;
    const Node& node = nodes_[static_cast<std::size_t>(entry.node)];
    if (node.left < 0) {
      for (std::int32_t i = 0; i < node.count; ++i) visit(-1 - node.left + i);
      max_visits -= node.count;
      if (max_visits <= 0) return;
      continue;
    }
    Entry near{node.left, squaredDistance(nodes_[static_cast<std::size_t>(node.left)], p)};
    Entry far{node.left + 1, squaredDistance(nodes_[static_cast<std::size_t>(node.left) + 1], p)};
    if (far.distance2 < near.distance2) std::swap(near, far);
    if (far.distance2 < bound2) stack[size++] = far;
    if (near.distance2 < bound2) stack[size++] = near;
  }
}

}  // namespace pincer::contact
