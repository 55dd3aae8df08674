#include "pincer/contact/shape/wall_line.h"

#include <algorithm>

#include "pincer/contact/shape/tolerances.h"

namespace pincer::contact {

WallLine::WallLine(const SurfaceNet& net, std::int32_t t, const Vec3& p) : net_(net), p_(p) {
  if (!findLine(t, p, along_, &normal_)) return;
  across_ = normal_.cross(along_).normalized();
  low_ = -follow(t, -1);
  high_ = follow(t, 1);
}

// The only edge of the triangle along which the surface is straight and faces one way; -1 if there is none, or three
// as on a flat face.
int WallLine::straightEdge(std::int32_t t) const {
  int found = -1;
  for (int i = 0; i < 3; ++i) {
    const Vec3 n = net_.normal(t, i), e = (net_.vertex(t, (i + 1) % 3) - net_.vertex(t, i)).normalized();
    if ((net_.normal(t, (i + 1) % 3) - n).norm() > kNoAngle || std::abs(e.dot(n)) > kNoAngle) continue;
    if (found >= 0) return -1;
    found = i;
  }
  return found;
}

// The direction of the straight edge through a corner of the triangle, which is a neighbour's; `along` if none has one.
Vec3 WallLine::lineThrough(std::int32_t t, int corner, const Vec3& along) const {
  const Vec3 p = net_.vertex(t, corner);
  for (const int side : {corner, (corner + 2) % 3}) {
    const Neighbour next = net_.neighbour(t, side);
    const int edge = next.triangle < 0 || net_.isSharp(t, side) ? -1 : straightEdge(next.triangle);
    if (edge < 0) continue;
    const Vec3 from = net_.vertex(next.triangle, edge), to = net_.vertex(next.triangle, (edge + 1) % 3);
    if (from != p && to != p) continue;
    const Vec3 e = (to - from).normalized();
    return e.dot(along) < 0 ? Vec3(-e) : e;
  }
  return along;
}

// Triangle t's line through q, and the wall's normal there: between its straight edge and that through the corner
// beside it, by the share of the way from the one to the other. False if it has none.
bool WallLine::findLine(std::int32_t t, const Vec3& q, Vec3& line, Vec3* n) const {
  const int edge = straightEdge(t);
  if (edge < 0) return false;
  const int corner = (edge + 2) % 3;
  const Vec3 from = net_.vertex(t, edge);
  Vec3 along = (net_.vertex(t, (edge + 1) % 3) - from).normalized();
  int axis = 0;
  along.cwiseAbs().maxCoeff(&axis);
  if (along[axis] < 0) along = -along;  // one way on all triangles of a wall
  const auto asideOf = [&](const Vec3& v) { return Vec3(v - v.dot(along) * along); };
  const Vec3 to_corner = net_.vertex(t, corner) - from, to_q = q - from, w = asideOf(to_corner).normalized();
  const Vec3 other = lineThrough(t, corner, along);
  const double slope = other.dot(w) / other.dot(along);
  const double width = w.dot(to_corner) + slope * (to_q - to_corner).dot(along);  // of the wall at q
  if (!(width > kNoAngle * to_corner.norm())) return false;
  line = (along + slope / width * asideOf(to_q)).normalized();
  const double share = std::clamp(w.dot(to_q) / width, 0.0, 1.0);
  if (n) *n = ((1 - share) * net_.normal(t, edge) + share * net_.normal(t, corner)).normalized();
  return true;
}

// True if triangle t goes on with the line, at `x` along it.
bool WallLine::goesOn(std::int32_t t, double x) const {
  constexpr double kOneLine = 1e-3;  // sine, chosen: patches are as straight as that
  Vec3 line;
  return findLine(t, p_ + x * along_, line, nullptr) && line.cross(along_).squaredNorm() < kOneLine * kOneLine;
}

// How far the wall goes on that way [m]. A line along an edge is looked for just inside of its triangle.
double WallLine::follow(std::int32_t t, double sign) const {
  constexpr int kMostTriangles = 64;  // chosen: bounds the work; a wall of more ends there
  constexpr double kInside = 1e-3;    // of the triangle's width
  double low = seen(net_.vertex(t, 0)).y(), high = low;
  for (int i = 1; i < 3; ++i) {
    low = std::min(low, seen(net_.vertex(t, i)).y());
    high = std::max(high, seen(net_.vertex(t, i)).y());
  }
  const double y = std::clamp(0.0, low + kInside * (high - low), high - kInside * (high - low));
  double furthest = 0;
  int entered = -1;
  for (int n = 0; n < kMostTriangles; ++n) {
    int left = -1;
    double way = -kInfinity;
    for (int i = 0; i < 3; ++i) {
      const Vec2 from = seen(net_.vertex(t, i)), to = seen(net_.vertex(t, (i + 1) % 3));
      if (i == entered || (from.y() < y) == (to.y() < y)) continue;
      const double x = sign * (from.x() + (y - from.y()) / (to.y() - from.y()) * (to.x() - from.x()));
      if (x > way) way = x, left = i;
    }
    if (left < 0) break;
    furthest = way;
    const Neighbour next = net_.neighbour(t, left);
    if (net_.isSharp(t, left) || next.triangle < 0 || !goesOn(next.triangle, sign * way)) break;
    t = next.triangle;
    entered = next.edge;
  }
  return furthest;
}

}  // namespace pincer::contact
