// two_dof_kinematics: how the three actuators of a 2-DOF contact location display put
// its tactor on the bottom half of a finger.
//
//   p(q) = (x + R cos b sin a,  R sin b,  -R cos b cos a)                         tactor's root, on the ring
//   J = d p / d q,   det J = -R^2 cos^2 b sin a
//       singular: ring upright (a = 0), carriage at +-90 degrees
//   s(x, a):  x_profile(s) + R a_profile(s) = x + R a                             place
//             along the finger, by the finger's profile
//   place_L = (s, r b)                              where s <= 0: the finger is a cylinder there
//   place_L = r t (u_x, u_y),  cos t = cos b cos(s/r),  u along (cos b sin(s/r), sin b)      where s > 0: a sphere
//
// q = (x, a, b): slide of the plate [m, distal positive], tilt of the ring about the radial-ulnar axis [rad], way of
// the carriage round the ring [rad, radial positive]. p in the fingertip's frame: origin at the centre of the tip's
// sphere, x distal, y radial, pad towards -z [m]. R radius of the ring, r of the finger [m]. The profile leads plate
// and ring so that the tactor, which sticks out R - r inward, presses evenly; place_L as in tactile_display.h
// (azimuthal about the pad's centre on the tip). Source: A. J. Doxon, doctoral dissertation, University of Utah (2014),
// ch. 4: sliding plate, tilting ring of radius 19 mm (index finger) or 21 mm (thumb), carriage on a capstan cable. The
// equations, the default profile and the limits are ours.
#pragma once
#include <optional>
#include <string>
#include <vector>

#include "pincer/devices/math.h"

namespace pincer::devices {

// Where plate and ring stand while the tactor is at `place` on the pad's middle line.
struct ProfilePoint {
  double place = 0;  // s [m]
  double plate = 0;  // x [m]
  double tilt = 0;   // a [rad]
};

// A finger, measured or not: points with growing place; plate and tilt never shrink, one of them grows.
struct FingerProfile {
  double radius = 0.008;  // r [m]
  std::vector<ProfilePoint> points;

  // A cylinder with a half sphere at its end: the plate follows the cylinder, the ring the sphere.
  static FingerProfile capsule(double radius);
};

struct TwoDofGeometry {
  double ring_radius = 0.019;  // R [m]: 0.019 index finger, 0.021 thumb
  double place_min = -0.012;   // s [m]
  double place_max = 0.012;
  double carriage_max = 1.25;  // largest |b| [rad]
};

// The mistake, as a sentence with field, value and range; absent if there is none.
std::optional<std::string> problemWith(const TwoDofGeometry& geometry, const FingerProfile& profile);

// Along the finger and round it [m, rad]: s and b. What the actuators are led by.
struct PadWay {
  double along = 0, round = 0;
};

struct Reach {
  PadWay way;                   // of the nearest place that can be reached
  Vec2 place_L = Vec2::Zero();  // that place [m]
  bool moved = false;           // the place asked for can't be reached
};

class TwoDofKinematics {
 public:
  // Throws std::invalid_argument for a geometry or profile that problemWith() objects to.
  explicit TwoDofKinematics(const TwoDofGeometry& geometry = {}, FingerProfile profile = FingerProfile::capsule(0.008));

  Vec3 tactorRoot(const Vec3& q) const;       // p(q) [m]
  Mat3 jacobian(const Vec3& q) const;         // J
  Vec3 actuatorsAt(const PadWay& way) const;  // q on the profile
  PadWay wayOf(const Vec3& q) const;          // also off the profile
  Vec2 placeAt(const PadWay& way) const;      // place_L [m]
  PadWay wayTo(const Vec2& place_L) const;    // whether or not it can be reached
  // False if `place_L` can't be reached.
  bool reaches(const Vec2& place_L) const { return reaches(place_L, wayTo(place_L)); }
  // The way to `place_L`, or to the reachable place nearest to it in L. Allocates nothing.
  Reach reach(const Vec2& place_L) const;

  const TwoDofGeometry& geometry() const { return geometry_; }
  const FingerProfile& profile() const { return profile_; }

 private:
  bool reaches(const Vec2& place_L, const PadWay& way) const;
  PadWay nearestOnEdge(const Vec2& place_L, const PadWay& from, const PadWay& to) const;

  TwoDofGeometry geometry_;
  FingerProfile profile_;
};

}  // namespace pincer::devices
