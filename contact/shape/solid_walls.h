// solid_walls: the faces and round walls of a convex solid, as seen from a point.
//
//   height  of the point over a wall [m], negative behind it;  n  the wall's normal there, out of the solid
//
// The point is in the solid where no height is positive; then the largest is the shortest way out.
#pragma once
#include "pincer/contact/math.h"
#include "pincer/contact/polytope.h"
#include "pincer/contact/shape/closed_forms.h"
#include "pincer/contact/shape/direction.h"

namespace pincer::contact {

// Calls visit(n, height) on each wall that may be nearest to `p`, both in the solid's frame.
template <class Visit>
void visitWalls(const Box& box, const Vec3& p, Visit&& visit) {
  for (int i = 0; i < 3; ++i) visit(Vec3(signOf(p[i]) * Vec3::Unit(i)), std::abs(p[i]) - box.half[i]);
}
template <class Visit>
void visitWalls(const Cylinder& cylinder, const Vec3& p, Visit&& visit) {
  const auto [n, length] = directionOf<Vec2>(p.head<2>(), Vec2::UnitX());
  visit(Vec3(n.x(), n.y(), 0), length - cylinder.radius);
  visit(Vec3(signOf(p.z()) * Vec3::UnitZ()), std::abs(p.z()) - cylinder.half_length);
}
template <class Visit>
void visitWalls(const CylinderWithFlat& cylinder, const Vec3& p, Visit&& visit) {
  visitWalls(Cylinder{cylinder.radius, cylinder.half_length}, p, visit);
  visit(Vec3(Vec3::UnitX()), p.x() - cylinder.flat_distance);
}
template <class Visit>
void visitWalls(const Convex& convex, const Vec3& p, Visit&& visit) {
  for (const Polytope::Face& face : convex.hull->faces()) visit(face.n, face.n.dot(p) - face.d);
}
template <class Visit, class Round>
void visitWalls(const Round& solid, const Vec3& p, Visit&& visit) {
  const NearestPoint s = nearestPoint(solid, p);
  visit(s.n_B, s.distance);
}

}  // namespace pincer::contact
