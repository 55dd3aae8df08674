// quick_hull: the convex hull of points as triangles.
//
// Source: C. B. Barber, D. P. Dobkin, H. Huhdanpaa, "The Quickhull algorithm for convex hulls", ACM TOMS
// 22(4), 1996. Where they merge facets, points that are no further than 1e-10 of the set's size outside of one
// are dropped: no corner that matters to contact. (Bullet's hull rounds coordinates to 1e-4 of the size:
// corners of a hand-sized solid are 5 um off.)
#pragma once
#include <array>
#include <vector>

#include "pincer/contact/math.h"

namespace pincer::contact {

// Indices into `points`, counter-clockwise seen from outside; empty where all points lie in one plane.
std::vector<std::array<int, 3>> quickHull(const std::vector<Vec3>& points);

}  // namespace pincer::contact
