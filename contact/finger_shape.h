// finger_shape: what a fingertip looks like, in its own frame F: a round core and nothing more, so
// that the surface needs to know only planes.
//
//   finger = K + ball(rho),   support point  s(d) = s_K(d) + rho d        K convex core, rho > 0 [m], d unit direction
//
//   sphere     K the point F's origin, rho its radius
//   capsule    K the segment from -half to +half, rho its radius
//   ellipsoid  K what the centres of balls of its least radius of curvature, min(a)^2 / max(a),
//              reach inside it (its inner parallel body)
//   pad        K the convex hull of points, rho the rounding of its edges
// Source: W. Blaschke, Kreis und Kugel (1916), section 24 (rolling theorem: an ellipsoid
// is its inner parallel body plus the ball).
#pragma once
#include <memory>
#include <string>
#include <variant>

#include "pincer/contact/math.h"
#include "pincer/contact/shape.h"

namespace pincer::contact {

struct CapsuleTip {
  double radius;  // > 0 [m]
  Vec3 half_F;    // from the middle to one end of the segment [m], not zero
};
struct EllipsoidTip {
  Vec3 semi_axes;  // along F's axes, each > 0 [m]
};
struct PadTip {
  std::shared_ptr<const Polytope> hull;  // in F; never null
  double rounding;                       // > 0 [m]
};
using FingerShape = std::variant<Sphere, CapsuleTip, EllipsoidTip, PadTip>;

double roundingOf(const FingerShape& finger);                    // rho [m]
double boundingRadiusOf(const FingerShape& finger);              // about F's origin [m]
Vec3 supportOf(const FingerShape& finger, const Vec3& d_F);      // s(d), d unit [m]
Vec3 coreSupportOf(const FingerShape& finger, const Vec3& d_F);  // s_K(d) [m]
// The point of K nearest to `p_F` where p_F lies outside of K; else K's support point along `d_F`, unit [m].
Vec3 nearestOnCore(const FingerShape& finger, const Vec3& p_F, const Vec3& d_F);

// Way over the finger's skin from its support point along the unit `from_F` to the point `to_F` of its surface, whose
// outward normal is the unit `normal_F`: along the support points of the directions between the two normals. Exact for
// spheres; others to about 1e-4 of it [m].
double arcOverSkin(const FingerShape& finger, const Vec3& from_F, const Vec3& normal_F, const Vec3& to_F);

// Its fault, as a sentence; empty if there is none.
std::string problemWith(const FingerShape& finger);

}  // namespace pincer::contact
