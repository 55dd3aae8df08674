// flat_distance: from a point to flat triangles, by trying them all: what peers' answers are checked against.
#pragma once
#include "pincer/contact/math.h"
#include "pincer/contact/triangle_mesh.h"

namespace pincer::tasks {

// Unsigned [m].
double distanceToTriangles(const contact::TriangleMesh& mesh, const Vec3& p);

}  // namespace pincer::tasks
