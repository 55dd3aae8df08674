#include "pincer/tasks/lab/participants/known_solids.h"

#include <algorithm>
#include <cmath>
#include <numbers>

namespace pincer::tasks {
namespace {

constexpr int kRounds = 40;      // of projections: to a fraction of a millimetre, far below what is felt
constexpr int kMostPlanes = 26;  // 24 sides and two ends
constexpr double kTold = 0.04;   // circumradius and half length [m]
constexpr int kRoundSides = 24;

}  // namespace

// Sides whose corners lie at `radius`, the first on +x; `taper`: sideways per unit of height, 0 for a prism.
std::vector<KnownSolid::Plane> KnownSolid::around(int sides, double radius, double half_length, double taper) {
  std::vector<Plane> planes;
  const double inner = radius * math::cos(std::numbers::pi / sides);
  for (int k = 0; k < sides; ++k) {
    const double a = 2 * std::numbers::pi * (k + 0.5) / sides;
    const Vec3 n = Vec3(math::cos(a), math::sin(a), taper).normalized();
    planes.push_back({n, n.dot(Vec3(inner * math::cos(a), inner * math::sin(a), -half_length))});
  }
  planes.push_back({-Vec3::UnitZ(), half_length});
  return planes;
}

KnownSolid KnownSolid::prism(int sides, double radius, double half_length) {
  KnownSolid solid;
  solid.planes_ = around(sides, radius, half_length, 0);
  solid.planes_.push_back({Vec3::UnitZ(), half_length});
  return solid;
}

KnownSolid KnownSolid::pyramid(int sides, double radius, double half_length) {
  KnownSolid solid;
  solid.planes_ = around(sides, radius, half_length, radius * math::cos(std::numbers::pi / sides) / (2 * half_length));
  return solid;
}

KnownSolid KnownSolid::sphere(double radius) {
  KnownSolid solid;
  solid.radius_ = radius;
  return solid;
}

Vec3 KnownSolid::nearest(const Vec3& p) const {
  if (planes_.empty()) return p.norm() <= radius_ ? p : Vec3(radius_ * p.normalized());
  std::array<double, kMostPlanes> moved{};  // along each normal, by the last projection onto it
  Vec3 x = p;
  for (int round = 0; round < kRounds; ++round) {
    double most = 0;
    for (std::size_t k = 0; k < planes_.size(); ++k) {
      const Plane& plane = planes_[k];
      const double beyond = plane.n.dot(x) + moved[k] - plane.d;
      const double step = std::max(0.0, beyond);
      x += (moved[k] - step) * plane.n;
      most = std::max(most, std::abs(moved[k] - step));
      moved[k] = step;
    }
    if (most < 1e-6) break;
  }
  return x;
}

Vec3 KnownSolid::outward(const Vec3& p) const {
  const Vec3 away = p - nearest(p);
  if (away.squaredNorm() > 1e-10) return away.normalized();
  if (planes_.empty()) return p.normalized();
  const auto face =
      std::max_element(planes_.begin(), planes_.end(), [&](const Plane& a, const Plane& b) { return a.n.dot(p) - a.d < b.n.dot(p) - b.d; });
  return face->n;
}

std::array<KnownSolid, kSolids> knownSolids() {
  const double half_cube = kTold / std::numbers::sqrt2;
  return {KnownSolid::pyramid(kRoundSides, kTold, kTold),
          KnownSolid::prism(kRoundSides, kTold, kTold),
          KnownSolid::prism(4, kTold, half_cube),
          KnownSolid::sphere(kTold),
          KnownSolid::pyramid(3, kTold, kTold),
          KnownSolid::prism(8, kTold, kTold),
          KnownSolid::prism(3, kTold, kTold)};
}

}  // namespace pincer::tasks
