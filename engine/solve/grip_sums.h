// grip_sums: N of a grip's body without its points (grip_problem.h), summed over the contacts that hold.
#pragma once
#include "pincer/engine/solve/triple.h"

namespace pincer::engine {

// Contacts' arms: their number, sum, and sum of squares.
struct GripArms {
  double n;
  Triple sum;
  Symmetric3 squares;
};

// N_ll, the rows of N_la, and N_aa in W; without the ridge, the body's mass and F.
struct GripSums {
  Triple ll, la[3];
  Symmetric3 aa;

  // Contacts with what doesn't move.
  void addStanding(const GripArms& arms) {
    addLinear(arms, {{1, 1, 1}});
    aa.add(arms.squares.turning(), 1);
  }
  // A point's; P^-1 is written.
  void addPoint(const GripArms& arms, const Triple& E, double ridge, Triple& inverse_P) {
    inverse_P = {};
    if (!(arms.n > 0)) return;
    Triple rho;
    times<3>([&](auto k) {
      inverse_P[k] = 1 / (arms.n * E[k] * E[k] + ridge);
      rho[k] = ridge * inverse_P[k];
    });
    Symmetric3 apart = arms.squares;  // from their mean
    apart.add(squareOf(arms.sum), -1 / arms.n);
    aa.add(apart.turning(), 1);
    addLinear(arms, rho);
    addAngular(arms.sum, {{rho[0] / arms.n, rho[1] / arms.n, rho[2] / arms.n}});
  }

 private:
  void addLinear(const GripArms& arms, const Triple& rho) {
    const Triple& a = arms.sum;
    times<3>([&](auto k) {
      constexpr int j = (k + 1) % 3, l = (k + 2) % 3;
      ll[k] += arms.n * rho[k];
      la[k][j] += rho[k] * a[l];
      la[k][l] -= rho[k] * a[j];
    });
  }
  // [a]x^T diag(c) [a]x
  void addAngular(const Triple& a, const Triple& c) {
    aa.add({{c[1] * a[2] * a[2] + c[2] * a[1] * a[1], c[0] * a[2] * a[2] + c[2] * a[0] * a[0],
             c[0] * a[1] * a[1] + c[1] * a[0] * a[0], -c[2] * a[0] * a[1], -c[1] * a[0] * a[2], -c[0] * a[1] * a[2]}},
           1);
  }
};

}  // namespace pincer::engine
