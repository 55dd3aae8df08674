// path_figures: what the queries along a path took, and how evenly the contact moved.
//
//   turn = h |n' - n| / |C' - C|
//
//   n, n'  contact direction of two ticks, of several contacts their mean weighted by depth;  C, C'
//          the finger's centre [m];  h = r - depth [m]
//
// Around a sharp edge the turn is 1, on a convex surface less; in a hollow of radius rho it is h / (rho - h). The
// contact's place on the finger moves by r |n' - n| = (r / h) turn |C' - C|. A turn beyond the limit is a jump.
#pragma once
#include <array>
#include <cstdint>

#include "pincer/tasks/judge/bench/finger_path.h"

namespace pincer::tasks {

constexpr int kMostIterations = 64;  // counted one by one; more are counted as this many

struct PathFigures {
  std::int64_t queries = 0;                                       // warm ones: those that continue a contact
  std::array<std::int64_t, kMostIterations + 1> by_iterations{};  // queries that took so many iterations
  int longest_walk = 0;                                           // iterations of one contact
  int most_crossings = 0;                                         // of triangle edges in a query
  std::int64_t reseeded = 0;  // queries whose walk failed, so that the tree was asked
  std::int64_t held = 0;      // queries left without an answer
  std::int64_t not_finite = 0;
  std::int64_t jumps = 0;
  double largest_turn = 0;     // [-]
  double largest_place = 0;    // r |n' - n| / |C' - C| [-]
  double largest_degrees = 0;  // |n' - n| / |C' - C| [degrees per um]
  double largest_push = 0;  // |f' - f| / |C' - C| [-], f = sum max(-phi_i, 0) n_i: the force's change over the spring's

  double meanIterations() const;  // NaN where none was counted: that would be a mistake of the measurement
  int iterationsQuantile(double q) const;
};

// Queries of two ticks of which one has no contact don't count for the turn: in the air
// the nearest place may change as it likes.
PathFigures walkPath(const contact::SmoothMesh& mesh, const FingerPath& path, double turn_limit,
                     MeasureContext& context);

// Mean of the contacts' normals weighted by their depth, unit; the main one's where none is deep.
Vec3 feltDirection(const contact::SurfaceContacts& contacts);

}  // namespace pincer::tasks
