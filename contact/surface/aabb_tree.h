// aabb_tree: boxes in a binary tree, for finding the ones that meet a box or are near a point.
//
// Built top-down: each node splits its items at the median along the axis on which their centres spread most, so the
// depth is the logarithm of their number. Node bounds are kept in single precision, rounded outwards.
#pragma once
#include <algorithm>
#include <array>
#include <cstdint>
#include <vector>

#include "pincer/contact/assert.h"
#include "pincer/contact/math.h"

namespace pincer::contact {

struct Aabb {
  Vec3 low, high;  // [m]
};

class AabbTree {
 public:
  // Requires at least one box.
  explicit AabbTree(const std::vector<Aabb>& boxes);

  // The boxes' numbers in the order of the tree's leaves: visitBox() names items by their place in it.
  const std::vector<std::int32_t>& order() const { return order_; }
  std::size_t memoryBytes() const { return nodes_.capacity() * sizeof(Node) + order_.capacity() * sizeof(order_[0]); }

  // Calls visit(i), for places i of `order`, on every item of the leaves whose box meets [low, high], in increasing
  // order. Stops after `max_visits` items. Allocates nothing.
  template <class Visit>
  void visitBox(const Vec3& low, const Vec3& high, int max_visits, Visit&& visit) const;

  // Calls visit(i) on the items of all leaves nearer to `p` than sqrt(bound2), nearer leaves first; `bound2` [m^2]
  // may shrink meanwhile. Allocates nothing.
  template <class Visit>
  void visitNear(const Vec3& p, const double& bound2, Visit&& visit) const;

  // True if the box of any leaf meets [low, high].
  bool meetsBox(const Vec3& low, const Vec3& high) const {
    bool meets = false;
    visitBox(low, high, 1, [&](std::int32_t) { meets = true; });
    return meets;
  }
  Vec3 low() const { return cornerOf(nodes_.front().low); }  // of all boxes [m]
  Vec3 high() const { return cornerOf(nodes_.front().high); }

 private:
  struct Node {
    std::array<float, 3> low, high;
    std::int32_t left;   // >= 0: the children are left and left + 1; < 0: a leaf, items begin at place -1 - left
    std::int32_t count;  // of items in a leaf
  };
  static constexpr std::int32_t kLeafSize = 12;  // items, chosen
  static constexpr std::size_t kMaxDepth = 64;   // nodes put off, one per level; 2^31 items have 31 levels

  static Vec3 cornerOf(const std::array<float, 3>& c) { return {c[0], c[1], c[2]}; }
  static double squaredDistance(const Node& node, const Vec3& p) {
    double sum = 0;
    for (int k = 0; k < 3; ++k) {
      const auto i = static_cast<std::size_t>(k);
      const double out = std::max({node.low[i] - p[k], p[k] - node.high[i], 0.0});
      sum += out * out;
    }
    return sum;
  }
  void split(std::size_t node, std::int32_t begin, std::int32_t end, const std::vector<Aabb>& boxes);

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
      PINCER_ASSERT(size + 2 <= kMaxDepth);
      stack[size++] = node.left + 1;
      stack[size++] = node.left;
      continue;
    }
    for (std::int32_t i = 0; i < node.count; ++i) visit(-1 - node.left + i);
    max_visits -= node.count;
    if (max_visits <= 0) return;
  }
}

template <class Visit>
void AabbTree::visitNear(const Vec3& p, const double& bound2, Visit&& visit) const {
  struct Entry {
    std::int32_t node;
    double distance2;
  };
  std::array<Entry, kMaxDepth> stack;
  std::size_t size = 0;
  const auto push = [&](std::int32_t i) {
    const double distance2 = squaredDistance(nodes_[static_cast<std::size_t>(i)], p);
    if (distance2 < bound2) stack[size++] = {i, distance2};
  };
  push(0);
  while (size > 0) {
    const Entry entry = stack[--size];
    if (!(entry.distance2 < bound2)) continue;
    const Node& node = nodes_[static_cast<std::size_t>(entry.node)];
    if (node.left < 0) {
      for (std::int32_t i = 0; i < node.count; ++i) visit(-1 - node.left + i);
      continue;
    }
    PINCER_ASSERT(size + 2 <= kMaxDepth);
    const std::size_t before = size;
    push(node.left + 1);
    push(node.left);
    if (size == before + 2 && stack[before].distance2 < stack[before + 1].distance2)
      std::swap(stack[before], stack[before + 1]);
  }
}

}  // namespace pincer::contact
