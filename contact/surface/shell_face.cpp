#include "pincer/contact/surface/shell_face.h"

#include <algorithm>
#include <cmath>

namespace pincer::contact {

namespace {

constexpr double kLeastEigenvalue = 0.2;  // of J, so that no step is longer than 5 |T|

struct Residual {
  Vec3 T, n;
  double hN;  // h in units of |N|
  double h;
  double N_length;
};

Residual residualOf(const PatchPoint& x, const Vec3& C) {
  const Vec3 R = C - x.S;
  const double NN = x.N.squaredNorm(), N_length = std::sqrt(NN);
  const double hN = R.dot(x.N) / NN;
  return {R - hN * x.N, x.N / N_length, hN, hN * N_length, N_length};
}

// A square 2x2 system in the plane across n: columns are the images of du and dv.
struct PlaneMap {
  double a, b, c, d;  // [a b; c d]
  double det() const { return a * d - b * c; }
  Vec2 solve(const Vec2& y) const { return Vec2(d * y.x() - b * y.y(), a * y.y() - c * y.x()) / det(); }
};

Vec2 stepAlongResidual(const PatchPoint& x, const Residual& r) {
  const double a = x.Su.squaredNorm(), b = x.Su.dot(x.Sv), c = x.Sv.squaredNorm();
  const double det = std::max(a * c - b * b, 1e-12 * a * c);  // a folded patch may have Su parallel to Sv
  const double tu = r.T.dot(x.Su), tv = r.T.dot(x.Sv);
  const Vec2 d((c * tu - b * tv) / det, (a * tv - b * tu) / det);
  const Vec3 dS = x.Su * d.x() + x.Sv * d.y();
  const Vec3 dN = x.Nu * d.x() + x.Nv * d.y();
  const double moved = dS.norm();
  const double kappa = moved > 0 ? (dN - r.n * r.n.dot(dN)).norm() / (r.N_length * moved) : 0;
  return d / (1 + kappa * std::abs(r.h));
}

// T divided by the sizes of the eigenvalues of the symmetric matrix [p q; q s].
Vec2 divideByEigenvalueSizes(double p, double q, double s, const Vec2& T) {
  const double mean = 0.5 * (p + s), half_gap = math::hypot(0.5 * (p - s), q);
  const auto inverse = [](double lambda) { return 1 / std::max(std::abs(lambda), kLeastEigenvalue); };
  const double f1 = inverse(mean + half_gap), f2 = inverse(mean - half_gap);
  if (half_gap < 1e-12) return f1 * T;
  // Sylvester: f(M) = f2 + (f1 - f2) (M - lambda2) / (lambda1 - lambda2)
  const double k = (f1 - f2) / (2 * half_gap), lambda2 = mean - half_gap;
  return {f2 * T.x() + k * ((p - lambda2) * T.x() + q * T.y()), f2 * T.y() + k * (q * T.x() + (s - lambda2) * T.y())};
}

// J in the plane across n.
struct ShellJacobian {
  Vec3 e1, e2;     // unit axes of the plane
  PlaneMap moves;  // dS
  bool is_folded;
  double p, q, s;  // symmetric part [p q; q s]
};

ShellJacobian shellJacobian(const PatchPoint& x, const Residual& r) {
  ShellJacobian J;
  J.e1 = (x.Su - r.n * r.n.dot(x.Su)).normalized();
  J.e2 = r.n.cross(J.e1);
  J.moves = {x.Su.dot(J.e1), x.Sv.dot(J.e1), x.Su.dot(J.e2), x.Sv.dot(J.e2)};
  J.is_folded = !(J.moves.det() > 0.01 * J.moves.a * J.moves.d);
  const Vec3 A = x.Su + r.hN * x.Nu, B = x.Sv + r.hN * x.Nv;
  // image * moves^-1, row by row
  const double image[2][2] = {{A.dot(J.e1), B.dot(J.e1)}, {A.dot(J.e2), B.dot(J.e2)}};
  double full[2][2];
  for (int i = 0; i < 2; ++i) {
    full[i][0] = (image[i][0] * J.moves.d - image[i][1] * J.moves.c) / J.moves.det();
    full[i][1] = (image[i][1] * J.moves.a - image[i][0] * J.moves.b) / J.moves.det();
  }
  J.p = full[0][0];
  J.q = 0.5 * (full[0][1] + full[1][0]);
  J.s = full[1][1];
  return J;
}

Vec2 saddleFreeStep(const PatchPoint& x, const Residual& r) {
  const ShellJacobian J = shellJacobian(x, r);
  if (J.is_folded) return stepAlongResidual(x, r);
  return J.moves.solve(divideByEigenvalueSizes(J.p, J.q, J.s, {r.T.dot(J.e1), r.T.dot(J.e2)}));
}

}  // namespace

bool isStable(const PatchPoint& x, const Vec3& C) {
  const ShellJacobian J = shellJacobian(x, residualOf(x, C));
  return !J.is_folded && J.p > 0 && J.p * J.s > J.q * J.q;
}

[[gnu::flatten]] FaceStep faceStep(const PatchPoint& x, const Vec3& C, StepKind kind) {
  const Residual r = residualOf(x, C);
  if (kind == StepKind::newton) {
    const NewtonStep step = newtonStep(x, r.T, r.hN);
    const Vec2 d = step.is_usable ? Vec2(step.u, step.v) : saddleFreeStep(x, r);
    return {r.n, r.h, r.T.norm(), {-d.x() - d.y(), d.x(), d.y()}, step.is_usable, step.du, step.dv};
  }
  const Vec2 d = stepAlongResidual(x, r);
  return {r.n, r.h, r.T.norm(), {-d.x() - d.y(), d.x(), d.y()}, false, {}, {}};
}

}  // namespace pincer::contact
