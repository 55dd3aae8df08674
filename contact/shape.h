// shape: the solids that contact/ knows, each in its own frame B. Plain values; SI units.
#pragma once
#include <memory>
#include <variant>

#include "pincer/contact/math.h"

namespace pincer::contact {

class Polytope;    // contact/polytope.h
class SmoothMesh;  // contact/smooth_mesh.h

struct Sphere {
  double radius;  // > 0 [m]; centre at B's origin
};
struct Box {
  Vec3 half;  // half edge lengths, each > 0 [m]; centre at B's origin
};
struct Capsule {
  double radius;       // > 0 [m]
  double half_length;  // half the length of the cylindrical part along z, >= 0 [m]
};
struct Cylinder {
  double radius;       // > 0 [m]
  double half_length;  // along z, > 0 [m]
};
// A cylinder whose part beyond x = flat_distance is cut off; the flat's normal is +x.
struct CylinderWithFlat {
  double radius;         // > 0 [m]
  double half_length;    // along z, > 0 [m]
  double flat_distance;  // of the flat from the axis, 0 < flat_distance < radius [m]
};
// All of z <= 0; surface normal +z. Static bodies only.
struct HalfSpace {};
// A bowl, the inside of a sphere: its lowest point is B's origin, its centre of curvature (0, 0, radius);
// solid outside the sphere. Static bodies only. What lies above the rim is a matter of the scene's sizes:
// the surface continues as the whole sphere.
struct Dish {
  double radius;  // > 0 [m]
};
// A closed triangle mesh that stands for a smooth surface.
struct Mesh {
  std::shared_ptr<const SmoothMesh> surface;  // never null
};

// The convex hull of points.
struct Convex {
  std::shared_ptr<const Polytope> hull;  // never null
};

using Shape = std::variant<Sphere, Box, Capsule, Cylinder, CylinderWithFlat, HalfSpace, Dish, Mesh, Convex>;

}  // namespace pincer::contact
