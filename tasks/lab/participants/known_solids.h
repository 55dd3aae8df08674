// known_solids: what a participant has been told about the seven solids it is to tell apart: their sizes, learnt by looking at models of them.
// Behind the wall: made here from those sizes, not from what is rendered.
//
//   nearest point on the solid to p:  the projection onto the intersection of half-spaces n_k . x <= d_k (Dykstra), or onto a sphere
//
// All stand upright about z, their middle at the origin: prisms, pyramids and the sphere have a circumradius of 40 mm and are 80 mm long, the
// cube 56.6 mm. Round ones are remembered with 24 sides. Projection: J. P. Boyle, R. L. Dykstra, Lecture Notes in Statistics 37, 1986.
#pragma once
#include <array>
#include <vector>

#include "pincer/devices/math.h"

namespace pincer::tasks {

constexpr int kSolids = 7;
constexpr std::array<const char*, kSolids> kSolidNames{"cone", "cylinder", "cube", "sphere", "tetrahedron", "octagon", "triangle"};

class KnownSolid {
 public:
  static KnownSolid prism(int sides, double radius, double half_length);
  static KnownSolid pyramid(int sides, double radius, double half_length);  // the tip up
  static KnownSolid sphere(double radius);

  Vec3 nearest(const Vec3& p) const;  // to a point outside; a point inside is its own
  // Where the surface goes: the nearest face's normal for a point inside, else the direction from the nearest point.
  Vec3 outward(const Vec3& p) const;

 private:
  struct Plane {
    Vec3 n;
    double d;
  };
  static std::vector<Plane> around(int sides, double radius, double half_length, double taper);

  std::vector<Plane> planes_;  // empty: a sphere
  double radius_ = 0;
};

// In the order of kSolidNames.
std::array<KnownSolid, kSolids> knownSolids();

}  // namespace pincer::tasks
