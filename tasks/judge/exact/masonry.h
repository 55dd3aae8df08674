// masonry: when dry stone stands, by limit analysis. SI units; none shares code with the engine.
#pragma once

namespace pincer::exact {

// --- Semicircular arch
// ---------------------------------------------------------------------------------------------------------------------
// N equal voussoirs between the radii r_i = 1 - t/2 and r_e = 1 + t/2 (per mean radius R), cut by N + 1 joints towards
// the centre; the first and the last lie on the ground. Stone is rigid, doesn't slide (enough friction) and takes no
// tension: the arch stands if and only if some thrust runs inside it (safe theorem). By symmetry the thrust at the
// crown is horizontal, H at the height P/H. At the joint at angle f_k from the crown the thrust is (H, V_k), V_k the
// weight above, and moments about the centre put it at the radius
//   rho_k = (P + M_k)/(V_k sin f_k + H cos f_k),   M_k = sum of x_j W_j above
//   and it must be  r_i <= rho_k <= r_e  for all k
// (at the crown too, if a joint is there). These are half-planes in (H, P); the least t is where they cease to have a
// common point. A voussoir with flat faces (a trapezoid, as convex hulls are): area (r_e^2 - r_i^2)/2 sin b, b = pi/N,
// centroid at the radius (2/3) cos(b/2) (r_e^3 - r_i^3)/(r_e^2 - r_i^2).
// N to infinity: t/R = 0.1075, hinges in the extrados at crown and ground, in the intrados at 54.5 degrees.
// Source: M. Milankovitch, Z. Math. Phys. 55 (1907) 1-27; J. Heyman, The Stone Skeleton, Int. J. Solids
// Struct. 2 (1966) 249-279 (safe theorem).
bool semicircularArchStands(int voussoirs, double thickness);  // thickness over mean radius
double leastThicknessOfArch(int voussoirs);                    // by bisection, to round-off

}  // namespace pincer::exact
