// thrown_ball: closed forms of a ball that slides, rolls and bounces on a floor with any spin. SI
// units; none shares code with the engine.
#pragma once
#include "pincer/contact/math.h"

namespace pincer::exact {

// --- Ball thrown along a floor with spin
// --------------------------------------------------------------------------------------------------
// The point that touches slips with u = v + w x (-r e_z). Friction -mu m g u/|u| changes v by -mu g
// and r w so that u keeps its direction and
// |u|' = -7/2 mu g: the path is a parabola until t* = 2 |u_0|/(7 mu g), then straight at v_0 - 2/7 u_0.
// Source: E. J. Routh, Dynamics of a System of Rigid Bodies, Advanced Part, 6th ed., 1905
// (motion of a billiard ball); derived above.
struct SpinningSlide {
  double radius, mu, g;
  Vec3 v0, w0;

  Vec3 slip() const;              // u_0 [m/s]
  double transitionTime() const;  // t* [s]
  Vec3 position(double t) const;  // from the start [m]
};

// --- Ball that bounces obliquely
// ------------------------------------------------------------------------------------------------------------ Each
// bounce multiplies the normal velocity by -e. Friction's impulse per mass is against u: mu (1 + e) |v_n|, or 2/7 |u|,
// which ends the slip, whichever is less; it changes r w by 5/2 of itself.
// Source: W. J. Stronge, Impact Mechanics, 2000, section 3.2 (a sphere; its friction and normal impulses don't couple).
struct ObliqueBounces {
  double radius, mu, restitution, g;
  double height;  // of the ball's lowest point at the start [m]
  Vec3 v0, w0;    // v0 level

  Vec3 position(double t) const;  // of the centre, from where it starts [m]
};

}  // namespace pincer::exact
