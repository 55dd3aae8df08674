// wall_line: the straight line on a smooth mesh through a place of it, as the walls of cylinders, cones and prisms with
// rounded edges have.
//
//   d = a + (m / w) r     a straight edge of the triangle, of one normal at both ends; m the slope against it of the
//                         next such edge beside it, w how far that is away, r the way from the first edge to the place
//
// On a cone all lines meet in the tip, on a cylinder m = 0. The line runs across smooth edges up to the wall's rims.
#pragma once
#include "pincer/contact/surface/surface_net.h"

namespace pincer::contact {

class WallLine {
 public:
  // through `p` of the triangle `t`, in the mesh's frame
  WallLine(const SurfaceNet& net, std::int32_t t, const Vec3& p);

  bool exists() const { return high_ > low_; }
  const Vec3& along() const { return along_; }    // unit
  const Vec3& normal() const { return normal_; }  // out of the wall at p: at its rim the contact's is another one
  // Its ends, from p along it [m].
  double low() const { return low_; }
  double high() const { return high_; }

 private:
  int straightEdge(std::int32_t t) const;
  Vec3 lineThrough(std::int32_t t, int corner, const Vec3& along) const;
  bool findLine(std::int32_t t, const Vec3& q, Vec3& line, Vec3* n) const;
  bool goesOn(std::int32_t t, double x) const;
  double follow(std::int32_t t, double sign) const;
  Vec2 seen(const Vec3& q) const { return {along_.dot(q - p_), across_.dot(q - p_)}; }

  const SurfaceNet& net_;
  const Vec3 p_;
  Vec3 along_ = Vec3::UnitZ(), across_ = Vec3::UnitX(), normal_ = Vec3::UnitY();
  double low_ = 0, high_ = 0;
};

}  // namespace pincer::contact
