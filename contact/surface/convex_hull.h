// convex_hull: which points of a set are corners of its convex hull.
#pragma once
#include <cstdint>
#include <vector>

#include "contact/math.h"

namespace pincer::contact {

// Indices into `points`, increasing. Points within round-off (about 1e-7 of the set's size) of the hull may be left out or kept.
std::vector<std::int32_t> hullCorners(const std::vector<Vec3>& points);

}  // namespace pincer::contact
