// closed_forms: the point of a primitive's surface that is nearest to a given point, exactly.
//
//   p_BC = p_BS + d n_B,   d = signed distance of C from the surface [m], negative inside the solid
//
//   p_BS  nearest point of the surface, n_B unit normal there, out of the solid; all in the solid's frame B, metres
// Outside a sharp edge, rim or corner the normal is the direction from it to C, so p_BS and n_B are continuous over all
// of the outside (projection onto a convex set is non-expansive). Inside it is the normal of the nearest face, and
// jumps where C crosses the medial axis. On the medial axis one of the nearest points is taken, always the same: the
// centre of a sphere looks to +z, the axis of a cylinder or capsule to +x, a box prefers z to y to x and + to -, a
// cylinder its side to its ends, a flat yields to the round, a dish's centre looks down to its lowest point.
// Error: a few ulp of the largest coordinate. Total over finite input below 1e150 m; non-finite input gives a
// non-finite result. Source: C. Ericson, Real-Time Collision Detection (2005), sec. 5.1, for the box and the capsule;
// the rest follows from the section times the interval: the solid D x [-h, h] has d = max(d_D, |z| - h) where one of
// the two is negative, their hypotenuse where none is.
#pragma once
#include "pincer/contact/math.h"
#include "pincer/contact/shape.h"

namespace pincer::contact {

struct NearestPoint {
  Vec3 p_BS;
  Vec3 n_B;
  double distance;  // d above [m]
};

NearestPoint nearestPoint(const Sphere& sphere, const Vec3& p_BC);
NearestPoint nearestPoint(const Capsule& capsule, const Vec3& p_BC);
NearestPoint nearestPoint(const HalfSpace& half_space, const Vec3& p_BC);
NearestPoint nearestPoint(const Dish& dish, const Vec3& p_BC);
NearestPoint nearestPoint(const Box& box, const Vec3& p_BC);
NearestPoint nearestPoint(const Cylinder& cylinder, const Vec3& p_BC);
NearestPoint nearestPoint(const CylinderWithFlat& cylinder, const Vec3& p_BC);
// looks at every face; a hull prefers its first faces
NearestPoint nearestPoint(const Convex& convex, const Vec3& p_BC);

}  // namespace pincer::contact
