#include "pincer/contact/curve/polyline.h"

#include <fmt/format.h>

#include "pincer/contact/error.h"

namespace pincer::contact {

namespace {

double turnBetween(const Vec2& a, const Vec2& b) { return math::atan2(a.x() * b.y() - a.y() * b.x(), a.dot(b)); }

void requireVertex(const Polyline& polyline, std::size_t i, double largest_turn) {
  const std::vector<Vec2>& p = polyline.vertices;
  const std::size_t n = p.size(), next = (i + 1) % n, last = (i + n - 1) % n;
  if (!p[i].allFinite()) throw InputError(fmt::format("polyline: vertex {} isn't finite.", i));
  if (!polyline.is_closed && next == 0) return;
  if (p[next] == p[i]) throw InputError(fmt::format("polyline: vertices {} and {} are at the same place. Name it once.", i, next));
  if (!polyline.is_closed && i == 0) return;
  const double turn = turnBetween(p[i] - p[last], p[next] - p[i]);
  if (std::abs(turn) < largest_turn) return;
  throw InputError(fmt::format(
      "polyline: the path turns by {:.1f} degrees at vertex {}, allowed is less than {:.0f}. Add vertices there, or use the variant facet.",
      turn / kDegree, i, largest_turn / kDegree));
}

}  // namespace

void requireSound(const Polyline& polyline, double largest_turn) {
  const std::size_t least = polyline.is_closed ? 3 : 2;
  if (polyline.vertices.size() < least) {
    throw InputError(fmt::format("polyline: {} vertices, needed are at least {}.", polyline.vertices.size(), least));
  }
  for (std::size_t i = 0; i < polyline.vertices.size(); ++i) requireVertex(polyline, i, largest_turn);
}

Polyline arcPolygon(double radius, double turn, double sweep) {
  if (!(radius > 0)) throw InputError(fmt::format("arc polygon: radius = {} m is out of range (0, inf).", radius));
  if (!(turn > 0 && turn < M_PI)) throw InputError(fmt::format("arc polygon: turn = {} rad is out of range (0, pi).", turn));
  if (!(sweep >= turn && sweep < 2 * M_PI)) {
    throw InputError(fmt::format("arc polygon: sweep = {} rad is out of range [{}, 2 pi).", sweep, turn));
  }
  if (sweep / turn > 1e6) throw InputError(fmt::format("arc polygon: turn = {} rad makes more than a million segments.", turn));
  const int segments = static_cast<int>(std::ceil(sweep / turn - 1e-9));  // a sweep of five turns makes five
  Polyline arc;
  for (int i = 0; i <= segments; ++i) {
    const double angle = (i - 0.5 * segments) * turn;
    arc.vertices.emplace_back(-radius * math::sin(angle), radius * math::cos(angle));
  }
  return arc;
}

}  // namespace pincer::contact
