// linkages: exact motions of what hangs together by joints. SI units; none shares code with the engine.
#pragma once
#include <vector>

namespace pincer::exact {

// --- Chain of rods
// ---------------------------------------------------------------------------------------------------------------------
// n uniform rods of length l and mass m hinged end to end, the first to the ground, in the plane, each at
// the angle a_i from hanging straight down:
//   sum_j c_ij (cos(a_i - a_j) a_j'' + sin(a_i - a_j) a_j'^2) + m g l (n - i - 1/2) sin a_i = 0,    i, j = 0 .. n - 1
//   c_ii = m l^2 (n - i - 2/3),   c_ij = m l^2 (n - max(i, j) - 1/2)
// By Runge-Kutta's method at 20 us in long double: its error over 10 s, where the
// rods swing by .2 rad, is below 1e-12 rad.
struct RodChain {
  int rods;
  double length, mass, g;

  // The angles at `time`, from rest at `start` [rad].
  std::vector<double> angles(const std::vector<double>& start, double time) const;
  // Kinetic plus potential energy [J], from hanging straight down: of angles and their rates.
  double energy(const std::vector<double>& angles, const std::vector<double>& rates) const;
};

// --- Elliptic pendulum
// ---------------------------------------------------------------------------------------------------------------------
// A block of mass M slides along x; from it hangs a body of mass m, inertia I about its centre,
// which is at the distance d from the pivot. Nothing acts along x: M x' + m (x' + d a' cos a) =
// P. With s = m/(M + m), from rest, P = 0:
//   (I + m d^2 (1 - s cos^2 a)) a'^2/2 = m g d (cos a - cos a_0)
// Integrated as a'' by Runge-Kutta's method at 20 us, its error over 10 s below
// 1e-12 rad; x = x_0 + s d (sin a_0 - sin a).
struct EllipticPendulum {
  double block, mass, inertia, distance, g;

  double angle(double start, double time) const;  // [rad]
  double way(double start, double angle) const;   // x - x_0 [m]
};

// --- Oscillator with a damper
// ------------------------------------------------------------------------------------------------------------------ m
// x'' + d x' + k x = 0 from x_0 with v_0, by the roots of m s^2 + d s + k; k > 0, d^2 != 4 k m.
struct DampedOscillator {
  double m, k, d;

  double place(double x_0, double v_0, double time) const;
};

// --- Closed linkages of one freedom
// ---------------------------------------------------------------------------------------------------------- Without
// gravity: E = I(a) a'^2/2 stays, I(a) the inertia that the crank feels; a' = sqrt(2 E/I(a)) by Runge-Kutta's method at
// 20 us. The crank's pivot is the origin, a its angle from the x axis. Four bars: K_1 cos b - K_2 cos a + K_3 = cos(a -
// b), the rocker at the angle b (F. Freudenstein, Trans. ASME 77 (1955) 853-861), K_1 = ground/crank, K_2 =
// ground/rocker, K_3 = (crank^2 - coupler^2 + rocker^2 + ground^2)/(2 crank rocker).
struct FourBar {
  double crank, coupler, rocker, ground;  // lengths [m]; the open one of the two ways to put them together
  double crank_inertia, rocker_inertia;   // about their pivots [kg m^2]
  double coupler_mass, coupler_inertia;   // about its middle

  double rockerAngle(double angle) const;
  double miss(double angle, double rocker_angle) const;  // of Freudenstein's equation [-]
  double ratio(double angle) const;                      // db/da
  double inertia(double angle) const;
  double angle(double start, double rate, double time) const;
};

// The slider's way goes along the x axis through the crank's pivot.
struct SliderCrank {
  double crank, rod, crank_inertia, rod_mass, rod_inertia, slider_mass;

  double place(double angle) const;  // of the slider
  double inertia(double angle) const;
  double angle(double start, double rate, double time) const;
};

}  // namespace pincer::exact
