// shared_outline: what two facets share that are laid over each other along a direction n.
//
// Both are seen along n, so that the places are those of a plane; the outline of what they share is made of corners of
// the one, corners of the other, and crossings of their edges. facet_overlap.h tells how it becomes points of contact.
#pragma once
#include <algorithm>
#include <array>
#include <cstdint>

#include "pincer/contact/math.h"
#include "pincer/contact/shape/convex_features.h"

namespace pincer::contact {

// A facet seen along n: places across n, and its height along n as an affine function of them, in the frame that
// overlapFacets looks in [m].
struct FlatCorner {
  Vec2 x;
  std::uint32_t feature;
  std::uint32_t edge;  // to the next corner, in the facet's own names
  bool is_straight;    // that edge, not a chord of a rim
};
struct FlatFacet {
  std::array<FlatCorner, Facet::kMost> corners;  // counter-clockwise seen against n
  int count = 0;
  Vec2 x0 = Vec2::Zero(), slope = Vec2::Zero();
  double z0 = 0;
  double line_radius = 0;  // as Facet's [m]

  const FlatCorner& corner(int i) const { return corners[static_cast<std::size_t>(i)]; }
  double height(const Vec2& x) const { return z0 + slope.dot(x - x0); }
};

enum : std::uint32_t { kCornerOfA = 0, kCornerOfB = 1, kCrossing = 2, kSupports = 3 };
// A point's name, by those of a's and b's corner or edge; each below 2^14.
constexpr std::uint32_t featureOf(std::uint32_t kind, std::uint32_t a, std::uint32_t b) {
  return kind << 28 | a << 14 | b;
}

struct SharedCorner {
  Vec2 x;  // across n [m]
  std::uint32_t feature;
};

// At most: the corners of one facet, and two for each edge of the other.
constexpr int kMostShared = 3 * Facet::kMost;
struct SharedOutline {
  std::array<SharedCorner, kMostShared> corners;
  int count = 0;

  void add(const Vec2& x, std::uint32_t feature) {
    if (count < kMostShared) corners[static_cast<std::size_t>(count++)] = {x, feature};
  }
  void drop(std::uint32_t feature) {
    const auto is_it = [&](const SharedCorner& c) { return c.feature == feature; };
    count = static_cast<int>(std::remove_if(corners.begin(), corners.begin() + count, is_it) - corners.begin());
  }
};

// Adds the corners of what `fa` of A and `fb` of B share. `tolerance` [m]: a place so far outside of an edge counts as
// within; `size` [m]: the order of magnitude of both. Allocates nothing.
void shareOutline(const FlatFacet& fa, const FlatFacet& fb, double tolerance, double size, SharedOutline& out);

}  // namespace pincer::contact
