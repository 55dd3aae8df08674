#include "contact/surface/surface_search.h"

#include <limits>

namespace pincer::contact {

namespace {

constexpr int kMaxVisits = 2000;

struct FlatPoint {
  std::array<double, 3> b;
  double distance2;
};

// Ericson's regions: three corners, three edges, the inside.
FlatPoint closestOnTriangle(const std::array<Vec3, 3>& corners, const Vec3& p) {
  const Vec3 &a = corners[0], &b = corners[1], &c = corners[2];
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

std::vector<Aabb> netBoxes(const SurfaceNet& net) {
  std::vector<Aabb> boxes;
  boxes.reserve(static_cast<std::size_t>(net.size()));
  for (std::int32_t t = 0; t < net.size(); ++t) {
    const SurfaceCell cell = net.build(t);
    Aabb box{cell.patch.b300, cell.patch.b300};
    for (const Vec3& p : controlPoints(cell.patch)) box = {box.low.cwiseMin(p), box.high.cwiseMax(p)};
    boxes.push_back(box);
  }
  return boxes;
}

// The patch lies in the hull of its control points, and distance from a convex set is a convex function.
double bulgeOf(const Patch& patch, const std::array<Vec3, 3>& corners) {
  double bulge2 = 0;
  for (const Vec3& p : controlPoints(patch)) bulge2 = std::max(bulge2, closestOnTriangle(corners, p).distance2);
  return std::sqrt(bulge2);
}

}  // namespace

SurfaceSearch::FlatTriangle::FlatTriangle(const Patch& patch, std::int32_t t) : corners{patch.b300, patch.b030, patch.b003}, triangle(t) {
  centre = (corners[0] + corners[1] + corners[2]) / 3;
  n = (corners[1] - corners[0]).cross(corners[2] - corners[0]).normalized();
  radius = 0;
  for (const Vec3& corner : corners) radius = std::max(radius, (corner - centre).norm());
  bulge = bulgeOf(patch, corners);
}

bool SurfaceSearch::FlatTriangle::discIsWithin(const Vec3& p, double distance) const {
  const Vec3 R = p - centre;
  const double above = R.dot(n);
  const double reach2 = distance * distance - above * above;  // squared, in the disc's plane
  if (reach2 <= 0) return false;
  const double reach = radius + std::sqrt(reach2);
  return R.squaredNorm() - above * above <= reach * reach;
}

SurfaceSearch::SurfaceSearch(const SurfaceNet& net) : tree_(netBoxes(net)) {
  leaves_.reserve(static_cast<std::size_t>(net.size()));
  for (const std::int32_t t : tree_.order()) leaves_.emplace_back(net.build(t).patch, t);
}

SurfaceSeed SurfaceSearch::nearest(const SurfaceNet& net, PatchCache& cache, const Vec3& p, double bound) const {
  SurfaceSeed seed{{}, bound, false};
  double bound2 = bound * bound;
  tree_.visitNear(p, bound2, kMaxVisits, [&](std::int32_t place_in_order) {
    const FlatTriangle& leaf = leaves_[static_cast<std::size_t>(place_in_order)];
    const double reach = seed.distance + leaf.bulge;
    if (!leaf.discIsWithin(p, reach)) return;
    const FlatPoint flat = closestOnTriangle(leaf.corners, p);
    if (flat.distance2 >= reach * reach) return;
    const double distance2 = (p - place(net.cell(leaf.triangle, cache).patch, flat.b[1], flat.b[2])).squaredNorm();
    if (distance2 >= bound2) return;
    bound2 = distance2;
    seed = {{leaf.triangle, flat.b}, std::sqrt(distance2), true};
  });
  return seed;
}

}  // namespace pincer::contact
