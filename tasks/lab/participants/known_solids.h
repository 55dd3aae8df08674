// known_solids: the seven solids of shape identification as somebody imagines them who knows their
// names: their forms exactly, their sizes roughly (shape_explorer.h), not which way they lie. Behind the
// wall: made here, not from what is rendered.
//
//   turned solids   nearest point in the meridian plane (x, rho), rho = |(y, z)|, of a polygon;
//                   prisms: of a polygon in (y, z), and x clamped
//   pyramid         the projection onto the intersection of half-spaces n_k . x <= d_k
//
// Frame: x the axis, which lies from left to right, y away, z up; the middle of the length is the
// origin. Radius 40 mm, 80 mm long, the cube
// 56.6 mm. Projection: J. P. Boyle, R. L. Dykstra, Lecture Notes in Statistics 37, 1986.
#pragma once
#include <array>
#include <variant>
#include <vector>

#include "pincer/devices/math.h"

namespace pincer::tasks {

// The solids of the shape study, in the order of its list of answers.
constexpr int kSolids = 7;
constexpr std::array<const char*, kSolids> kSolidNames{"cone",        "cylinder", "cube",    "sphere",
                                                       "tetrahedron", "octagon",  "triangle"};

// Corners counter-clockwise.
using ConvexPolygon = std::vector<Vec2>;

class KnownSolid {
 public:
  static KnownSolid sphere(double radius);
  static KnownSolid cylinder(double radius, double half_length);
  // the tip on the right (side = 1) or left (-1)
  static KnownSolid cone(double radius, double half_length, double side);
  // The first corner at `turn` from up, about the axis [rad].
  static KnownSolid prism(int sides, double radius, double half_length, double turn);
  static KnownSolid pyramid(int sides, double radius, double half_length, double turn, double side);

  Vec3 nearest(const Vec3& p) const;  // to a point outside; a point inside is its own
  // Where the surface goes: the nearest face's normal for a point inside, else the direction from the nearest point.
  Vec3 outward(const Vec3& p) const;

 private:
  struct Ball {
    double radius;
  };
  struct Turned {
    ConvexPolygon meridian;  // (x, rho), mirrored at rho = 0
  };
  struct Prism {
    ConvexPolygon section;  // (y, z)
    double half_length;
  };
  struct Plane {
    Vec3 n;
    double d;
  };
  using Planes = std::vector<Plane>;

  static Vec3 nearestOn(const Ball& ball, const Vec3& p);
  static Vec3 nearestOn(const Turned& turned, const Vec3& p);
  static Vec3 nearestOn(const Prism& prism, const Vec3& p);
  static Vec3 nearestOn(const Planes& planes, const Vec3& p);
  static Vec3 normalWithin(const Ball& ball, const Vec3& p);
  static Vec3 normalWithin(const Turned& turned, const Vec3& p);
  static Vec3 normalWithin(const Prism& prism, const Vec3& p);
  static Vec3 normalWithin(const Planes& planes, const Vec3& p);

  std::variant<Ball, Turned, Prism, Planes> form_ = Ball{0};
};

// A way that one of the seven may lie.
struct LyingSolid {
  int name = 0;           // place in kSolidNames
  int way = 0, ways = 1;  // of those in which that one may lie
  KnownSolid solid;
};

// Pointing left or right, a face or an edge on top.
std::vector<LyingSolid> lyingSolids();

}  // namespace pincer::tasks
