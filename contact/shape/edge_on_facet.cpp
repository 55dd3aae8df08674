#include "pincer/contact/shape/edge_on_facet.h"

#include <algorithm>

#include "pincer/contact/functions/invariants.h"
#include "pincer/contact/shape/tolerances.h"

namespace pincer::contact {
namespace {

// The rest of the line q + t u: ends that are outside by less than the slack stay
// where they are, others move to the crossing.
struct Range {
  double from, to, slack;  // [m]

  // Keeps where value + t slope >= 0, a distance [m].
  void keep(double value, double slope) {
    const bool from_in = value + from * slope >= -slack, to_in = value + to * slope >= -slack;
    if (from_in && to_in) return;
    if (!from_in && !to_in) return drop();
    const double crossing = std::clamp(-value / slope, from, to);
    (from_in ? to : from) = crossing;
  }
  // Keeps what is within `radius` of the z axis.
  void keepWithin(double radius, const Vec3& q, const Vec3& u) {
    const double uu = u.head<2>().squaredNorm(), qu = q.head<2>().dot(u.head<2>());
    const double rest = qu * qu - uu * (q.head<2>().squaredNorm() - radius * radius);
    if (!(rest >= 0 && uu > 0)) return drop();
    const auto isIn = [&](double t) { return (q + t * u).head<2>().norm() <= radius + slack; };
    const double enters = (-qu - std::sqrt(rest)) / uu, leaves = (-qu + std::sqrt(rest)) / uu;
    if (enters > to || leaves < from) return drop();
    if (!isIn(from)) from = enters;
    if (!isIn(to)) to = leaves;
  }
  void drop() { to = -kInfinity; }
  bool isEmpty() const { return !(from <= to); }
};

// All in the solid's frame.
EdgePart overPolygon(const Vec3& p, const Vec3& e, double length, const Vec3& n, const Facet& f, double slack) {
  const double rise = f.n.dot(n);
  if (rise < kSteepestFacet) return {};
  const double height = f.n.dot(p - f.corners[0].p) / rise, slope = f.n.dot(e) / rise;
  const Vec3 q = p - height * n, u = e - slope * n;  // seen along n on the facet's plane
  Range range{0, length, slack};
  for (int i = 0; i < f.count; ++i) {
    if (!f.isStraight(i)) continue;
    const Vec3& from = f.corners[static_cast<std::size_t>(i)].p;
    const Vec3 inwards =
        f.n.cross(f.corners[static_cast<std::size_t>(i + 1 < f.count ? i + 1 : 0)].p - from).normalized();
    range.keep(inwards.dot(q - from), inwards.dot(u));
  }
  if (f.rim_radius > 0) range.keepWithin(f.rim_radius, q, u);
  if (range.isEmpty()) return {};
  return {{{{range.from, height + range.from * slope}, {range.to, height + range.to * slope}}}, true, true};
}

EdgePart overLine(const Vec3& p, const Vec3& e, double length, const Vec3& n, const Facet& f, double slack,
                  const Shape& shape) {
  const Vec3 &from = f.corners[0].p, line = f.corners[1].p - from;
  const double line_length = line.norm();
  if (e.cross(line).norm() > kNearlyParallelEdges * line_length) return {};
  const double along = line.dot(p - from) / line_length, rate = line.dot(e) / line_length;
  Range range{0, length, slack};
  range.keep(along, rate);
  range.keep(line_length - along, -rate);
  if (range.isEmpty()) return {};
  // exactly, or the solid's end might be what is met
  const Vec3 axis = line / line_length, across = (n - n.dot(axis) * axis).normalized();
  const auto at = [&](double t) -> EdgePart::End { return {t, -reachOf(shape, p + t * e, across)}; };
  return {{at(range.from), at(range.to)}, false, true};
}

}  // namespace

EdgePart partOverFacet(const Vec3& p, const Vec3& e, double length, const Vec3& n, const PosedSolid& solid,
                       double slack) {
  PINCER_ASSERT(isUnitIfFinite(e) && isUnitIfFinite(n));
  PINCER_ASSERT(!(std::abs(e.dot(n)) > 1e-3));  // normals of slivers lean by their round-off
  Facet facet;
  const Vec3 p_B = solid.inwards(p - solid.p), e_B = solid.inwards(e), n_B = solid.inwards(n);
  facetOf(solid.shape, n_B, facet);
  if (facet.count > 2) return overPolygon(p_B, e_B, length, n_B, facet, slack);
  if (facet.count == 2) return overLine(p_B, e_B, length, n_B, facet, slack, solid.shape);
  return {};
}

}  // namespace pincer::contact
