// tolerances: when gaps, directions and scores in the geometry of two solids count as
// the same. One number each, for all pairs.
#pragma once

namespace pincer::contact {

inline constexpr double kSameGap = 1e-6;  // [m]: of two points of a manifold neither is deeper
// ratio of scores from which a point takes another's place: below, names would flicker
inline constexpr double kBetter = 1.01;
inline constexpr double kLikeNormals = 0.95;    // cosine of 18 degrees: points with normals that near form a group
inline constexpr double kParallelEdges = 1e-6;  // sine: edges nearer to parallel have no direction across both
// sine of 17 degrees: such edges touch along a length, others in a point
inline constexpr double kNearlyParallelEdges = 0.3;
// cosine between a facet's normal and that of contact: a steeper facet has no height along it
inline constexpr double kSteepestFacet = 0.05;

}  // namespace pincer::contact
