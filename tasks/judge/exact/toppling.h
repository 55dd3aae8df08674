// toppling: when blocks and ladders stand, rock and jam. SI units; none shares code with the engine.
#pragma once
#include "pincer/contact/math.h"

namespace pincer::exact {

// --- Rocking block
// ---------------------------------------------------------------------------------------------------------------------
// A block of half width b and half height h turns about its bottom edge, tilted by th: (4/3) m R^2 th'' = -m g R
// sin(alpha - th), R = sqrt(b^2 + h^2), alpha = atan(b/h). When it falls onto the other edge without slip and without
// bounce, angular momentum about that edge is kept, which leaves the part 1 - (3/2) sin^2 alpha of its angular
// velocity. Source: G. W. Housner, Bull. Seismol. Soc. Am. 53(2) (1963) 403-417.
struct RockingBlock {
  double half_width, half_height, g;

  double fallTime(double tilt) const;   // from rest at `tilt` to upright, by Runge-Kutta's method at 10 us [s]
  double nextPeak(double tilt) const;   // the tilt that it reaches on the other edge [rad]
  double angularVelocityRatio() const;  // after over before the impact
};

// --- Ladder on a wall
// ---------------------------------------------------------------------------------------------------------------------
// A uniform ladder with round ends of radius r, length L between their centres, at the angle th to
// the floor, friction mu at both ends. On the point of sliding the floor gives (mu N, N) and the wall
// (-mu N, mu^2 N); moments about the middle:
//   (L/2) cos th (mu^2 - 1) + mu L sin th + r mu (1 + mu) = 0
// For r = 0: tan th = (1 - mu^2)/(2 mu). It stands at steeper angles.
double leastAngleOfLadder(double mu, double length, double end_radius);  // [rad]

// --- Painleve's rod
// ---------------------------------------------------------------------------------------------------------------------
// A body touches a rough floor at p - c (from its centre of mass, in the plane (x, z)) and slides
// along x; where no finite force is possible
// the tip stops dead, by the impulse r = -W^-1 u,  W = 1/m + (1/I) [z^2, -x z; -x z, x^2],
//                                                  if that lies within the friction cone.
// Source: P. Painleve, C. R. Acad. Sci. 121 (1895) 112-115; F. Genot, B. Brogliato,
// Eur. J. Mech. A 18 (1999) 653-677 (the jam).
struct Jam {
  Vec2 impulse;  // along x and z [N s]
  Vec2 v;        // of the centre of mass after it [m/s]
  double w;      // about y [rad/s]
};
Jam jamOfTip(double mass, double inertia, const Vec2& tip, const Vec2& v);

}  // namespace pincer::exact
