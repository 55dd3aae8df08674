#include "pincer/contact/surface/facing_tree.h"

#include <numeric>

#include "pincer/contact/functions/invariants.h"

namespace pincer::contact {

namespace {

// an empty box: widened by anything it becomes that
constexpr float kInsideOut = std::numeric_limits<float>::infinity();
constexpr std::int32_t kFirstLeaf = -1;

float twiceCentre(const FacingBox& b, std::size_t k) { return b.low[k] + b.high[k]; }

void widen(FacingBox& box, const FacingBox& other) {
  for (std::size_t k = 0; k < 3; ++k) {
    box.low[k] = std::min(box.low[k], other.low[k]);
    box.high[k] = std::max(box.high[k], other.high[k]);
  }
  PINCER_ASSERT((box.cone.isFull() || isUnit(box.cone.axis)) && (other.cone.isFull() || isUnit(other.cone.axis)));
  box.cone = joined(box.cone, other.cone);
  box.hollow = std::max(box.hollow, other.hollow);
}

float ballRadius(const FacingBox& box) {
  double diagonal2 = 0;
  for (std::size_t k = 0; k < 3; ++k) {
    const double edge = static_cast<double>(box.high[k]) - box.low[k];
    diagonal2 += edge * edge;
  }
  return above(0.5 * std::sqrt(diagonal2));
}

// Leaves of a full child: as few nodes as there can be hold all leaves if all children but the last are full.
std::int32_t leavesOfChild(std::int32_t leaves) {
  std::int32_t full = 1;
  while (kLanes * full < leaves) full *= kLanes;
  return full;
}

}  // namespace

FacingTree::FacingTree(const std::vector<FacingBox>& boxes, const std::function<void(double)>& progress)
    : order_(boxes.size()), progress_(progress) {
  PINCER_ASSERT(!boxes.empty());
  std::iota(order_.begin(), order_.end(), 0);
  for (const FacingBox& box : boxes) {
    for (std::size_t k = 0; k < 3; ++k)
      extent_ = std::max<double>({extent_, std::abs(box.low[k]), std::abs(box.high[k])});
  }
  nodes_.reserve(boxes.size() / kLanes / 2 + 1);
  nodes_.emplace_back();
  build(0, {0, static_cast<std::int32_t>(boxes.size())}, boxes);
  nodes_.shrink_to_fit();
  progress_ = nullptr;
}

// The place at which the range is halved, a whole number of children on the left; its end if it is one child.
std::int32_t FacingTree::halve(Range range, std::int32_t child, const std::vector<FacingBox>& boxes) {
  const std::int32_t children = (range.end - range.begin + child - 1) / child;
  if (children <= 1) return range.end;
  const auto box = [&](std::int32_t item) -> const FacingBox& { return boxes[static_cast<std::size_t>(item)]; };
  const auto begin = order_.begin() + range.begin, end = order_.begin() + range.end,
             middle = begin + child * (children / 2);
  std::array<float, 3> first, last;
  for (std::size_t k = 0; k < 3; ++k) first[k] = last[k] = twiceCentre(box(*begin), k);
  for (auto i = begin; i != end; ++i) {
    const FacingBox& b = box(*i);
    for (std::size_t k = 0; k < 3; ++k) {
      first[k] = std::min(first[k], twiceCentre(b, k));
      last[k] = std::max(last[k], twiceCentre(b, k));
    }
  }
  std::size_t axis = 0;
  for (std::size_t k = 1; k < 3; ++k) axis = last[k] - first[k] > last[axis] - first[axis] ? k : axis;
  std::nth_element(begin, middle, end, [&](std::int32_t a, std::int32_t b) {
    const float ca = twiceCentre(box(a), axis), cb = twiceCentre(box(b), axis);
    return ca < cb || (ca == cb && a < b);
  });
  return range.begin + child * (children / 2);
}

FacingTree::Bounds FacingTree::boundsOfLeaf(Range range, const std::vector<FacingBox>& boxes) const {
  const auto box = [&](std::int32_t place) -> const FacingBox& {
    return boxes[static_cast<std::size_t>(order_[static_cast<std::size_t>(place)])];
  };
  FacingBox all = box(range.begin);
  for (std::int32_t i = range.begin + 1; i < range.end; ++i) widen(all, box(i));
  return {all, ballRadius(all)};
}

FacingTree::Bounds FacingTree::build(std::size_t node, Range range, const std::vector<FacingBox>& boxes) {
  const std::int32_t child_size = kLanes * leavesOfChild((range.end - range.begin + kLanes - 1) / kLanes);
  const std::int32_t middle = halve(range, child_size, boxes);
  const std::int32_t first = halve({range.begin, middle}, child_size, boxes),
                     last = halve({middle, range.end}, child_size, boxes);
  const std::array<Range, kLanes> ranges{Range{range.begin, first}, Range{first, middle}, Range{middle, last},
                                         Range{last, range.end}};
  PINCER_ASSERT(range.begin <= first && first <= middle && middle <= last && last <= range.end);
  FacingBox all{};
  for (int lane = 0; lane < kLanes; ++lane) {
    const auto i = static_cast<std::size_t>(lane);
    const auto [begin, end] = ranges[i];
    Bounds bounds{{{kInsideOut, kInsideOut, kInsideOut}, {-kInsideOut, -kInsideOut, -kInsideOut}, {}, 0}, 0};
    // of an empty lane: only a point that is no number gets there, and must find something
    std::int32_t child = kFirstLeaf;
    if (end > begin) child = kFirstLeaf - begin / kLanes;
    if (end - begin > kLanes) {
      child = static_cast<std::int32_t>(nodes_.size());
      nodes_.emplace_back();
      bounds = build(static_cast<std::size_t>(child), ranges[i], boxes);
    } else if (end > begin) {
      bounds = boundsOfLeaf(ranges[i], boxes);
    }
    if (lane == 0) all = bounds.box;
    if (lane > 0 && end > begin) widen(all, bounds.box);
    Node& at = nodes_[node];
    for (std::size_t k = 0; k < 3; ++k) {
      at.low[k][lane] = bounds.box.low[k];
      at.high[k][lane] = bounds.box.high[k];
    }
    at.radius[lane] = bounds.radius;
    at.hollow[lane] = bounds.box.hollow;
    at.cones.set(lane, FacingTest(bounds.box.cone));
    at.child[i] = child;
  }
  constexpr std::int32_t kReported = 4096;  // every item is in few nodes of more than this
  if (progress_ && range.end - range.begin >= kReported)
    progress_(static_cast<double>(range.end) / static_cast<double>(boxes.size()));
  return {all, ballRadius(all)};
}

}  // namespace pincer::contact
