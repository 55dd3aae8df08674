#include "pincer/devices/falcon/falcon_kinematics.h"

#include <Eigen/LU>
#include <cmath>
#include <numbers>

namespace pincer::devices::falcon {
namespace {

constexpr double kPi = std::numbers::pi;  // half a turn [rad]
// of the legs, about the base's axis [rad]
constexpr std::array<double, 3> kLegAngles{kPi / 2 + kPi / 12, -kPi / 6 + kPi / 12, -5 * kPi / 6 + kPi / 12};
constexpr double kOffset = 35 * kPi / 180;                             // [rad]
constexpr double kCountAngle = 2 * kPi / (4 * 320) * 0.01425 / 0.110;  // [rad]

// `p` in the frame of leg `i`.
Vec3 inLeg(const Vec3& p, int i, const Geometry& g) {
  const auto [sn, cs] = math::sinCos(kLegAngles[static_cast<std::size_t>(i)]);
  return {cs * p.x() + sn * p.y() - g.r, -sn * p.x() + cs * p.y() - g.s, p.z()};
}

// The shin seen along v: its length in the leg's plane, absent where the
// parallelogram would have to be longer than it is.
std::optional<double> shin(const Vec3& P, const Geometry& g) {
  const double across = P.y() + g.f;
  const double rest = g.b * g.b - across * across;
  if (!(rest > 0)) return std::nullopt;
  return std::sqrt(rest);
}

// F of leg `i` and its derivatives by place and angle.
struct LegEquation {
  double F = 0, by_angle = 0;
  Vec3 by_place = Vec3::Zero();
};

std::optional<LegEquation> legEquation(const Vec3& p, double t, int i, const Geometry& g) {
  const Vec3 P = inLeg(p, i, g);
  const auto m = shin(P, g);
  if (!m) return std::nullopt;
  const double L = g.d + g.e + *m;
  const auto knee = math::sinCos(t);
  const double u = P.x() + g.c - g.a * knee.cos, w = P.z() - g.a * knee.sin;
  const Vec3 by_leg(2 * u, 2 * L * (P.y() + g.f) / *m, 2 * w);  // dL/dP_v = -(P_v + f) / m
  const auto [sn, cs] = math::sinCos(kLegAngles[static_cast<std::size_t>(i)]);
  LegEquation e;
  e.F = u * u + w * w - L * L;
  e.by_angle = 2 * g.a * (u * knee.sin - w * knee.cos);
  e.by_place = Vec3(cs * by_leg.x() - sn * by_leg.y(), sn * by_leg.x() + cs * by_leg.y(), by_leg.z());
  return e;
}

}  // namespace

std::optional<Vec3> inverse(const Vec3& p, const Geometry& g) {
  Vec3 angles;
  for (int i = 0; i < 3; ++i) {
    const Vec3 P = inLeg(p, i, g);
    const auto m = shin(P, g);
    if (!m) return std::nullopt;
    const double L = g.d + g.e + *m;
    const double u = P.x() + g.c, rho = math::hypot(u, P.z());
    const double cosine = (rho * rho + g.a * g.a - L * L) / (2 * g.a * rho);
    if (!(std::abs(cosine) <= 1)) return std::nullopt;
    angles[i] = math::atan2(P.z(), u) - math::acos(cosine);
  }
  return angles;
}

std::optional<Vec3> forward(const Vec3& angles, const Vec3& guess, const Geometry& g) {
  Vec3 p = guess;
  for (int step = 0; step < 20; ++step) {
    Mat3 slope;
    Vec3 F;
    for (int i = 0; i < 3; ++i) {
      const auto e = legEquation(p, angles[i], i, g);
      if (!e) return std::nullopt;
      F[i] = e->F;
      slope.row(i) = e->by_place.transpose();
    }
    if (!(std::abs(slope.determinant()) > 1e-9)) return std::nullopt;
    const Vec3 change = slope.inverse() * F;
    // far from the root a whole step may leave the reach
    p -= change.norm() > 0.02 ? Vec3(change * (0.02 / change.norm())) : change;
    if (change.norm() < 1e-9) return p;
  }
  return std::nullopt;
}

std::optional<Mat3> jacobian(const Vec3& p, const Vec3& angles, const Geometry& g) {
  Mat3 inverse_J;
  for (int i = 0; i < 3; ++i) {
    const auto e = legEquation(p, angles[i], i, g);
    if (!e || !(std::abs(e->by_angle) > 1e-9)) return std::nullopt;
    inverse_J.row(i) = -e->by_place.transpose() / e->by_angle;
  }
  if (!(std::abs(inverse_J.determinant()) > 1e-3)) return std::nullopt;  // 1/m^3; in the workspace it is thousands
  return inverse_J.inverse();
}

double angleOf(int count) { return kOffset + kCountAngle * count; }

int countOf(double angle) { return static_cast<int>(std::lround((angle - kOffset) / kCountAngle)); }

}  // namespace pincer::devices::falcon
