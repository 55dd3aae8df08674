#include "pincer/grasp/hold_bounds.h"

#include <Eigen/Eigenvalues>
#include <algorithm>
#include <cmath>
#include <complex>

#include "pincer/contact/functions/invariants.h"
#include "pincer/contact/math.h"

namespace pincer::grasp {
namespace {

// exp(A T) of the arm with the held force as a third, constant state: x, v, f.
Mat3 heldArm(const ArmPort& arm, double tick) {
  PINCER_ASSERT(arm.mass > 0 && tick > 0);
  Mat3 A = Mat3::Zero();
  A(0, 1) = 1;
  A(1, 0) = -arm.hand_stiffness / arm.mass;
  A(1, 1) = -arm.damping / arm.mass;
  A(1, 2) = -1 / arm.mass;
  constexpr int kSquarings = 10, kTerms = 12;  // of the exponential: |A tick| / 2^10 to the 12th is round-off
  const Mat3 small = A * std::ldexp(tick, -kSquarings);
  Mat3 sum = Mat3::Identity(), term = Mat3::Identity();
  for (int i = 1; i <= kTerms; ++i) {
    term = term * small / i;
    sum += term;
  }
  for (int i = 0; i < kSquarings; ++i) sum = (sum * sum).eval();
  return sum;
}

}  // namespace

double requiredDamping(double stiffness, double damping, double tick, double lead) {
  PINCER_ASSERT(-1 <= lead && lead <= 1);
  return 0.5 * stiffness * tick + std::abs(stiffness * lead * tick + damping);
}

double passiveStiffness(const ArmPort& arm, double damping, double tick, double lead) {
  if (requiredDamping(0, damping, tick, lead) >= arm.damping) return 0;
  // |K theta T + B| has two branches; the smaller of the two roots is where the bound is reached first.
  const double up = (arm.damping - damping) / (tick * (0.5 + lead)),
               down = (arm.damping + damping) / (tick * (0.5 - lead));
  const double first = lead > -0.5 ? up : std::numeric_limits<double>::infinity();
  const double second = lead < 0.5 ? down : std::numeric_limits<double>::infinity();
  return std::min(first, second);
}

double loopRadius(const ArmPort& arm, double stiffness, double damping, double tick, double lead) {
  const Mat3 E = heldArm(arm, tick);
  const double now = stiffness * (1 + lead) + damping / tick, before = -stiffness * lead - damping / tick;
  Mat3 loop = Mat3::Zero();  // of x_k, v_k, x_k-1
  for (int row = 0; row < 2; ++row) {
    loop(row, 0) = E(row, 0) + E(row, 2) * now;
    loop(row, 1) = E(row, 1);
    loop(row, 2) = E(row, 2) * before;
  }
  loop(2, 0) = 1;
  double radius = 0;
  const Eigen::EigenSolver<Mat3> solver(loop, false);
  for (const std::complex<double>& z : solver.eigenvalues()) radius = std::max(radius, math::hypot(z.real(), z.imag()));
  return radius;
}

double stableStiffness(const ArmPort& arm, double damping, double tick, double lead) {
  constexpr double kLeast = 1e-3, kMost = 1e9;  // [N/m]
  constexpr double kFine = 1.02;                // first by steps: with damping the stable range may end and begin again
  const auto stable = [&](double k) { return loopRadius(arm, k, damping, tick, lead) < 1; };
  if (!stable(kLeast)) return 0;
  double low = kLeast, high = kLeast;
  while (high < kMost && stable(high)) {
    low = high;
    high *= kFine;
  }
  while (high - low > 1e-3 * low) {
    const double middle = 0.5 * (low + high);
    (stable(middle) ? low : high) = middle;
  }
  return low;
}

}  // namespace pincer::grasp
