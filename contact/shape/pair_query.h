// pair_query: where two bodies touch, as up to four points.
//
//   p_W  halfway between the two surfaces, n_W the unit normal out of shape b towards a, phi the gap there [m] (negative: overlap)
//
// A solid meets a half-space or a dish at its extreme points (extreme_points.h): exact for primitives. A mesh meets them with the corners
// of its convex hull, so it stands and rocks on flat facets: the bulge of its smooth surface between the corners, about e^2 k / 8 for edge
// length e [m] and curvature k [1/m], is not seen. (A sphere of 20 mm radius with edges of 5 mm sinks up to 0.16 mm deeper than its smooth
// surface.) A sphere meets a mesh like a fingertip does, on the smooth surface, with a search of the whole mesh.
#pragma once
#include <array>
#include <cstdint>

#include "contact/math.h"
#include "contact/shape/shape.h"
#include "contact/surface/patch_cache.h"

namespace pincer::contact {

struct PairPoint {
  Vec3 p_W = Vec3::Zero();
  Vec3 n_W = Vec3::UnitZ();
  double phi = 0;
  std::uint32_t feature = 0;  // which corner, end or rim point of the pair this is: the same from tick to tick, so that solvers warm-start
};

constexpr int kMaxPairPoints = 4;
struct PairPoints {
  std::array<PairPoint, kMaxPairPoints> points;
  int count = 0;
};

// Whether collideShapes answers for this pair, in this order or the other: any solid against a half-space or a dish, a sphere against
// anything. Two supports (half-space, dish) are both static and never a pair.
bool pairIsSupported(const Shape& a, const Shape& b);

// The points of a and b that are closer than `margin` >= 0 [m], written to `out` (sorted by feature). Of more than four
// candidates up to four are kept: the deepest, then those on which the solid would land first if it rocked (point_choice.h). Unsupported pairs give no point.
// Allocates nothing; `cache` is memory only.
void collideShapes(const Shape& a, const Pose& X_WA, const Shape& b, const Pose& X_WB, double margin, PatchCache& cache, PairPoints& out);

// Radius of the smallest sphere about the shape's own origin that holds it [m]; infinity for HalfSpace and Dish.
double boundingRadius(const Shape& shape);

}  // namespace pincer::contact
