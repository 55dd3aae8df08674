// bouncing: what hits do to spheres and plates. SI units; none shares code with the engine.
#pragma once
#include "pincer/contact/math.h"

namespace pincer::exact {

// --- Ball dropped onto a floor
// ------------------------------------------------------------------------------------------------------------ Newton's
// law u+ = -e u-: each hit leaves e of the speed, so e^2 of the height, and each flight lasts e times the one before:
//   h_n = e^(2 n) h,   T = sqrt(2 h/g) (1 + 2 (e + e^2 + ...)) = sqrt(2 h/g) (1 + e)/(1 - e)
// Infinitely many hits in a finite time, as in Zeno's paradox. Source: I. Newton, Principia,
// 1687, Scholium to the laws; the series above.
struct DroppedBall {
  double height, restitution, g;

  double peak(int bounces) const;  // after so many hits [m]
  double restTime() const;         // [s]
};

// --- Ball that hits a floor with spin
// ----------------------------------------------------------------------------------------------------- A sphere (R, I
// = 2/5 m R^2) with velocity v, angular velocity w; its lowest point slips with u = v_T + w x (-R z). A hit's impulse
// per mass is j_n = (1 + e) |v_z| upwards and j against the slip. Point by point of the hit |dj| <= mu dj_n, and du =
// -(7/2) dj, since force and moment both slow the slip (1 + m R^2/I = 7/2); u keeps its direction, so that
//   j = min(mu j_n, (2/7) |u|):   it slips all through the hit, or it grips, and leaves the floor rolling
//   v_T+ = v_T - j u/|u|,   w+ = w + (5/2)/R j z x u/|u|
// Source: E. J. Routh, Dynamics of a System of Rigid Bodies, Elementary Part, 7th ed., 1905 (rough sphere on a plane).
// A superball that grips stores tangential strain and reverses its slip, u+ = -u- (R. L. Garwin, Am. J.
// Phys. 37 (1969) 88-92); Coulomb's law with a rigid contact can't: slip ends, it doesn't turn round. So
// this is a ball with e = 1 along the normal only.
struct SpinningBall {
  double radius, restitution, mu, g;

  struct Motion {
    Vec3 p, v, w;  // of the centre, above a floor at z = 0
  };
  // `time` after `start`, hit by hit; only a few hits (the sum over hits is taken one by one). Exact.
  Motion after(Motion start, double time) const;

 private:
  void hit(Motion& m) const;
};

// --- Two bodies that meet head on
// ----------------------------------------------------------------------------------------------------------- Momentum
// is kept and v_1+ - v_2+ = -e (v_1 - v_2); a body that never moves has infinite mass.
struct HeadOn {
  double mass1, mass2, restitution;

  // Velocities after: of the first, which comes with `v`, and of the second, which rested [m/s].
  Vec2 velocities(double v) const;
};

}  // namespace pincer::exact
