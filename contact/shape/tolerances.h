// tolerances: when gaps, directions and scores in the geometry of two solids count as
// the same. One number each, for all pairs.
#pragma once

namespace pincer::contact {

inline constexpr double kSameGap = 1e-6;  // [m]: of two points of a manifold neither is deeper
// ratio of scores from which a point takes another's place: below, names would flicker
inline constexpr double kBetter = 1.01;
// of a point that was kept in the last tick, or carried: what rests or rocks keeps its points, and solvers the impulses
inline constexpr double kStays = 2, kCarries = 100;
inline constexpr double kLikeNormals = 0.95;  // cosine of 18 degrees: points with normals that near form a group
inline constexpr double kNoAngle = 1e-6;  // [rad], sine: lines nearer to parallel, or to a right angle, count as that
inline constexpr double kOneNormal = 1e-12;    // [rad]: the same but for round-off
inline constexpr double kOutOfPlane = 1e-10;   // of the size: points nearer to a plane lie in it
inline constexpr double kSamePlace = 1e-6;     // of the size: beside an edge or an end counts as on it
inline constexpr double kOnePoint = 1e-3;      // of the size: points nearer to each other are one
inline constexpr double kGapRounding = 1e-13;  // of the size: round-off
inline constexpr int kMostQueries = 24;        // of a surface, for one point
// sine of 17 degrees: such edges touch along a length, others in a point
inline constexpr double kNearlyParallelEdges = 0.3;
// cosine between a facet's normal and that of contact: a steeper facet has no height along it
inline constexpr double kSteepestFacet = 0.05;

}  // namespace pincer::contact
