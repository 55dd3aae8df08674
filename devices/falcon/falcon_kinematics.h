// falcon_kinematics: a Novint Falcon, a delta robot: three legs of thigh and
// parallelogram that carry the grip without turning it.
//
//   P = Rz(-phi) p + (-r, -s, 0),   L = d + e + sqrt(b^2 - (P_v + f)^2)
//   (P_u + c - a cos t)^2 + (P_w - a sin t)^2 = L^2                     for each leg's motor angle t
//   t = atan2(P_w, P_u + c) - acos((rho^2 + a^2 - L^2) / (2 a rho)),   rho = |(P_u + c, P_w)|
//                                                                      the knee bent outward
//   J^-1 rows: -(dF/dp) / (dF/dt) of the equation F = 0 above;   tau = J^T f
//
// p place of the grip in the robot's own frame: origin at the middle of the base, x right, y up, z towards the
// operator [m]; (u, v, w) the same in a leg's frame; phi the leg's angle. D of devices/arm has its origin at `kCentre`
// on z. Source: the leg's equation from R. E. Stamper, doctoral dissertation, University of Maryland, PhD 97-4 (1997),
// ch. 3; sizes, leg angles and encoder scale as in libnifalcon (K. Machulis and others; FalconGeometry.h,
// StamperUtils), measured by them: the maker published none. Inverse and Jacobian are derived here; the forward
// kinematics is Newton's method on the three equations.
#pragma once
#include <array>
#include <optional>

#include "pincer/devices/math.h"

namespace pincer::devices::falcon {

struct Geometry {
  double a = 0.060;     // thigh [m]
  double b = 0.1025;    // shin parallelogram
  double c = 0.01443;   // shin's joint to the grip's centre, along u
  double d = 0.01125;   // shin's joint at the grip
  double e = 0.01125;   // and at the knee
  double f = -0.025;    // shin's joint to the grip's centre, along v
  double r = 0.0400;    // middle of the base to the leg, along u
  double s = -0.02309;  // and along v
};

inline constexpr double kCentre = 0.125;  // of the workspace, on z [m]

// The motor angles [rad] of the place `p` [m]; absent where the legs can't reach.
std::optional<Vec3> inverse(const Vec3& p, const Geometry& g = {});
// The place of motor angles, found from `guess`; absent where Newton's method doesn't get to 1 nm in 20 steps.
std::optional<Vec3> forward(const Vec3& angles, const Vec3& guess = Vec3(0, 0, kCentre), const Geometry& g = {});
// d p / d angles [m/rad] at `p` and its angles; absent where singular.
std::optional<Mat3> jacobian(const Vec3& p, const Vec3& angles, const Geometry& g = {});

// An encoder's count and a motor's angle [rad]: 4 x 320 counts per turn of a shaft of 14.25 mm that
// drives a sector of 110 mm; 35 degrees at 0.
double angleOf(int count);
int countOf(double angle);  // nearest

}  // namespace pincer::devices::falcon
