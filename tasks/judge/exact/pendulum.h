// pendulum: bodies that turn about a fixed axis under their weight. SI units; none shares code with the engine.
#pragma once

namespace pincer::exact {

// --- Physical pendulum
// ---------------------------------------------------------------------------------------------------------------------
// I th'' = -m g d sin th, th from hanging straight down, I about the axis, d from the axis to the centre of mass.
// Integrated with Runge-Kutta's method at 20 us: its error over some swings of 1 s is below 1e-14 rad.
struct Pendulum {
  double inertia;  // I [kg m^2]
  double moment;   // m d [kg m]
  double g;        // [m/s^2]

  double angle(double start, double time) const;  // at `time`, from rest at `start` [rad]
};

// --- Block that tips on a slope
// ------------------------------------------------------------------------------------------------------------- A block
// of half width b and half height h on a slope of angle th, steep enough to tip it over its lower edge (tan th > b/h)
// and too rough to slide on: the same pendulum upside down, th measured from standing above the edge, starts at th -
// atan(b/h) with I = 4/3 m R^2, d = R. Returns by how far it has turned from rest after `time`.
double tippedAngle(double half_width, double half_height, double slope, double g, double time);

}  // namespace pincer::exact
