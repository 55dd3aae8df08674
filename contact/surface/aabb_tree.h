// aabb_tree: boxes in a binary tree, for finding the ones that meet a box.
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

  // The boxes' numbers in the order of the tree's leaves: visitBox() names items by their place in it.
  const std::vector<std::int32_t>& order() const { return order_; }
  std::size_t memoryBytes() const { return nodes_.capacity() * sizeof(Node) + order_.capacity() * sizeof(order_[0]); }

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

}  // namespace pincer::contact
