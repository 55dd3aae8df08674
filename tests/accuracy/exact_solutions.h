// exact_solutions: closed forms, and fine integrations of exact equations of motion, against which the scenes of tasks/scenes are judged.
//
// SI units. Each is derived here or names its source; none shares code with the engine.
#pragma once
#include <vector>

#include "contact/math.h"

namespace pincer::exact {

// --- Sphere thrown along a floor without spin -------------------------------------------------------------------------------------------
// Sliding: v = v0 - mu g t, and the friction's moment spins it up: (2/5) m r^2 w' = mu m g r, so r w = (5/2) mu g t. They meet, and it rolls
// from then on, at t* = 2 v0/(7 mu g) with v = 5/7 v0, after the way 12 v0^2/(49 mu g).
// Source: E. J. Routh, Dynamics of a System of Rigid Bodies, Elementary Part, 7th ed., 1905 (bowling ball); derived above.
struct SlideToRoll {
  double v0;  // [m/s]
  double mu;  // [-]
  double g;   // [m/s^2]

  double transitionTime() const { return 2 * v0 / (7 * mu * g); }
  double position(double t) const;  // [m]
  double velocity(double t) const;  // [m/s]
};

// --- Box on a slope ---------------------------------------------------------------------------------------------------------------------
// Along the slope m a = m g sin th - mu m g cos th while it slides; it stays if tan th <= mu.
struct Slope {
  double theta;  // [rad]
  double mu;     // [-]
  double g;      // [m/s^2]

  double acceleration() const;                                                           // of a sliding box, downhill [m/s^2]
  double way(double v0, double t) const { return (v0 + 0.5 * acceleration() * t) * t; }  // downhill, from v0 >= 0 [m]
};

// --- Sphere that slides down between two fingertips ---------------------------------------------------------------------------------------
// Sphere (m, R) at depth d below the line of the fingertips (m_f, r), each pushed by F towards it and free along x only, at distance
// x = sqrt(L^2 - d^2), L = R + r. With s = d/L, c = x/L, the normal force N of each and friction mu N against the sliding:
//   sphere, downwards:    m d'' = m g + 2 N (s - mu c)
//   fingertip, outwards:  m_f x'' = -F + N (c + mu s),    x'' = -(d'^2 + d d'')/x - d^2 d'^2/x^3
// By symmetry the sphere doesn't turn. Two linear equations for d'' and N, integrated with Runge-Kutta's method at 10 us: its error, of
// 4th order, is below 1e-12 of the time.
struct SlidingPinch {
  double sphere_mass, sphere_radius, finger_mass, finger_radius, force, mu, g;

  double dropTime(double depth) const;  // until the sphere is `depth` below where it started at rest [s]

 private:
  double acceleration(double d, double v) const;
};

// --- Object that sticks to two fingers on springs -----------------------------------------------------------------------------------------
// (m + 2 m_f) z'' = 2 k (z_d - z) + 2 c (z_d' - z'),  z_d a minimum-jerk reach of height h and time T that starts at t0.
// Integrated with Runge-Kutta's method at a twentieth of a tick: error below 1e-14 m.
struct StuckLift {
  double total_mass, stiffness, damping;  // of everything that moves; of one finger
  double height, reach_time, start_time;

  // Rise above the start after each of `ticks` ticks of length `h`.
  std::vector<double> rises(int ticks, double h) const;
};

// --- Free rigid body ------------------------------------------------------------------------------------------------------------------------
// Euler's equations I w' = (I w) x w in the body, q' = q (0, w)/2. Integrated with Runge-Kutta's method at 20 us; at 20 rad/s its error after
// 1 s is below 1e-12 rad. Source: L. Landau, E. Lifshitz, Mechanics, 3rd ed., 1976, eq. (36.5).
Quat freeRotation(const Vec3& moments, const Vec3& w_B, double time);

}  // namespace pincer::exact
