#include "pincer/engine/motion/free_motion.h"

#include "pincer/contact/functions/invariants.h"

namespace pincer::engine {
namespace {

constexpr double kEqual = 1e-13;  // relative difference of moments, some 400 ulp: they come from sums over triangles

// Series to round-off where steps are small, as they are at 1 kHz: a quarter of the time of math::sinCos.
math::SinCos sinCos(double a) {
  const double x = a * a;
  if (!(x < 0.01)) return math::sinCos(a);
  const double xx = x * x;
  return {a * ((1 - x * (1.0 / 6)) + xx * ((1.0 / 120 - x * (1.0 / 5040)) + xx * (1.0 / 362880))),
          (1 - x * 0.5) + xx * ((1.0 / 24 - x * (1.0 / 720)) + xx * (1.0 / 40320))};
}

// The body's attitude and its angular momentum, components along (i, j, k).
struct SpinningBody {
  double w, x, y, z;     // q_WI
  double L_i, L_j, L_k;  // in I

  void turnAboutK(double angle) {
    turn(angle, L_i, L_j);
    const math::SinCos half = sinCos(0.5 * angle);
    const SpinningBody q = *this;
    w = q.w * half.cos - q.z * half.sin;
    x = q.x * half.cos + q.y * half.sin;
    y = q.y * half.cos - q.x * half.sin;
    z = q.z * half.cos + q.w * half.sin;
  }
  void turnAboutJ(double angle) {
    turn(angle, L_k, L_i);
    const math::SinCos half = sinCos(0.5 * angle);
    const SpinningBody q = *this;
    w = q.w * half.cos - q.y * half.sin;
    x = q.x * half.cos - q.z * half.sin;
    y = q.y * half.cos + q.w * half.sin;
    z = q.z * half.cos + q.x * half.sin;
  }

 private:
  // L's components (a, b) in axes that turn from a to b.
  static void turn(double angle, double& a, double& b) {
    const math::SinCos s = sinCos(angle);
    const double a_before = a;
    a = s.cos * a_before + s.sin * b;
    b = s.cos * b - s.sin * a_before;
  }
};

// The coefficients' symmetric half, outer part first; they sum to 1/2 for each part.
constexpr double kXi = 0.1786178958448091, kLambda = -0.2123418310626054, kChi = -0.06626458266981849;
constexpr double kOuter[] = {kXi, kChi, 1 - 2 * (kChi + kXi), kChi, kXi};
constexpr double kInner[] = {0.5 * (1 - 2 * kLambda), kLambda, kLambda, 0.5 * (1 - 2 * kLambda)};

// The parts in L_k and L_j of the step.
void turnAboutOwnAxes(const FreeRotation& rotation, const Vec3& L_I, double h, Quat& q) {
  const int i = rotation.i, j = rotation.j, k = rotation.k;
  const double rate_k = h * (rotation.inverse_moments[k] - rotation.inverse_moments[i]);
  const double rate_j = h * (rotation.inverse_moments[j] - rotation.inverse_moments[i]);
  SpinningBody body{q.w(), q.vec()[i], q.vec()[j], q.vec()[k], L_I[i], L_I[j], L_I[k]};
  if (rotation.kind == FreeRotation::Kind::kSymmetric) {
    body.turnAboutK(rate_k * body.L_k);
  } else {
    for (int n = 0; n < 4; ++n) {
      body.turnAboutK(kOuter[n] * rate_k * body.L_k);
      body.turnAboutJ(kInner[n] * rate_j * body.L_j);
    }
    body.turnAboutK(kOuter[4] * rate_k * body.L_k);
  }
  q.w() = body.w;
  q.vec()[i] = body.x;
  q.vec()[j] = body.y;
  q.vec()[k] = body.z;
}

// exp of a rotation vector; without a square root where the step is small.
Quat quatOfStep(const Vec3& a) {
  const double x = 0.25 * a.squaredNorm();
  if (!(x < 0.01)) return quatFromRotationVector(a);
  const double xx = x * x;
  const double s = 0.5 * ((1 - x * (1.0 / 6)) + xx * ((1.0 / 120 - x * (1.0 / 5040)) + xx * (1.0 / 362880)));
  const double c = (1 - x * 0.5) + xx * ((1.0 / 24 - x * (1.0 / 720)) + xx * (1.0 / 40320));
  return {c, s * a.x(), s * a.y(), s * a.z()};
}

}  // namespace

FreeRotation::FreeRotation(const Vec3& moments)
    : inverse_moments(moments.cwiseInverse()), root_inverse_moments(inverse_moments.cwiseSqrt()) {
  PINCER_ASSERT((moments.array() > 0).all());
  double least = INFINITY;
  for (int axis = 0; axis < 3; ++axis) {
    const double difference = std::abs(inverse_moments[(axis + 1) % 3] - inverse_moments[(axis + 2) % 3]);
    if (difference >= least) continue;
    least = difference;
    k = axis;
  }
  i = (k + 1) % 3;
  j = (k + 2) % 3;
  const double scale = kEqual * inverse_moments[i];
  const bool symmetric = least <= scale;
  const bool spherical = symmetric && std::abs(inverse_moments[k] - inverse_moments[i]) <= scale;
  kind = spherical ? Kind::kSpherical : symmetric ? Kind::kSymmetric : Kind::kTriaxial;
}

void rotateFreely(const FreeRotation& rotation, const Vec3& L_W, double h, Quat& q_WI) {
  PINCER_ASSERT(isUnitIfFinite(q_WI));
  const Quat about_L = quatOfStep(h * rotation.inverse_moments[rotation.i] * L_W);
  if (rotation.kind != FreeRotation::Kind::kSpherical) turnAboutOwnAxes(rotation, q_WI.conjugate() * L_W, h, q_WI);
  q_WI = about_L * q_WI;
  q_WI.coeffs() *= 1.5 - 0.5 * q_WI.squaredNorm();  // a Newton step for 1 / |q|: exact to round-off this close to 1
}

Vec3 angularVelocity(const FreeRotation& rotation, const Quat& q_WI, const Vec3& L_W) {
  if (rotation.kind == FreeRotation::Kind::kSpherical) return rotation.inverse_moments[0] * L_W;
  return q_WI * rotation.inverse_moments.cwiseProduct(q_WI.conjugate() * L_W);
}

Mat3 inverseInertia(const FreeRotation& rotation, const Quat& q_WI) {
  PINCER_ASSERT(isUnitIfFinite(q_WI));
  if (rotation.kind == FreeRotation::Kind::kSpherical) return rotation.inverse_moments[0] * Mat3::Identity();
  const Mat3 R = q_WI.toRotationMatrix();
  return R * rotation.inverse_moments.asDiagonal() * R.transpose();
}

}  // namespace pincer::engine
