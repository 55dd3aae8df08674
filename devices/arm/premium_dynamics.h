// premium_dynamics: inertia of an arm like a Phantom Premium 1.5 with a point
// mass (thimble, display, finger) at its tip.
//
//   M(q) qddot + c(q, qdot) = tau,       M = [[m11, 0, 0], [0, m22, m23], [0, m23, m33]]
//   m11 = base + u_c cos^2 q2 + u_s sin^2 q2 + f_c cos^2 q3 + f_s sin^2 q3 + x cos q2 sin q3
//   m22 = u,   m33 = f,   m23 = -(x/2) sin(q2 - q3)                                           [kg m^2]
//   c = centrifugal and Coriolis torques, from M by Lagrange's equations                      [N m]
//   apparent mass at the tip: the eigenvalues of J^-T M J^-1                                  [kg]
//
// A mass m at the tip adds m l1^2 to u_c and u, m l2^2 to f_s and f, and 2 m l1 l2 to x. Gravity is taken as
// compensated (counterweights and feed-forward), so it doesn't appear. Angles as in premium_kinematics.h. Source:
// Cavusoglu, Feygin, Tendick, Presence 11 (2002) 555-568, eq. 12-14 and table 2. Departure: their products of half
// angles are collected into the seven constants above; the Coriolis terms are derived afresh.
#pragma once
#include "pincer/devices/arm/premium_kinematics.h"
#include "pincer/devices/math.h"

namespace pincer::devices::premium {

// The constants of M(q) [kg m^2].
struct Inertia {
  double base = 0, u_c = 0, u_s = 0, f_c = 0, f_s = 0, x = 0, u = 0, f = 0;
};

// Entries of M(q) and the sines and cosines that they were made from.
struct MassMatrix {
  double m11 = 0, m22 = 0, m23 = 0, m33 = 0;  // [kg m^2]
  double s2 = 0, c2 = 0, s3 = 0, c3 = 0;

  // M^-1 t. M is positive definite for every q.
  Vec3 solve(const Vec3& t) const;
  // M w.
  Vec3 times(const Vec3& w) const;
};

// The bare arm with `tip_mass` [kg] at the fingertip, >= 0.
Inertia inertia(double tip_mass);

MassMatrix massMatrix(const Inertia& inertia, const JointSines& at);
inline MassMatrix massMatrix(const Inertia& i, const Vec3& q) { return massMatrix(i, JointSines(q)); }

// c(q, qdot) [N m] for joint speeds `w` [rad/s], at the angles of `m`.
Vec3 coriolis(const Inertia& inertia, const MassMatrix& m, const Vec3& w);

// Joint speeds after dry friction whose impulse on joint i is at most `most[i]` [N m s]: the w' that minimises
// the kinetic energy w'^T M w' / 2 over all such impulses (maximal dissipation), so a joint that friction can
// hold is at rest. Projected Gauss-Seidel on the two coupled joints, at most 12 sweeps; every sweep lowers the
// energy, so a cut-off one still dissipates.
Vec3 afterDryFriction(const MassMatrix& m, const Vec3& w, const Vec3& most);

}  // namespace pincer::devices::premium
