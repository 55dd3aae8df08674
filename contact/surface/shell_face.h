// shell_face: one step of the shell equation within a face (equations in shell_solver.h).
#pragma once
#include <algorithm>
#include <array>
#include <cmath>

#include "contact/surface/patch.h"

namespace pincer::contact {

enum class StepKind { newton, alongResidual };

struct FaceStep {
  Vec3 n;                    // unit normal
  double h;                  // height of the centre along n [m]
  double residual;           // |T| [m]
  std::array<double, 3> db;  // change of the barycentric coordinates 0, 1, 2; their sum is 0
};

// The step along T in the patch's own metric, with a gain that can't overshoot.
inline Vec2 stepAlongResidual(const PatchPoint& x, const Vec3& T, const Vec3& n, double N_length, double h) {
  const double a = x.Su.squaredNorm(), b = x.Su.dot(x.Sv), c = x.Sv.squaredNorm();
  const double det = std::max(a * c - b * b, 1e-12 * a * c);  // a folded patch may have Su parallel to Sv
  const double tu = T.dot(x.Su), tv = T.dot(x.Sv);
  const Vec2 d((c * tu - b * tv) / det, (a * tv - b * tu) / det);
  const Vec3 dS = x.Su * d.x() + x.Sv * d.y();
  const Vec3 dN = x.Nu * d.x() + x.Nv * d.y();
  const double moved = dS.norm();
  const double kappa = moved > 0 ? (dN - n * n.dot(dN)).norm() / (N_length * moved) : 0;
  return d / (1 + kappa * std::abs(h));
}

inline FaceStep faceStep(const PatchPoint& x, const Vec3& C, StepKind kind) {
  constexpr double kLeastDeterminant = 0.1, kLeastCosine = 0.2;
  const Vec3 R = C - x.S;
  const double NN = x.N.squaredNorm(), N_length = std::sqrt(NN);
  const double hN = R.dot(x.N) / NN;  // height in units of N
  const Vec3 T = R - hN * x.N;
  FaceStep step{x.N / N_length, hN * N_length, T.norm(), {}};
  Vec2 d;
  bool usable = kind == StepKind::newton;
  if (usable) {
    const Vec3 A = x.Su + hN * x.Nu, B = x.Sv + hN * x.Nv;
    const Vec3 X = B.cross(x.N);
    const double det = A.dot(X), flat = x.Su.dot(x.Sv.cross(x.N));
    d = Vec2(T.dot(X) / det, T.dot(x.N.cross(A)) / det);
    const Vec3 dS = x.Su * d.x() + x.Sv * d.y();
    const double along = T.dot(dS);
    usable = flat > 0 && det > kLeastDeterminant * flat && along > 0 &&
             along * along >= kLeastCosine * kLeastCosine * T.squaredNorm() * dS.squaredNorm();
  }
  if (!usable) d = stepAlongResidual(x, T, step.n, N_length, step.h);
  step.db = {-d.x() - d.y(), d.x(), d.y()};
  return step;
}

}  // namespace pincer::contact
