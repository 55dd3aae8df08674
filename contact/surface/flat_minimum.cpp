#include "pincer/contact/surface/flat_minimum.h"

namespace pincer::contact {

namespace {

Vec3 facetNormal(const SurfaceNet& net, std::int32_t t) {
  return (net.vertex(t, 1) - net.vertex(t, 0)).cross(net.vertex(t, 2) - net.vertex(t, 0));
}

bool isMinimumOnEdge(const SurfaceNet& net, std::int32_t t, int edge, const Vec3& R) {
  const Neighbour other = net.neighbour(t, edge);
  if (other.triangle < 0) return true;
  const Vec3 n = facetNormal(net, t), m = facetNormal(net, other.triangle);
  const Vec3 along = net.vertex(other.triangle, (other.edge + 1) % 3) - net.vertex(other.triangle, other.edge);
  return R.dot(m.cross(along)) <= 0 && R.dot(n / n.norm() + m / m.norm()) > 0;
}

bool isMinimumAtVertex(const SurfaceNet& net, const CellCorner& at, const Vec3& R) {
  const Vec3& p = net.vertex(at.triangle, at.corner);
  bool is_least = true;
  Vec3 outward = Vec3::Zero();
  const bool is_border = net.visitCorners(at, [&](const CellCorner& c) {
    for (const int other : {(c.corner + 1) % 3, (c.corner + 2) % 3})
      is_least = is_least && R.dot(net.vertex(c.triangle, other) - p) <= 0;
    outward += net.normal(c.triangle, c.corner);
    return is_least;
  });
  return is_least && (is_border || R.dot(outward) > 0);
}

}  // namespace

// Ericson's regions: three corners, three edges, the inside.
FlatPoint closestOnTriangle(const Vec3& a, const Vec3& b, const Vec3& c, const Vec3& p) {
  const auto at = [&](double wa, double wb, double wc) -> FlatPoint {
    return {{wa, wb, wc}, (p - (wa * a + wb * b + wc * c)).squaredNorm()};
  };
  const Vec3 ab = b - a, ac = c - a, ap = p - a, bp = p - b, cp = p - c;
  const double d1 = ab.dot(ap), d2 = ac.dot(ap);
  if (d1 <= 0 && d2 <= 0) return at(1, 0, 0);
  const double d3 = ab.dot(bp), d4 = ac.dot(bp);
  if (d3 >= 0 && d4 <= d3) return at(0, 1, 0);
  const double vc = d1 * d4 - d3 * d2;
  if (vc <= 0 && d1 >= 0 && d3 <= 0) return at(1 - d1 / (d1 - d3), d1 / (d1 - d3), 0);
  const double d5 = ab.dot(cp), d6 = ac.dot(cp);
  if (d6 >= 0 && d5 <= d6) return at(0, 0, 1);
  const double vb = d5 * d2 - d1 * d6;
  if (vb <= 0 && d2 >= 0 && d6 <= 0) return at(1 - d2 / (d2 - d6), 0, d2 / (d2 - d6));
  const double va = d3 * d6 - d5 * d4;
  const double w = (d4 - d3) / ((d4 - d3) + (d5 - d6));
  if (va <= 0 && d4 - d3 >= 0 && d5 - d6 >= 0) return at(0, 1 - w, w);
  const double sum = va + vb + vc;
  return at(va / sum, vb / sum, vc / sum);
}

FlatPoint closestOnFacet(const SurfaceNet& net, std::int32_t triangle, const Vec3& p) {
  return closestOnTriangle(net.vertex(triangle, 0), net.vertex(triangle, 1), net.vertex(triangle, 2), p);
}

bool isFlatMinimum(const SurfaceNet& net, std::int32_t triangle, const FlatPoint& flat, const Vec3& p) {
  Vec3 R = p;
  int zeros = 0, zero = 0, other = 0;
  for (int i = 0; i < 3; ++i) {
    const double b = flat.b[static_cast<std::size_t>(i)];
    R -= b * net.vertex(triangle, i);
    zeros += b == 0;
    (b == 0 ? zero : other) = i;
  }
  if (zeros == 0) return R.dot(facetNormal(net, triangle)) > 0;
  if (zeros == 1) return isMinimumOnEdge(net, triangle, (zero + 1) % 3, R);
  return isMinimumAtVertex(net, {triangle, other}, R);
}

}  // namespace pincer::contact
