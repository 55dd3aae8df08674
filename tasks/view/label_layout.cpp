#include "pincer/tasks/view/label_layout.h"

#include <algorithm>
#include <numbers>

#include "pincer/contact/elementary.h"

namespace pincer::tasks {
namespace {

constexpr int kRings = 6, kDirections = 12;  // places tried around an anchor
constexpr double kGap = 2;                   // between labels [pixels]

using Box = Eigen::AlignedBox2d;

Box boxAt(const Vec2& middle, const Vec2& size) { return {middle - 0.5 * size, middle + 0.5 * size}; }

bool isFree(const Box& box, const std::vector<Box>& taken, const Vec2& picture) {
  const bool inside = box.min().minCoeff() >= 0 && (picture - box.max()).minCoeff() >= 0;
  return inside && std::none_of(taken.begin(), taken.end(), [&](const Box& other) {
           const Vec2 overlap = box.max().cwiseMin(other.max()) - box.min().cwiseMax(other.min());
           return overlap.minCoeff() > -kGap;
         });
}

Vec2 placeOf(const LabelBox& label, const std::vector<Box>& taken, const Vec2& picture) {
  if (isFree(boxAt(label.anchor, label.size), taken, picture)) return label.anchor;
  for (int ring = 1; ring <= kRings; ++ring) {
    for (int way = 0; way < kDirections; ++way) {  // first above, then alternately to both sides
      const int step = way % 2 == 0 ? -way / 2 : (way + 1) / 2;
      const double angle = 2 * std::numbers::pi * step / kDirections;
      const Vec2 at =
          label.anchor + ring * Vec2(0.7 * label.size.x() * math::sin(angle), -1.1 * label.size.y() * math::cos(angle));
      if (isFree(boxAt(at, label.size), taken, picture)) return at;
    }
  }
  return label.anchor;
}

}  // namespace

std::vector<Vec2> layOut(const std::vector<LabelBox>& labels, const Vec2& picture) {
  std::vector<Vec2> places;
  std::vector<Box> taken;
  for (const LabelBox& label : labels) {
    places.push_back(placeOf(label, taken, picture));
    taken.push_back(boxAt(places.back(), label.size));
  }
  return places;
}

}  // namespace pincer::tasks
