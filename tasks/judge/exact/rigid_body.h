// rigid_body: exact motions of free and rolling bodies. SI units; none shares code with the engine.
#pragma once
#include "pincer/contact/math.h"

namespace pincer::exact {

// --- Free rigid body
// ---------------------------------------------------------------------------------------------------------------------
// Euler's equations I w' = (I w) x w in the body, q' = q (0, w)/2. Integrated with Runge-Kutta's method at 20 us; at 20
// rad/s its error after 1 s is below 1e-12 rad. Source: L. Landau, E. Lifshitz, Mechanics, 3rd ed., 1976, eq. (36.5).
Quat freeRotation(const Vec3& moments, const Vec3& w_B, double time);

// --- Free symmetric top
// ---------------------------------------------------------------------------------------------------------------------
// I_1 = I_2 = I, I_3 along z of the body: regular precession q(t) = exp(L t/I) exp(e_z w_3 (1 - I_3/I) t), q(0) = 1, L
// = (I w_1, I w_2, I_3 w_3). Source: L. Landau, E. Lifshitz, Mechanics, 3rd ed., 1976, section 33.
Quat symmetricTop(double I, double I3, const Vec3& w, double time);

// --- Heavy symmetric top (Lagrange's)
// --------------------------------------------------------------------------------------------------------- Moments I
// about two axes through the fixed tip and I3 about the third, along which the centre of mass lies at the distance l.
// Of the axis' angle a to the vertical and its heading f:
//   L_3 = I3 w_3, L_z constant,   f' = (L_z - L_3 cos a)/(I sin^2 a)
//   I a'' = I f'^2 sin a cos a - L_3 f' sin a + m g l sin a
// a constant gives I W^2 cos a - L_3 W + m g l = 0 for f' = W, whose smaller root is the slow precession.
// Source: L. Landau, E. Lifshitz, Mechanics, 3rd ed., 1976, section 35, problem 1.
struct HeavyTop {
  double mass, lever, I, I3, w3, g;

  double slowPrecession(double angle) const;  // W [rad/s]

  // Where the axis points at `time` if at time 0 it is at `angle` to the vertical in the plane y = 0
  // and goes round with `heading_rate`, its angle constant for the moment. By Runge-Kutta's method at
  // 20 us: its error over 10 s is below 1e-12.
  Vec3 axisAfter(double time, double angle, double heading_rate) const;
};

// --- Euler's disk
// ---------------------------------------------------------------------------------------------------------------------
// A cylinder (radius R, thickness 2 b) rolls on its rim at the inclination a, its centre of mass at rest. The point
// that touches lies at r_c = R d - b a_ (d down the disk, a_ its axis) and is at rest, so w = -(W sin a/R) r_c; W z x
// L is the moment of the normal force m g:
//   W^2 sin a (I_d cos a - I_a (b/R) sin a) = m g (R cos a - b sin a)
// For b = 0 this is W^2 = 4 g/(R sin a). Source: H. K. Moffatt, Nature 404 (2000) 833-834 (b = 0); derived above.
double precessionOfEulersDisk(double R, double b, double inclination, double g);  // W [rad/s]

}  // namespace pincer::exact
