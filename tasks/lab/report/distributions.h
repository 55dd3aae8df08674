// distributions: how probable a test's figure is where nothing differs.
//
//   I_x(a, b)   incomplete beta function, by its continued fraction (M. Abramowitz, I. A. Stegun,
//               Handbook of Mathematical Functions, 1964,
//               26.5.8, summed after Lentz); ln Gamma by C. Lanczos, SIAM J. Numer. Anal. B 1, 1964, g = 7
//   F           P(F > f) = I_x(n/2, m/2),  x = n / (n + m f)  (26.6.2)
//   t           P(|T| > t) = I_x(n/2, 1/2),  x = n / (n + t^2), for any n > 0  (26.7.1)
//   Q           studentized range of k means: P(Q < q) = int f_n(s) W(q s) ds,
//               W(w) = k int phi(z) (Phi(z) - Phi(z - w))^(k-1) dz, s the standard deviation's ratio with n degrees of
//               freedom (J. W. Tukey; M. D. Copenhaver, B. Holland, J. Stat. Comput. Simul. 30, 1988); both by
//               Simpson's rule, to 1e-6
#pragma once

namespace pincer::tasks {

// I_x(a, b) for 0 <= x <= 1, a, b > 0.
double incompleteBeta(double x, double a, double b);

// P(F > f), f >= 0, of m and n > 0 degrees of freedom.
double fTail(double f, double m, double n);

// P(|T| > t), t >= 0, n > 0 degrees of freedom, which needn't be whole.
double studentTail(double t, double n);

// P(Q > q), q >= 0, of k >= 2 means with n >= 1 degrees of freedom.
double studentizedRangeTail(double q, int k, double n);

}  // namespace pincer::tasks
