#include "pincer/devices/cld/two_dof_kinematics.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <numbers>
#include <stdexcept>
#include <utility>

namespace pincer::devices {
namespace {

std::string outOfRange(const char* field, double value, const char* range) {
  return std::string(field) + " = " + std::to_string(value) + " is out of range " + range + ".";
}

ProfilePoint between(const ProfilePoint& a, const ProfilePoint& b, double share) {
  return {a.place + share * (b.place - a.place), a.plate + share * (b.plate - a.plate),
          a.tilt + share * (b.tilt - a.tilt)};
}

// Where the profile has `measure` = `value`; beyond its ends, on its last pieces prolonged.
template <typename Measure>
ProfilePoint pointWhere(const std::vector<ProfilePoint>& points, double value, Measure measure) {
  const auto inner = std::lower_bound(points.begin() + 1, points.end() - 1, value,
                                      [&](const ProfilePoint& p, double v) { return measure(p) < v; });
  const ProfilePoint &a = *(inner - 1), &b = *inner;
  return between(a, b, (value - measure(a)) / (measure(b) - measure(a)));
}

PadWay blend(const PadWay& a, const PadWay& b, double share) {
  return {a.along + share * (b.along - a.along), a.round + share * (b.round - a.round)};
}

std::optional<std::string> problemWithPoints(const std::vector<ProfilePoint>& points) {
  if (points.size() < 2) return "the finger profile has fewer than two points.";
  for (std::size_t i = 1; i < points.size(); ++i) {
    const ProfilePoint &a = points[i - 1], &b = points[i];
    const bool grows =
        b.place > a.place && b.plate >= a.plate && b.tilt >= a.tilt && b.plate + b.tilt > a.plate + a.tilt;
    if (!grows)
      return "point " + std::to_string(i) +
             " of the finger profile doesn't go on: place must grow, plate and tilt never shrink.";
  }
  return std::nullopt;
}

}  // namespace

FingerProfile FingerProfile::capsule(double radius) {
  return {radius, {{-0.03, -0.03, 0}, {0, 0, 0}, {radius * std::numbers::pi / 2, 0, std::numbers::pi / 2}}};
}

std::optional<std::string> problemWith(const TwoDofGeometry& g, const FingerProfile& profile) {
  const auto within = [](double value, double low, double high) { return value > low && value < high; };
  if (!within(g.ring_radius, 0, 0.1)) return outOfRange("ring_radius", g.ring_radius, "(0, 0.1) m");
  if (!within(profile.radius, 0, g.ring_radius))
    return outOfRange("radius of the finger", profile.radius, "(0, ring_radius) m");
  if (!within(g.place_min, -0.1, 0)) return outOfRange("place_min", g.place_min, "(-0.1, 0) m");
  if (!within(g.place_max, 0, profile.radius * std::numbers::pi / 2)) {
    return outOfRange("place_max", g.place_max, "(0, a quarter of the finger's circumference) m");
  }
  if (!within(g.carriage_max, 0, std::numbers::pi / 2))
    return outOfRange("carriage_max", g.carriage_max, "(0, pi/2) rad");
  return problemWithPoints(profile.points);
}

TwoDofKinematics::TwoDofKinematics(const TwoDofGeometry& geometry, FingerProfile profile)
    : geometry_(geometry), profile_(std::move(profile)) {
  if (const auto problem = problemWith(geometry_, profile_)) throw std::invalid_argument("2-DOF CLD: " + *problem);
}

Vec3 TwoDofKinematics::tactorRoot(const Vec3& q) const {
  const double R = geometry_.ring_radius;
  const auto [sa, ca] = math::sinCos(q[1]);
  const auto [sb, cb] = math::sinCos(q[2]);
  return {q[0] + R * cb * sa, R * sb, -R * cb * ca};
}

Mat3 TwoDofKinematics::jacobian(const Vec3& q) const {
  const double R = geometry_.ring_radius;
  const auto [sa, ca] = math::sinCos(q[1]);
  const auto [sb, cb] = math::sinCos(q[2]);
  Mat3 J;
  J << 1, R * cb * ca, -R * sb * sa,  //
      0, 0, R * cb,                   //
      0, R * cb * sa, R * sb * ca;
  return J;
}

Vec3 TwoDofKinematics::actuatorsAt(const PadWay& way) const {
  const ProfilePoint p = pointWhere(profile_.points, way.along, [](const ProfilePoint& point) { return point.place; });
  return {p.plate, p.tilt, way.round};
}

PadWay TwoDofKinematics::wayOf(const Vec3& q) const {
  const double R = geometry_.ring_radius;
  const ProfilePoint p = pointWhere(profile_.points, q[0] + R * q[1],
                                    [&](const ProfilePoint& point) { return point.plate + R * point.tilt; });
  return {p.place, q[2]};
}

Vec2 TwoDofKinematics::placeAt(const PadWay& way) const {
  const double r = profile_.radius;
  if (way.along <= 0) return {way.along, r * way.round};
  const auto round = math::sinCos(way.round), along = math::sinCos(way.along / r);
  const Vec2 across(round.cos * along.sin, round.sin);
  const double t = math::atan2(across.norm(), round.cos * along.cos);
  return across * (r * t / across.norm());  // |across| > 0, because along > 0 and both angles stay within a right angle
}

PadWay TwoDofKinematics::wayTo(const Vec2& place_L) const {
  const double r = profile_.radius;
  if (place_L.x() <= 0) return {place_L.x(), place_L.y() / r};
  const double t = place_L.norm() / r;
  const auto [sin, cos] = math::sinCos(t);
  const Vec2 across = place_L * (sin / place_L.norm());
  return {r * math::atan2(across.x(), cos), math::asin(std::clamp(across.y(), -1.0, 1.0))};
}

bool TwoDofKinematics::reaches(const Vec2& place_L, const PadWay& way) const {
  // Beyond a quarter turn round the finger the chart would come back from behind.
  const bool is_in_front = place_L.x() <= 0 || place_L.norm() < profile_.radius * std::numbers::pi / 2;
  return is_in_front && way.along >= geometry_.place_min && way.along <= geometry_.place_max &&
         std::abs(way.round) <= geometry_.carriage_max;
}

// Sixteen places, then the golden section round the best of them.
PadWay TwoDofKinematics::nearestOnEdge(const Vec2& place_L, const PadWay& from, const PadWay& to) const {
  constexpr int kPieces = 16;  // of the way, each looked at before the search
  const auto distance = [&](double share) { return (placeAt(blend(from, to, share)) - place_L).squaredNorm(); };
  int best = 0;
  double least = distance(0);
  for (int i = 1; i <= kPieces; ++i) {
    const double here = distance(i * (1.0 / kPieces));
    if (here >= least) continue;
    best = i;
    least = here;
  }
  double low = std::max(0, best - 1) * (1.0 / kPieces), high = std::min(kPieces, best + 1) * (1.0 / kPieces);
  constexpr double kGolden = 0.6180339887498949;  // each section keeps one of the two places of the last
  double a = high - kGolden * (high - low), b = low + kGolden * (high - low);
  double at_a = distance(a), at_b = distance(b);
  for (int i = 0; i < 40; ++i) {
    if (at_a < at_b) {
      high = std::exchange(b, a);
      at_b = at_a;
      a = high - kGolden * (high - low);
      at_a = distance(a);
    } else {
      low = std::exchange(a, b);
      at_a = at_b;
      b = low + kGolden * (high - low);
      at_b = distance(b);
    }
  }
  return blend(from, to, 0.5 * (low + high));
}

Reach TwoDofKinematics::reach(const Vec2& place_L) const {
  const PadWay way = wayTo(place_L);
  if (reaches(place_L, way)) return {way, place_L, false};
  const TwoDofGeometry& g = geometry_;
  // Where cylinder and sphere meet the edges have a kink, so they end there.
  const double b = g.carriage_max;
  const std::array<PadWay, 6> corners{
      {{g.place_min, -b}, {0, -b}, {g.place_max, -b}, {g.place_max, b}, {0, b}, {g.place_min, b}}};
  PadWay nearest = corners[0];
  for (std::size_t i = 0; i < corners.size(); ++i) {
    const PadWay candidate = nearestOnEdge(place_L, corners[i], corners[(i + 1) % corners.size()]);
    if ((placeAt(candidate) - place_L).squaredNorm() < (placeAt(nearest) - place_L).squaredNorm()) nearest = candidate;
  }
  return {nearest, placeAt(nearest), true};
}

}  // namespace pincer::devices
