// pinch: exact motions of objects held by two fingers. SI units; none shares code with the engine.
#pragma once
#include <vector>

#include "pincer/contact/math.h"

namespace pincer::exact {

// --- Sphere that slides down between two fingertips
// --------------------------------------------------------------------------------------- Sphere (m, R) at depth d
// below the line of the fingertips (m_f, r), each pushed by F towards it and free along x only, at distance x =
// sqrt(L^2 - d^2), L = R + r. With s = d/L, c = x/L, the normal force N of each and friction mu N against the sliding:
//   sphere, downwards:    m d'' = m g + 2 N (s - mu c)
//   fingertip, outwards:  m_f x'' = -F + N (c + mu s),    x'' = -(d'^2 + d d'')/x - d^2 d'^2/x^3
// By symmetry the sphere doesn't turn. Two linear equations for d'' and N, integrated with Runge-Kutta's method at 10
// us: its error, of 4th order, is below 1e-12 of the time.
struct SlidingPinch {
  double sphere_mass, sphere_radius, finger_mass, finger_radius, force, mu, g;

  double dropTime(double depth) const;  // until the sphere is `depth` below where it started at rest [s]

 private:
  double acceleration(double d, double v) const;
};

// --- Object that sticks to two fingers on springs
// -----------------------------------------------------------------------------------------
// (m + 2 m_f) z'' = 2 k (z_d - z) + 2 c (z_d' - z'),  z_d a minimum-jerk reach of height
//                                                     h and time T that starts at t0.
// Integrated with Runge-Kutta's method at a twentieth of a tick: error below 1e-14 m.
struct StuckLift {
  double total_mass, stiffness, damping;  // of everything that moves; of one finger
  double height, reach_time, start_time;

  // Rise above the start after each of `ticks` ticks of length `h`.
  std::vector<double> rises(int ticks, double h) const;
};

// --- Plate between two soft fingers
// ------------------------------------------------------------------------------------------------------- Each finger
// carries force and moment within (f)^2 + (tau/e)^2 <= (mu N)^2 (e torsion radius). Held at the distance d beside its
// centre of mass each carries m g/2 and m g d/2: it holds if mu >= sqrt((m g/2)^2 + (m g d/(2 e))^2)/N. Source of the
// ellipsoid: S. Goyal, A. Ruina, J. Papadopoulos, Wear 143(2) (1991) 307-330.
double leastFrictionOfOffsetPlate(double mass, double offset, double torsion_radius, double force, double g);

// --- Plate that slides and spins between two soft fingers
// --------------------------------------------------------------------------------- Fingers fixed at the origin; plate
// with centre p, angle th, velocity v, angular velocity w, in its plane, without weight:
//   v_c = v + w x (0 - p),  s = sqrt(v_c^2 + e^2 w^2)
//   m v' = -2 mu N v_c/s,  I w' = -2 mu N e^2 w/s + (0 - p) x (m v')
// Friction dissipates most on that ellipsoid. Integrated with Runge-Kutta's method at 2 us up to s =
// 1e-7 m/s, which is 1e-14 m before the end.
struct PlateRest {
  Vec2 p;        // [m]
  double angle;  // [rad]
  double time;   // [s]
};
PlateRest slidingSpinningPlate(double mass, double inertia, double torsion_radius, double friction_force,
                               const Vec2& v0, double w0);

// --- Box between two pads on springs whose targets shake
// In the pads' plane: box p_b (m), turned by theta (inertia J about the pads' axis), both pads p_p (2 m_p) behind 2 k
// and 2 c towards the target
//   t(time) = swing min(time/1 s, 1) sin(2 pi hertz time) along
//   m p_b'' = m g + sum F_i,   J theta'' = sum rho_i x F_i,   2 m_p p_p'' = 2 k (t - p_p) + 2 c (t' - p_p') - sum F_i
//   |F_i| <= mu N / 2 on the box at the pads' corners,  rho_i = p_p + (+-a, +-a) - p_b,  sticks as long as it can
// A box that has slipped down hangs beside its pads' middle, and turns where they shake it across: by .24 mrad over
// .44 mm, which is 2.4 % of the slip of a point. Both pads' corners share N evenly, as the box has no moment across.
// Integrated at 4 us, velocity first; friction as the impulses that end the slip within the step, or their limits, by
// sweeps over the corners.
struct ShakenGrip {
  double mass, inertia, pad_mass, corner, stiffness, damping, press, mu, swing, hertz;
  Vec2 along;  // across and up, in the pads' plane
  double g;

  struct Slip {
    Vec2 way;      // of the box past its pads [m]
    double angle;  // theta [rad]
  };
  Vec2 target(double time) const;
  Vec2 targetSpeed(double time) const;
  double leastFriction(double seconds) const;          // with which the box sticks all the time
  std::vector<Slip> slips(int ticks, double h) const;  // after each tick
};

}  // namespace pincer::exact
