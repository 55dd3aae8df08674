// shaded_objects: the sphere and the cylinder with a flat as fingers feel them: coarse triangle meshes that stand for
// the smooth solids, with the solids' own normals at their corners, several where an edge is to stay sharp.
//
// Bodies meet the closed forms, which have the mass too (grasp/model.h, FeltSurface). Shaded smooth they keep the pad's
// places within 0.05 mm and normals within 0.2 degrees of the closed forms, for every size that the tasks allow
// (tests/unit/tasks/lab/shaded_objects_test.cpp).
#pragma once
#include <memory>

#include "pincer/contact/smooth_mesh.h"

namespace pincer::tasks {

// Geodesic, the middle at B's origin [m].
std::shared_ptr<const contact::SmoothMesh> shadedSphere(double radius, contact::SurfaceVariant variant);

// About z, the flat towards +x at `flat_distance` < `radius` from the axis [m]; rims and
// the flat's edges are sharp, however blunt.
std::shared_ptr<const contact::SmoothMesh> shadedCylinder(double radius, double half_length, double flat_distance,
                                                          contact::SurfaceVariant variant);

}  // namespace pincer::tasks
