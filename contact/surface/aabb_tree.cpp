#include "pincer/contact/surface/aabb_tree.h"

#include <numeric>

#include "pincer/contact/functions/invariants.h"
#include "pincer/contact/surface/outward_float.h"

namespace pincer::contact {

AabbTree::AabbTree(const std::vector<Aabb>& boxes) : order_(boxes.size()) {
  PINCER_ASSERT(!boxes.empty());
  std::iota(order_.begin(), order_.end(), 0);
  nodes_.reserve(boxes.size());
  nodes_.emplace_back();
  split(0, 0, static_cast<std::int32_t>(boxes.size()), boxes);
}

void AabbTree::split(std::size_t node, std::int32_t begin, std::int32_t end, const std::vector<Aabb>& boxes) {
  const auto box = [&](std::int32_t item) -> const Aabb& { return boxes[static_cast<std::size_t>(item)]; };
  const auto centre = [&](std::int32_t item) -> Vec3 { return 0.5 * (box(item).low + box(item).high); };
  const std::int32_t first = order_[static_cast<std::size_t>(begin)];
  Aabb all = box(first), centres{centre(first), centre(first)};
  for (std::int32_t i = begin; i < end; ++i) {
    const std::int32_t item = order_[static_cast<std::size_t>(i)];
    PINCER_ASSERT((box(item).low.array() <= box(item).high.array()).all());
    all = {all.low.cwiseMin(box(item).low), all.high.cwiseMax(box(item).high)};
    centres = {centres.low.cwiseMin(centre(item)), centres.high.cwiseMax(centre(item))};
  }
  for (int k = 0; k < 3; ++k) {
    nodes_[node].low[static_cast<std::size_t>(k)] = below(all.low[k]);
    nodes_[node].high[static_cast<std::size_t>(k)] = above(all.high[k]);
  }
  nodes_[node].left = -1 - begin;
  nodes_[node].count = end - begin;
  if (end - begin <= kLeafSize) return;

  int axis = 0;
  (centres.high - centres.low).maxCoeff(&axis);
  const std::int32_t middle = begin + (end - begin) / 2;
  std::nth_element(order_.begin() + begin, order_.begin() + middle, order_.begin() + end,
                   [&](std::int32_t a, std::int32_t b) {
                     const double ca = centre(a)[axis], cb = centre(b)[axis];
                     return ca < cb || (ca == cb && a < b);
                   });
  const std::size_t left = nodes_.size();
  nodes_[node].left = static_cast<std::int32_t>(left);
  nodes_.resize(left + 2);
  split(left, begin, middle, boxes);
  split(left + 1, middle, end, boxes);
}

}  // namespace pincer::contact
