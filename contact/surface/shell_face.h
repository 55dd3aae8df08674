// shell_face: one step of the shell equation within a face (equations in shell_solver.h).
//
//   J dS = T,   J = 1 + h W  in the plane across N,  W  how N turns as S moves (curvature, positive where convex) [1/m]
//
// Newton's step is J^-1 T. Where J isn't clearly positive (a finger about as large as the hollow that it is in),
// Newton would go to a farthest or saddle point; then each eigenvalue of J's symmetric part counts by its size: sum
// q_i (q_i . T) / max(|lambda_i|, 0.2), which leaves such points. Source: Y. Dauphin et al., "Identifying and
// attacking the saddle point problem", NIPS 2014.
#pragma once
#include <array>

#include "pincer/contact/surface/patch.h"

namespace pincer::contact {

enum class StepKind {
  newton,         // with the safeguard above
  alongResidual,  // dS along T, shortened by 1 / (1 + |kappa h|): slower, but never to the other side of T
};

struct FaceStep {
  Vec3 n;                    // unit normal
  double h;                  // height of the centre along n [m]
  double residual;           // |T| [m]
  std::array<double, 3> db;  // change of the barycentric coordinates 0, 1, 2; their sum is 0
  bool is_newton;            // the residual should fall: neither safeguarded nor along the residual
  Vec3 du, dv;               // of Newton's step: coordinates 1 and 2 change by du.T, dv.T [1/m]; else unset
};

// Newton's step without the safeguard.
struct NewtonStep {
  Vec3 du, dv;       // as above
  double u, v;       // change of the barycentric coordinates 1 and 2
  double residual2;  // |T|^2 [m^2]
  bool is_usable;    // J is clearly positive, and the step leads along T
};

constexpr double kLeastDeterminant = 0.1;  // of J
constexpr double kLeastCosine = 0.2;       // between Newton's step and T

// For the residual T = C - S - hN N.
[[gnu::flatten]] inline NewtonStep newtonStep(const PatchPoint& x, const Vec3& T, double hN) {
  const Vec3 A = x.Su + hN * x.Nu, B = x.Sv + hN * x.Nv;
  const Vec3 X = B.cross(x.N), Y = x.N.cross(A);
  const double det = A.dot(X), flat = x.Su.dot(x.Sv.cross(x.N)), inverse = 1 / det;
  NewtonStep step{X * inverse, Y * inverse, 0, 0, T.squaredNorm(), false};
  step.u = T.dot(step.du);
  step.v = T.dot(step.dv);
  const Vec3 dS = x.Su * step.u + x.Sv * step.v;
  const double along = T.dot(dS);
  step.is_usable = flat > 0 && det > kLeastDeterminant * flat && along > 0 &&
                   along * along >= kLeastCosine * kLeastCosine * step.residual2 * dS.squaredNorm();
  return step;
}

[[gnu::flatten]] inline NewtonStep newtonStep(const PatchPoint& x, const Vec3& C) {
  const Vec3 R = C - x.S;
  const double hN = R.dot(x.N) / x.N.squaredNorm();
  return newtonStep(x, R - hN * x.N, hN);
}

FaceStep faceStep(const PatchPoint& x, const Vec3& C, StepKind kind);

// True if J is positive: a solution here is a place that the finger stays at, none
// that it slides away from to either side.
bool isStable(const PatchPoint& x, const Vec3& C);

}  // namespace pincer::contact
