#include "pincer/contact/curve/polyline.h"

#include <fmt/format.h>

#include "pincer/contact/error.h"

namespace pincer::contact {

namespace {

double turnBetween(const Vec2& a, const Vec2& b) { return math::atan2(a.x() * b.y() - a.y() * b.x(), a.dot(b)); }

// `names`: of the vertices, as the caller counts them.
void requireVertex(const CorneredPath& path, const std::vector<std::size_t>& names, std::size_t i,
                   double largest_turn) {
  const std::vector<Vec2>& p = path.vertices;
  const std::size_t n = p.size(), next = (i + 1) % n, last = (i + n - 1) % n;
  if (!p[i].allFinite()) throw InputError(fmt::format("polyline: vertex {} isn't finite.", names[i]));
  if (!path.is_closed && path.is_sharp[i] && (i == 0 || next == 0))
    throw InputError(fmt::format(
        "polyline: vertex {} is an end of an open path, which has no corner there. Name it once.", names[i]));
  if (!path.is_closed && next == 0) return;
  if (p[next] == p[i])
    throw InputError(fmt::format(
        "polyline: vertices {} and {} are at the same place. Name it once, or twice in a row for a sharp corner.",
        names[i], names[next]));
  if (!path.is_closed && i == 0) return;
  const double turn = turnBetween(p[i] - p[last], p[next] - p[i]);
  if (std::abs(turn) < largest_turn) return;
  throw InputError(
      fmt::format("polyline: the path turns by {:.1f} degrees at vertex {}, allowed is less than {:.0f}. Add vertices "
                  "there, name it twice "
                  "(a sharp corner), or use the variant facet.",
                  turn / kDegree, names[i], largest_turn / kDegree));
}

}  // namespace

CorneredPath requireSound(const Polyline& polyline, double largest_turn, double largest_corner) {
  CorneredPath path{{}, {}, polyline.is_closed};
  std::vector<std::size_t> names;
  for (std::size_t i = 0; i < polyline.vertices.size(); ++i) {
    const Vec2& p = polyline.vertices[i];
    if (!path.vertices.empty() && p == path.vertices.back() && !path.is_sharp.back()) {
      path.is_sharp.back() = true;
      continue;
    }
    path.vertices.push_back(p);
    path.is_sharp.push_back(false);
    names.push_back(i);
  }
  const std::size_t least = polyline.is_closed ? 3 : 2;
  if (path.vertices.size() < least)
    throw InputError(fmt::format("polyline: {} vertices, needed are at least {}.", path.vertices.size(), least));
  for (std::size_t i = 0; i < path.vertices.size(); ++i)
    requireVertex(path, names, i, path.is_sharp[i] ? largest_corner : largest_turn);
  return path;
}

Polyline arcPolygon(double radius, double turn, double sweep) {
  if (!(radius > 0)) throw InputError(fmt::format("arc polygon: radius = {} m is out of range (0, inf).", radius));
  if (!(turn > 0 && turn < M_PI))
    throw InputError(fmt::format("arc polygon: turn = {} rad is out of range (0, pi).", turn));
  if (!(sweep >= turn && sweep < 2 * M_PI)) {
    throw InputError(fmt::format("arc polygon: sweep = {} rad is out of range [{}, 2 pi).", sweep, turn));
  }
  if (sweep / turn > 1e6)
    throw InputError(fmt::format("arc polygon: turn = {} rad makes more than a million segments.", turn));
  const int segments = static_cast<int>(std::ceil(sweep / turn - 1e-9));  // a sweep of five turns makes five
  Polyline arc;
  for (int i = 0; i <= segments; ++i) {
    const double angle = (i - 0.5 * segments) * turn;
    arc.vertices.emplace_back(-radius * math::sin(angle), radius * math::cos(angle));
  }
  return arc;
}

}  // namespace pincer::contact
