// lathe: a turned solid, a profile that goes round the z axis, as a closed triangle mesh:
// eggs, knobs, pawns, bottles without a file.
//
//   x = rho_i cos(2 pi k / segments),  y = rho_i sin(2 pi k / segments),  z = z_i
//
// The mesh stands for the smooth solid wherever the profile's corners are flatter
// than the crease angle (contact/surface).
#pragma once
#include <vector>

#include "pincer/contact/triangle_mesh.h"

namespace pincer::contact {

// Profile points (rho, z) [m], one or more between two ends on the axis (rho = 0), in either direction; it may not
// cross itself or touch the axis in between. `segments` around the axis, 3 .. 1000. Triangles counter-clockwise seen
// from outside. Throws InputError that names the point, its value and the remedy.
TriangleMesh lathe(const std::vector<Vec2>& profile, int segments);

}  // namespace pincer::contact
