// one_freedom: motion along one coordinate, of a body that a pivot or a slider holds, under its weight and a damper.
//
//   th'' = a cos th + b sin th - c th' + d   (pivot),     th'' = a - c th'   (slider),     th(0) = 0,   th'(0) = w
//
//   th  turned or gone since the start [rad, m];  c  damping over inertia [1/s], >= 0
//   a, b  gravity's [1/s^2 or m/s^2, 1/s^2]
//   d  of a torque that stays [1/s^2]
//
// The Taylor series of the solution, coefficient by coefficient (of sin th and cos th alike), up to round-off: no
// truncation error is left, so that it needn't be symplectic. Where its terms don't fall fast it is restarted in equal
// steps; a damper too stiff for that is taken by its exponential, exact for a slider, with a pivot's torque from the
// middle of the tick, 2nd order. Source: E. Hairer, S. P. Norsett, G. Wanner, Solving Ordinary Differential Equations
// I, 2nd ed., 1993, I.8 (recursive Taylor coefficients).
#pragma once

namespace pincer::engine {

struct OneFreedomLaw {
  double a = 0, b = 0, c = 0, d = 0;
  bool turns = false;  // a pivot
};

// Where it is and how fast, `h` later.
struct OneFreedomCourse {
  double way = 0;   // th [rad, m]
  double rate = 0;  // th' [rad/s, m/s]
};

// h >= 0; a rate that isn't finite gives one that isn't.
OneFreedomCourse followFreedom(const OneFreedomLaw& law, double rate, double h);

// Share of an impulse, spread evenly over `h`, that a damper leaves: (1 - exp(-c h)) / (c h), 1 without damper.
double dampedShare(double c, double h);

// How far a constant push leads in `h`, over h and the rate that it leads to: 1/(1 -
// exp(-c h)) - 1/(c h), 1/2 without damper.
double dampedWay(double c, double h);

}  // namespace pincer::engine
