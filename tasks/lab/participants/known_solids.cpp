#include "pincer/tasks/lab/participants/known_solids.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <numbers>

namespace pincer::tasks {
namespace {

constexpr int kRounds = 40;             // of projections: to a fraction of a millimetre, far below what is felt
constexpr std::size_t kMostPlanes = 8;  // of a pyramid, the base among them; the study's tetrahedron has 4
constexpr double kTold = 0.04;          // circumradius and half length [m]

double cross2(const Vec2& a, const Vec2& b) { return a.x() * b.y() - a.y() * b.x(); }

Vec2 edgeNormal(const Vec2& a, const Vec2& b) { return Vec2(b.y() - a.y(), a.x() - b.x()).normalized(); }

bool isWithin(const ConvexPolygon& polygon, const Vec2& p) {
  for (std::size_t k = 0; k < polygon.size(); ++k) {
    const Vec2 &a = polygon[k], &b = polygon[(k + 1) % polygon.size()];
    if (cross2(b - a, p - a) < 0) return false;
  }
  return true;
}

Vec2 nearestOnEdge(const Vec2& a, const Vec2& b, const Vec2& p) {
  const double t = std::clamp((p - a).dot(b - a) / (b - a).squaredNorm(), 0.0, 1.0);
  return a + t * (b - a);
}

Vec2 nearestIn(const ConvexPolygon& polygon, const Vec2& p) {
  if (isWithin(polygon, p)) return p;
  Vec2 nearest = polygon[0];
  for (std::size_t k = 0; k < polygon.size(); ++k) {
    const Vec2 q = nearestOnEdge(polygon[k], polygon[(k + 1) % polygon.size()], p);
    if ((q - p).squaredNorm() < (nearest - p).squaredNorm()) nearest = q;
  }
  return nearest;
}

// The least depth of a point within, and the normal of the edge there.
struct Shallowest {
  double depth = std::numeric_limits<double>::infinity();
  Vec2 n = Vec2::UnitY();
};
Shallowest shallowestOf(const ConvexPolygon& polygon, const Vec2& p) {
  Shallowest least;
  for (std::size_t k = 0; k < polygon.size(); ++k) {
    const Vec2 n = edgeNormal(polygon[k], polygon[(k + 1) % polygon.size()]);
    const double depth = n.dot(polygon[k] - p);
    if (depth < least.depth) least = {depth, n};
  }
  return least;
}

// Away from the axis; up on it.
Vec3 radialOf(const Vec3& p) {
  const double rho = math::hypot(p.y(), p.z());
  return rho > 0 ? Vec3(0, p.y() / rho, p.z() / rho) : Vec3::UnitZ();
}

Vec2 meridianOf(const Vec3& p) { return {p.x(), math::hypot(p.y(), p.z())}; }

Vec3 fromMeridian(const Vec2& m, const Vec3& radial) { return m.x() * Vec3::UnitX() + m.y() * radial; }

// Of a regular polygon, corner k.
Vec2 cornerOf(int sides, double radius, double turn, int k) {
  const double a = turn + 2 * std::numbers::pi * k / sides;
  return radius * Vec2(-math::sin(a), math::cos(a));
}

}  // namespace

KnownSolid KnownSolid::sphere(double radius) {
  KnownSolid solid;
  solid.form_ = Ball{radius};
  return solid;
}

KnownSolid KnownSolid::cylinder(double radius, double half_length) {
  KnownSolid solid;
  solid.form_ =
      Turned{{{-half_length, -radius}, {half_length, -radius}, {half_length, radius}, {-half_length, radius}}};
  return solid;
}

KnownSolid KnownSolid::cone(double radius, double half_length, double side) {
  ConvexPolygon meridian{{half_length, 0}, {-half_length, radius}, {-half_length, -radius}};
  if (side < 0) {
    // half a turn: still counter-clockwise, and symmetric about rho = 0
    for (Vec2& corner : meridian) corner = -corner;
  }
  KnownSolid solid;
  solid.form_ = Turned{meridian};
  return solid;
}

KnownSolid KnownSolid::prism(int sides, double radius, double half_length, double turn) {
  Prism prism{{}, half_length};
  for (int k = 0; k < sides; ++k) prism.section.push_back(cornerOf(sides, radius, turn, k));
  KnownSolid solid;
  solid.form_ = prism;
  return solid;
}

// Sides lean inwards by the radius of their middles over the whole length.
KnownSolid KnownSolid::pyramid(int sides, double radius, double half_length, double turn, double side) {
  Planes planes{{Vec3(-side, 0, 0), half_length}};
  const double inner = radius * math::cos(std::numbers::pi / sides);
  for (int k = 0; k < sides; ++k) {
    const Vec2 out = cornerOf(sides, 1, turn + std::numbers::pi / sides, k);
    const Vec3 n = Vec3(side * inner / (2 * half_length), out.x(), out.y()).normalized();
    planes.push_back({n, n.x() * side * half_length});  // through the tip
  }
  KnownSolid solid;
  solid.form_ = planes;
  return solid;
}

Vec3 KnownSolid::nearestOn(const Ball& ball, const Vec3& p) {
  return p.norm() <= ball.radius ? p : Vec3(ball.radius * p.normalized());
}

Vec3 KnownSolid::nearestOn(const Turned& turned, const Vec3& p) {
  return fromMeridian(nearestIn(turned.meridian, meridianOf(p)), radialOf(p));
}

Vec3 KnownSolid::nearestOn(const Prism& prism, const Vec3& p) {
  const Vec2 across = nearestIn(prism.section, {p.y(), p.z()});
  return {std::clamp(p.x(), -prism.half_length, prism.half_length), across.x(), across.y()};
}

Vec3 KnownSolid::nearestOn(const Planes& planes, const Vec3& p) {
  std::array<double, kMostPlanes> moved{};  // along each normal, by the last projection onto it
  Vec3 x = p;
  for (int round = 0; round < kRounds; ++round) {
    double most = 0;
    for (std::size_t k = 0; k < planes.size(); ++k) {
      const double step = std::max(0.0, planes[k].n.dot(x) + moved[k] - planes[k].d);
      x += (moved[k] - step) * planes[k].n;
      most = std::max(most, std::abs(moved[k] - step));
      moved[k] = step;
    }
    if (most < 1e-6) break;
  }
  return x;
}

Vec3 KnownSolid::normalWithin(const Ball&, const Vec3& p) {
  return p.norm() > 0 ? Vec3(p.normalized()) : Vec3::UnitZ();
}

Vec3 KnownSolid::normalWithin(const Turned& turned, const Vec3& p) {
  return fromMeridian(shallowestOf(turned.meridian, meridianOf(p)).n, radialOf(p));
}

Vec3 KnownSolid::normalWithin(const Prism& prism, const Vec3& p) {
  const Shallowest side = shallowestOf(prism.section, {p.y(), p.z()});
  if (prism.half_length - std::abs(p.x()) < side.depth) return {p.x() < 0 ? -1.0 : 1.0, 0, 0};
  return {0, side.n.x(), side.n.y()};
}

Vec3 KnownSolid::normalWithin(const Planes& planes, const Vec3& p) {
  return std::max_element(planes.begin(), planes.end(),
                          [&](const Plane& a, const Plane& b) { return a.n.dot(p) - a.d < b.n.dot(p) - b.d; })
      ->n;
}

Vec3 KnownSolid::nearest(const Vec3& p) const {
  return std::visit([&](const auto& form) { return nearestOn(form, p); }, form_);
}

Vec3 KnownSolid::outward(const Vec3& p) const {
  const Vec3 away = p - nearest(p);
  if (away.squaredNorm() > 1e-10) return away.normalized();
  return std::visit([&](const auto& form) { return normalWithin(form, p); }, form_);
}

// The first way of each is the one that is shown, pointed ones pointing right (experiments/solids.h).
std::vector<LyingSolid> lyingSolids() {
  const double half_cube = kTold / std::numbers::sqrt2, pi = std::numbers::pi;
  std::vector<LyingSolid> all;
  const auto add = [&](int name, const std::vector<KnownSolid>& ways) {
    for (const KnownSolid& solid : ways)
      all.push_back({name, static_cast<int>(&solid - ways.data()), static_cast<int>(ways.size()), solid});
  };
  const auto pyramid = [&](double turn, double side) { return KnownSolid::pyramid(3, kTold, kTold, turn, side); };
  const auto prism = [&](int sides, double half, double turn) { return KnownSolid::prism(sides, kTold, half, turn); };
  add(0, {KnownSolid::cone(kTold, kTold, 1), KnownSolid::cone(kTold, kTold, -1)});
  add(1, {KnownSolid::cylinder(kTold, kTold)});
  add(2, {prism(4, half_cube, pi / 4), prism(4, half_cube, 0)});
  add(3, {KnownSolid::sphere(kTold)});
  add(4, {pyramid(0, 1), pyramid(0, -1), pyramid(pi, 1), pyramid(pi, -1)});
  add(5, {prism(8, kTold, pi / 8), prism(8, kTold, 0)});
  add(6, {prism(3, kTold, 0), prism(3, kTold, pi)});
  return all;
}

}  // namespace pincer::tasks
