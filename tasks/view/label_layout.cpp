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

bool isInside(const Box& box, const Vec2& picture) {
  return box.min().minCoeff() >= 0 && (picture - box.max()).minCoeff() >= 0;
}

bool liesOver(const Box& box, const std::vector<Box>& others) {
  return std::any_of(others.begin(), others.end(), [&](const Box& other) {
    return (box.max().cwiseMin(other.max()) - box.min().cwiseMax(other.min())).minCoeff() > -kGap;
  });
}

// Its anchor, then places about it from the nearest ring outwards.
std::vector<Vec2> triedPlaces(const LabelBox& label) {
  std::vector<Vec2> places{label.anchor};
  for (int ring = 1; ring <= kRings; ++ring) {
    for (int way = 0; way < kDirections; ++way) {  // first above, then alternately to both sides
      const int step = way % 2 == 0 ? -way / 2 : (way + 1) / 2;
      const double angle = 2 * std::numbers::pi * step / kDirections;
      places.emplace_back(label.anchor + ring * Vec2(0.7 * label.size.x() * math::sin(angle),
                                                     -1.1 * label.size.y() * math::cos(angle)));
    }
  }
  return places;
}

Vec2 placeOf(const LabelBox& label, const std::vector<Box>& taken, const std::vector<Box>& things,
             const Vec2& picture) {
  const Vec2* over_thing = nullptr;
  const std::vector<Vec2> places = triedPlaces(label);
  for (const Vec2& place : places) {
    const Box box = boxAt(place, label.size);
    if (!isInside(box, picture) || liesOver(box, taken)) continue;
    if (!liesOver(box, things)) return place;
    if (!over_thing) over_thing = &place;
  }
  return over_thing ? *over_thing : label.anchor;
}

}  // namespace

std::vector<Vec2> layOut(const std::vector<LabelBox>& labels, const std::vector<Box>& things, const Vec2& picture) {
  std::vector<Vec2> places;
  std::vector<Box> taken;
  for (const LabelBox& label : labels) {
    places.push_back(placeOf(label, taken, things, picture));
    taken.push_back(boxAt(places.back(), label.size));
  }
  return places;
}

}  // namespace pincer::tasks
