// core_distance: the nearest points of two convex solids' cores, by the method of Gilbert, Johnson and Keerthi.
//
//   v = argmin |x|,  x in (A + shift) - B        from b's nearest point to a's [m], in the axes of the world
//
// Source: E. Gilbert, D. Johnson, S. Keerthi, IEEE J. Robotics Automat. 4(2), 1988; nearest points of simplices after
// C. Ericson, Real-Time Collision Detection (2005), sec. 5.1. Departure: v is taken along a triangle's normal, and
// across a segment, exactly, however short it is: the direction then loses nothing where solids all but touch. Solids
// made of corners end after finitely many steps with v exact to round-off; round ones when a step can shorten v by no
// more than the accuracy asked for: its direction is right to the root of that.
#pragma once
#include "pincer/contact/shape/posed_solid.h"

namespace pincer::contact {

struct CoreDistance {
  Vec3 v = Vec3::Zero();
  bool apart = false;  // false: the cores overlap, or are nearer than 1e-13 of `size`, and v says nothing
  double around = 0;   // of the disc about v's end, across v, that is known to be in (A + shift) - B [m]; its radius
};

struct CoreAccuracy {
  double relative;      // to |v|
  double absolute = 0;  // [m]
  // [m]: of solids that turn out to be further apart than that, v is any vector across which they are
  double reach = kInfinity;
};

// `start`: a direction from b to a to begin with, unit. `size` [m] is the order
// of magnitude of both. Allocates nothing.
CoreDistance distanceOfCores(const PosedSolid& a, const PosedSolid& b, const Vec3& shift, const Vec3& start,
                             double size, const CoreAccuracy& accuracy);

// The same of the solids whose faces lie further in (insetOf).
CoreDistance distanceOfInsets(const PosedSolid& a, const PosedSolid& b, const Vec3& start, double size);

}  // namespace pincer::contact
