// hold_bounds: which stiffness an arm can carry when its force is held from sample to sample.
//
//   f_k = K (x_k + theta (x_k - x_k-1)) + B (x_k - x_k-1) / T,   held for T
//   passive  <=>  b > K T / 2 + |K theta T + B|
//   stable   <=>  every eigenvalue of the sampled loop  m x'' = -b x' - k_h x - f  lies within the unit circle
//
//   K, B   stiffness and damping of the coupling, as felt against something rigid
//          [N/m, N s/m];  T  time between two forces [s]
//   theta  lead of the pose in ticks [-]: 0 zero-order hold, > 0 extrapolated ahead
//          (first-order hold), < 0 late by so much; -1 .. 1
//   m, b   the arm's mass and viscous friction at its tip [kg, N s/m]
//   k_h    stiffness of the hand [N/m], its damping counts with b
// Passive is more than stable: it holds whatever the hand and the object do. theta = 0 is the published bound;
// with theta it follows from the paper's condition, b > T / (2 (1 - cos wT)) Re[(1 - exp(-jwT)) H(exp(jwT))]
// for 0 <= w <= pi/T, with H = K (1 + theta (1 - 1/z)) + B (1 - 1/z) / T: Re[...] / (1 - cos wT) = K - 2
// cos(wT) (K theta + B/T), largest at one of the ends. Source: J. E. Colgate, G. G. Schenkel, J. Robotic
// Systems 14 (1997) 37-47, eq. (5) and (19).
#pragma once
#include <limits>

namespace pincer::grasp {

// An arm as its finger's coupling feels it.
struct ArmPort {
  double mass = 0.05;         // m [kg], > 0
  double damping = 0;         // b [N s/m], >= 0
  double hand_stiffness = 0;  // k_h [N/m], >= 0
};

// b that K and B need to be passive [N s/m].
double requiredDamping(double stiffness, double damping, double tick, double lead = 0);

// The largest K that is passive on this arm [N/m]; 0 if B alone isn't.
double passiveStiffness(const ArmPort& arm, double damping, double tick, double lead = 0);

// The largest K up to which the sampled loop is stable [N/m], to a thousandth; 0 if none is. Off the tick.
double stableStiffness(const ArmPort& arm, double damping, double tick, double lead = 0);

// The largest magnitude of the sampled loop's eigenvalues [-].
double loopRadius(const ArmPort& arm, double stiffness, double damping, double tick, double lead = 0);

}  // namespace pincer::grasp
