#include <fmt/format.h>

#include "pincer/contact/error.h"
#include "pincer/contact/functions/invariants.h"
#include "pincer/engine/motion/mass.h"

namespace pincer::engine {
namespace {

constexpr double kDiagonal = 1e-13;  // of the trace: off-diagonal elements below are round-off of sums over triangles
constexpr double kTriangleInequality = 1e-9;  // relative slack: a thin plate fulfils it with equality
constexpr int kSweeps = 12;                   // Jacobi's method converges quadratically; 5 is usual

bool isDiagonal(const Mat3& A, double tolerance) {
  const double limit = tolerance * A.trace();
  return std::abs(A(0, 1)) <= limit && std::abs(A(0, 2)) <= limit && std::abs(A(1, 2)) <= limit;
}

// Rotates A and R in the plane (p, q) so that A(p, q) vanishes. Source: Golub, Van Loan,
// Matrix Computations, 4th ed., section 8.5.2.
void annihilate(Mat3& A, Mat3& R, int p, int q) {
  if (A(p, q) == 0) return;
  const double theta = (A(q, q) - A(p, p)) / (2 * A(p, q));
  const double t = std::copysign(1 / (std::abs(theta) + std::sqrt(1 + theta * theta)), theta);
  const double c = 1 / std::sqrt(1 + t * t);
  const double s = t * c;
  Mat3 G = Mat3::Identity();
  G(p, p) = G(q, q) = c;
  G(p, q) = s;
  G(q, p) = -s;
  A = (G.transpose() * A * G).eval();
  A(p, q) = A(q, p) = 0;
  R = (R * G).eval();
}

void check(const Vec3& moments) {
  const double sum = moments.sum();
  for (int axis = 0; axis < 3; ++axis) {
    if (!(moments[axis] > 0) || !std::isfinite(sum))
      throw InputError(fmt::format(
          "principal moment of inertia {} = {:g} kg m^2 is out of range (0, inf). A solid's moments are positive.",
          axis + 1, moments[axis]));
    if (moments[axis] > (sum - moments[axis]) * (1 + kTriangleInequality))
      throw InputError(
          fmt::format("principal moments of inertia ({:g}, {:g}, {:g}) kg m^2: no solid has one that exceeds the sum "
                      "of the others. "
                      "Check the inertia's unit and axes.",
                      moments[0], moments[1], moments[2]));
  }
}

}  // namespace

PrincipalInertia principalInertia(const MassProperties& properties) {
  Mat3 A = properties.I_BBcm;
  Mat3 R = Mat3::Identity();
  for (int sweep = 0; sweep < kSweeps && !isDiagonal(A, sweep == 0 ? kDiagonal : 0); ++sweep) {
    annihilate(A, R, 0, 1);
    annihilate(A, R, 0, 2);
    annihilate(A, R, 1, 2);
  }
  const Vec3 moments = A.diagonal();
  check(moments);
  PINCER_ASSERT(isSymmetric(properties.I_BBcm));  // only what is above the diagonal was read
  PINCER_ASSERT(isRotation(R));
  return {{Quat(R).normalized(), properties.p_BBcm}, moments};
}

}  // namespace pincer::engine
