// sliding_rolling: closed forms of boxes and spheres on floors and slopes. SI units; none shares code with the engine.
#pragma once
#include "pincer/contact/math.h"

namespace pincer::exact {

// --- Box on a slope
// ---------------------------------------------------------------------------------------------------------------------
// Along the slope m a = m g sin th - mu m g cos th while it slides; it stays if tan th <= mu.
struct Slope {
  double theta;  // [rad]
  double mu;     // [-]
  double g;      // [m/s^2]

  double acceleration() const;  // of a sliding box, downhill [m/s^2]
  double way(double v0, double t) const { return (v0 + 0.5 * acceleration() * t) * t; }  // downhill, from v0 >= 0 [m]
};

// --- Box thrown along a floor
// -------------------------------------------------------------------------------------------------------------
// m a = -mu m g until it stops.
struct Stopping {
  double v0, mu, g;

  double time() const { return v0 / (mu * g); }          // [s]
  double way() const { return v0 * v0 / (2 * mu * g); }  // [m]
};

// --- Sphere thrown along a floor without spin
// ------------------------------------------------------------------------------------------- Sliding: v = v0 - mu g t,
// and the friction's moment spins it up: (2/5) m r^2 w' = mu m g r, so r w = (5/2) mu g t. They meet, and it rolls from
// then on, at t* = 2 v0/(7 mu g) with v = 5/7 v0, after the way 12 v0^2/(49 mu g). Source: E. J. Routh, Dynamics of a
// System of Rigid Bodies, Elementary Part, 7th ed., 1905 (bowling ball); derived above.
struct SlideToRoll {
  double v0;  // [m/s]
  double mu;  // [-]
  double g;   // [m/s^2]

  double transitionTime() const { return 2 * v0 / (7 * mu * g); }
  double position(double t) const;  // [m]
  double velocity(double t) const;  // [m/s]
};

// --- Sphere let go on a slope
// -------------------------------------------------------------------------------------------------------------
// Rolling: m a = m g sin th - F and (2/5) m r^2 a/r = F r give a = 5/7 g sin th, F = 2/7 m g sin th <= mu m g cos th if
// mu >= 2/7 tan th. Else it slides: a = g (sin th - mu cos th), r w' = 5/2 mu g cos th.
struct RollingIncline {
  double theta, mu, g;

  bool rolls() const;
  double acceleration() const;         // downhill [m/s^2]
  double surfaceAcceleration() const;  // r w' [m/s^2]
};

// --- Sphere rolled between two plates
// ----------------------------------------------------------------------------------------------------- Without slip on
// either, at its lowest and its highest point: v + w x (-R z) = v_1, v + w x (R z) = v_2, so
//   v = (v_1 + v_2)/2,   w = z x (v_2 - v_1)/(2 R)   (none about z: points don't turn it)
// Ways in place of velocities if both plates keep their directions.
// Source: D. J. Montana, Int. J. Robotics Research 7(3) (1988) 17-32 (kinematics of rolling contact).
struct RolledBall {
  Vec3 way, turn;  // [m], rotation vector [rad]
};
RolledBall rolledBetweenPlates(double radius, const Vec3& way1, const Vec3& way2);

// --- Sphere that spins on the spot
// -------------------------------------------------------------------------------------------------------- (2/5) m r^2
// w' = -mu e m g, e the torsion radius: it stops after 2 r^2 w0/(5 mu e g).
struct SpinDown {
  double w0, radius, mu, torsion_radius, g;

  double deceleration() const { return 5 * mu * torsion_radius * g / (2 * radius * radius); }  // [rad/s^2]
  double time() const { return w0 / deceleration(); }                                          // [s]
};

// --- Sphere that rolls against rolling resistance
// ------------------------------------------------------------------------------------------- Friction f and the
// moment against rolling share a cone, |(f, moment / e)| = mu m g, opposite to the creep v - R w and to e w. With v =
// (R + k) w for ever: f / (moment / e) = k / e, so f = mu m g k / s, moment = mu m g e^2 / s, s = sqrt(k^2 + e^2), and
// m v' = -f, (2/5) m R^2 w' = f R - moment give
//   R k^2 + (7/5 R^2 - e^2) k - R e^2 = 0,   v' = -mu g k / s.
// Source: derived here; the cone is that of engine/solve/contact_problem.h, decision 15.
struct RollingResistance {
  double v0, radius, mu, rolling_radius, g;

  double creep() const;                                                       // k [m]
  double deceleration() const;                                                // [m/s^2]
  double spin() const { return v0 / (radius + creep()); }                     // at the start [rad/s]
  double time() const { return v0 / deceleration(); }                         // until it stops [s]
  double way(double t) const { return (v0 - 0.5 * deceleration() * t) * t; }  // [m], t <= time()
};

}  // namespace pincer::exact
