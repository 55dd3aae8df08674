#include "contact/surface/facing_tree.h"

#include <numeric>

#include "contact/surface/outward_float.h"

namespace pincer::contact {

FacingTree::FacingTree(const std::vector<FacingBox>& boxes, const std::function<void(double)>& progress)
    : order_(boxes.size()), progress_(progress) {
  std::iota(order_.begin(), order_.end(), 0);
  nodes_.reserve(boxes.size());
  nodes_.emplace_back();
  split(0, 0, static_cast<std::int32_t>(boxes.size()), boxes);
  nodes_.shrink_to_fit();
  progress_ = nullptr;
}

NormalCone FacingTree::split(std::size_t node, std::int32_t begin, std::int32_t end, const std::vector<FacingBox>& boxes) {
  const auto box = [&](std::int32_t place) -> const FacingBox& {
    return boxes[static_cast<std::size_t>(order_[static_cast<std::size_t>(place)])];
  };
  const auto twice_centre = [](const FacingBox& b, std::size_t k) { return b.low[k] + b.high[k]; };
  Node bounds{box(begin).low, box(begin).high, 0, {}, -1 - (8 * begin + std::min(end - begin, kLeafSize))};
  std::array<float, 3> first, last;
  for (std::size_t k = 0; k < 3; ++k) first[k] = last[k] = twice_centre(box(begin), k);
  for (std::int32_t i = begin; i < end; ++i) {
    const FacingBox& b = box(i);
    for (std::size_t k = 0; k < 3; ++k) {
      bounds.low[k] = std::min(bounds.low[k], b.low[k]);
      bounds.high[k] = std::max(bounds.high[k], b.high[k]);
      first[k] = std::min(first[k], twice_centre(b, k));
      last[k] = std::max(last[k], twice_centre(b, k));
    }
  }
  double diagonal2 = 0;
  for (std::size_t k = 0; k < 3; ++k) {
    const double edge = static_cast<double>(bounds.high[k]) - bounds.low[k];
    diagonal2 += edge * edge;
  }
  bounds.radius = above(0.5 * std::sqrt(diagonal2));
  NormalCone cone = box(begin).cone;
  if (end - begin <= kLeafSize) {
    for (std::int32_t i = begin + 1; i < end; ++i) cone = joined(cone, box(i).cone);
  } else {
    std::size_t axis = 0;
    for (std::size_t k = 1; k < 3; ++k) axis = last[k] - first[k] > last[axis] - first[axis] ? k : axis;
    const std::int32_t middle = begin + (end - begin) / 2;
    std::nth_element(order_.begin() + begin, order_.begin() + middle, order_.begin() + end, [&](std::int32_t a, std::int32_t b) {
      const float ca = twice_centre(boxes[static_cast<std::size_t>(a)], axis), cb = twice_centre(boxes[static_cast<std::size_t>(b)], axis);
      return ca < cb || (ca == cb && a < b);
    });
    const std::size_t left = nodes_.size();
    bounds.left = static_cast<std::int32_t>(left);
    nodes_.resize(left + 2);
    const NormalCone first_cone = split(left, begin, middle, boxes);
    cone = joined(first_cone, split(left + 1, middle, end, boxes));
  }
  constexpr std::int32_t kReported = 4096;  // every item is in one node of between this and twice as many
  const bool is_reported = end - begin >= kReported && end - begin < 2 * kReported;
  if (progress_ && is_reported) progress_(static_cast<double>(end) / static_cast<double>(boxes.size()));
  bounds.cone = FacingTest(cone);
  nodes_[node] = bounds;
  return cone;
}

}  // namespace pincer::contact
