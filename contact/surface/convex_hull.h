// convex_hull: the convex hull of a set of points.
#pragma once
#include <cstdint>
#include <vector>

#include "pincer/contact/math.h"

namespace pincer::contact {

// Indices into `points`, increasing. Points within round-off (Bullet rounds coordinates to 1e-4 of the set's
// size) of the hull may be left out or kept.
std::vector<std::int32_t> hullCorners(const std::vector<Vec3>& points);

// Corners of what is left of the hull when every face is moved inwards by about `distance` [m], at most half way to the
// centre; empty if that is nothing. Rough (Bullet's grid): for starting a search.
std::vector<Vec3> insetCorners(const std::vector<Vec3>& points, double distance);

}  // namespace pincer::contact
