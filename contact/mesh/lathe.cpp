#include "pincer/contact/mesh/lathe.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <numbers>

#include "pincer/contact/error.h"

namespace pincer::contact {
namespace {

double sideOf(const Vec2& a, const Vec2& b, const Vec2& p) {
  return (b - a).x() * (p - a).y() - (b - a).y() * (p - a).x();
}

bool within(const Vec2& a, const Vec2& b, const Vec2& p) {
  return (p - a).dot(p - b) <= 0;  // p is on the line through a and b
}

bool segmentsMeet(const Vec2& a, const Vec2& b, const Vec2& c, const Vec2& d) {
  const double c_side = sideOf(a, b, c), d_side = sideOf(a, b, d), a_side = sideOf(c, d, a), b_side = sideOf(c, d, b);
  if (((c_side > 0) != (d_side > 0)) && ((a_side > 0) != (b_side > 0)) && c_side * d_side != 0 && a_side * b_side != 0)
    return true;
  return (c_side == 0 && within(a, b, c)) || (d_side == 0 && within(a, b, d)) || (a_side == 0 && within(c, d, a)) ||
         (b_side == 0 && within(c, d, b));
}

void requireOnAxisAtTheEndsOnly(const std::vector<Vec2>& profile) {
  const std::size_t last = profile.size() - 1;
  for (std::size_t i = 0; i <= last; ++i) {
    const bool end = i == 0 || i == last;
    const double rho = profile[i].x();
    if (!profile[i].allFinite() || (end ? rho != 0 : !(rho > 0))) {
      throw InputError(fmt::format(
          "lathe: profile[{}] = ({}, {}): its distance from the axis must be {}. The first and the last point close "
          "the solid on the axis, all others lie beside it.",
          i, rho, profile[i].y(), end ? "0" : "greater than 0"));
    }
  }
}

void requireSimple(const std::vector<Vec2>& profile) {
  const std::size_t sides = profile.size() - 1;
  for (std::size_t i = 0; i < sides; ++i) {
    if (profile[i] == profile[i + 1])
      throw InputError(fmt::format("lathe: profile[{}] and profile[{}] are equal. Leave one out.", i, i + 1));
  }
  for (std::size_t i = 0; i < sides; ++i) {
    for (std::size_t k = i + 2; k < sides; ++k) {
      if (!segmentsMeet(profile[i], profile[i + 1], profile[k], profile[k + 1])) continue;
      throw InputError(fmt::format(
          "lathe: the profile crosses itself: its side after profile[{}] meets the side after profile[{}]. Give the "
          "points in their order along the outline.",
          i, k));
    }
  }
}

// Twice the area between profile and axis, positive if the profile runs towards +z outside.
double area(const std::vector<Vec2>& profile) {
  double sum = 0;
  for (std::size_t i = 0; i + 1 < profile.size(); ++i) {
    sum += profile[i].x() * profile[i + 1].y() - profile[i + 1].x() * profile[i].y();
  }
  return sum;
}

}  // namespace

TriangleMesh lathe(const std::vector<Vec2>& given, int segments) {
  if (given.size() < 3)
    throw InputError(fmt::format("lathe: a profile of {} points encloses nothing. Give 3 or more.", given.size()));
  if (segments < 3 || segments > 1000)
    throw InputError(fmt::format("lathe: segments = {} is out of range 3 .. 1000.", segments));
  requireOnAxisAtTheEndsOnly(given);
  requireSimple(given);
  std::vector<Vec2> profile = given;
  if (area(profile) < 0) std::reverse(profile.begin(), profile.end());

  TriangleMesh mesh;
  mesh.source = "lathe";
  const auto rings = static_cast<int>(profile.size()) - 2;
  for (int i = 1; i <= rings; ++i) {
    const Vec2& p = profile[static_cast<std::size_t>(i)];
    for (int k = 0; k < segments; ++k) {
      const double angle = 2 * std::numbers::pi * k / segments;
      mesh.vertices.emplace_back(p.x() * math::cos(angle), p.x() * math::sin(angle), p.y());
    }
  }
  const int bottom = rings * segments, top = bottom + 1;
  mesh.vertices.emplace_back(0, 0, profile.front().y());
  mesh.vertices.emplace_back(0, 0, profile.back().y());
  const auto at = [&](int ring, int k) { return ring * segments + k % segments; };
  for (int k = 0; k < segments; ++k) {
    mesh.triangles.push_back({bottom, at(0, k + 1), at(0, k)});
    for (int ring = 0; ring + 1 < rings; ++ring) {
      mesh.triangles.push_back({at(ring, k), at(ring, k + 1), at(ring + 1, k + 1)});
      mesh.triangles.push_back({at(ring, k), at(ring + 1, k + 1), at(ring + 1, k)});
    }
    mesh.triangles.push_back({at(rings - 1, k), at(rings - 1, k + 1), top});
  }
  return mesh;
}

}  // namespace pincer::contact
