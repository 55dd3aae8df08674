// solid_feature: the corner, straight edge, round rim, face or core line of a convex solid at which it is touched.
//
//   F  a convex set of points of the solid, or a rim's circle
//   contact is at the ball of radius rho about the point c of F
//
//   | touched at | F | rho |
//   |---|---|---|
//   | corner | the point | 0 |
//   | end, side of a capsule | end, segment of its core | the capsule's radius |
//   | edge of a box, hull, flat | the segment | 0 |
//   | round wall of a cylinder | its axis | the cylinder's radius |
//   | rim of a cylinder | the circle | 0 |
//   | face | the face, moved into the solid by `lift` | lift |
//
// To all of them comes the rounding of a fingertip's pad. The face is moved in so that what reaches a little into the
// solid is in front of F.
#pragma once
#include "pincer/contact/shape/posed_solid.h"

namespace pincer::contact {

class SolidFeature {
 public:
  // The one that holds the point `c` [m] of the solid's core, touched along the unit `d`, out of the solid; both in the
  // solid's frame. `slack` [m] from an end counts as the end; kWhole: none does, and F is all of the face or line that
  // faces along `d`. Allocates nothing.
  static constexpr double kWhole = -kInfinity;
  SolidFeature(const Shape& shape, const Vec3& c, const Vec3& d, double skin, double lift, double slack);

  // The point of F nearest to `p`, both in the solid's frame [m].
  Vec3 nearest(const Vec3& p) const;
  double rho() const { return rho_; }  // [m]
  bool isSharp() const { return !(rho_ > 0); }
  // True if the point `c` of F is where F ends and something less is touched: on a face's outline, at the end of a wall
  // or edge. And where that was before a face was moved.
  bool isEnd(const Vec3& c, double slack) const;
  // True if a round wall isn't there along `d`: its cylinder is cut off by a flat.
  bool isCutOff(const Vec3& d) const { return kind_ == Kind::segment && circle_ * d.x() > flat_ * d.head<2>().norm(); }
  Vec3 moveOut(const Vec3& c) const { return kind_ == Kind::face ? Vec3(c + lift_ * face_.n) : c; }
  std::uint32_t name() const { return name_; }  // the same for as long as it is this one, below 2^16

 private:
  enum class Kind { point, segment, circle, face };

  void setPoint(const Vec3& p, std::uint32_t name);
  void setSegment(const Vec3& from, const Vec3& to, std::uint32_t name);
  void setLine(const Facet& facet, const Vec3& c, double rounding, double slack);
  void setOnPolygon(const Vec3& c, double lift, double slack);
  void setOnRim(double z);
  Vec3 nearestOnCircle(const Vec3& p) const;
  Vec3 nearestOfFace(const Vec3& p) const;

  Kind kind_ = Kind::point;
  // of a segment; `from_` also a point, and the middle of a circle about z
  Vec3 from_ = Vec3::Zero(), to_ = Vec3::Zero();
  double circle_ = 0;        // radius of the circle [m]
  double flat_ = kInfinity;  // x where a flat cuts the circle off [m]
  double rho_, lift_ = 0;    // [m]
  std::uint32_t name_ = 0;
  Facet face_;  // moved in
};

}  // namespace pincer::contact
