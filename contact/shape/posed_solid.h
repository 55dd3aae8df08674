// posed_solid: a convex solid where it is, seen in the axes of the world from an origin near by.
#pragma once
#include "pincer/contact/shape/convex_features.h"

namespace pincer::contact {

struct PosedSolid {
  const Shape& shape;
  Mat3 R;           // solid's frame in the world's axes
  Vec3 p;           // of the solid's origin [m]
  double skin = 0;  // radius of a ball about all of it, beside the shape's own rounding: a fingertip's pad [m]

  // Written out by columns: Eigen's 3x3 product is a call of its own here.
  [[gnu::always_inline]] Vec3 outwards(const Vec3& v) const {
    return v.x() * R.col(0) + v.y() * R.col(1) + v.z() * R.col(2);
  }
  [[gnu::always_inline]] Vec3 inwards(const Vec3& v) const {
    return {R.col(0).dot(v), R.col(1).dot(v), R.col(2).dot(v)};
  }
  Vec3 place(const Vec3& p_B) const { return p + outwards(p_B); }
  Vec3 support(const Vec3& d) const { return place(supportOf(shape, inwards(d))); }
  Vec3 inset(const Vec3& d) const { return place(insetOf(shape, inwards(d))); }
};

inline double roundingOf(const PosedSolid& solid) { return roundingOf(solid.shape) + solid.skin; }

}  // namespace pincer::contact
