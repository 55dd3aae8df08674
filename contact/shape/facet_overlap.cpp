#include "pincer/contact/shape/facet_overlap.h"

#include <algorithm>
#include <limits>

#include "pincer/contact/functions/invariants.h"
#include "pincer/contact/shape/point_choice.h"
#include "pincer/contact/shape/shared_outline.h"
#include "pincer/contact/shape/tolerances.h"

namespace pincer::contact {
namespace {

struct View {
  Mat3 R;  // columns t1, t2, n

  Vec2 across(const Vec3& p) const { return {R.col(0).dot(p), R.col(1).dot(p)}; }
  double along(const Vec3& p) const { return R.col(2).dot(p); }
};

void makePoint(const Vec3& p, const View& view, FlatCorner named, FlatFacet& out) {
  out.count = 1;
  named.x = view.across(p);
  out.corners[0] = named;
  out.x0 = named.x;
  out.z0 = view.along(p);
}

// `sign` is the side of n that the facet faces: -1 for a's. Facets too steep to have a height over each place are
// reduced to their corner or edge that reaches furthest.
void flatten(const PosedSolid& solid, const Facet& facet, double sign, const View& view, std::uint32_t kind,
             double size, FlatFacet& out) {
  const auto corner = [&](int i) -> const FacetCorner& { return facet.corners[static_cast<std::size_t>(i)]; };
  const auto named = [&](int i, int edge) -> FlatCorner {
    const std::uint32_t name = corner(i).vertex;
    return {Vec2::Zero(), featureOfCorner(kind == kCornerOfA, name), corner(edge).edge, facet.isStraight(edge)};
  };
  const auto placeOf = [&](int i) { return solid.place(corner(i).p); };
  if (facet.count > 2) {
    const Vec3 m = solid.outwards(facet.n);
    const double rise = view.along(m);
    if (sign * rise < kSteepestFacet) return makePoint(solid.support(sign * view.R.col(2)), view, named(0, 0), out);
    out.slope = -view.across(m) / rise;
    out.count = facet.count;
    for (int i = 0; i < facet.count; ++i) {
      const int from = sign > 0 ? i : facet.count - 1 - i,
                edge = sign > 0 ? from : (from + facet.count - 1) % facet.count;
      FlatCorner& c = out.corners[static_cast<std::size_t>(i)] = named(from, edge);
      c.x = view.across(placeOf(from));
    }
    const int first = sign > 0 ? 0 : facet.count - 1;
    out.x0 = out.corners[0].x;
    out.z0 = view.along(placeOf(first));
    return;
  }
  makePoint(placeOf(0), view, named(0, 0), out);
  out.line_radius = facet.line_radius;
  if (facet.count < 2) return;
  FlatCorner end = named(1, 0);
  end.x = view.across(placeOf(1));
  const Vec2 chord = end.x - out.x0;
  if (!(chord.norm() > kSamePlace * size)) return;
  out.slope = (view.along(placeOf(1)) - out.z0) / chord.squaredNorm() * chord;
  out.corners[1] = end;
  out.count = 2;
}

// The points as the choice sees them: a flat support whose gap at each is known.
class KnownGaps {
 public:
  KnownGaps(const Vec3* points, const double* gaps, const Vec3& n) : points_(points), gaps_(gaps), n_(n) {}
  double gap(const Vec3& p) const { return gaps_[&p - points_]; }  // `p` is one of the points
  Vec3 normal(const Vec3&) const { return n_; }

 private:
  const Vec3* points_;
  const double* gaps_;
  Vec3 n_;
};

// Heights of the two surfaces over a place: of polygons the plane's, over lines of round
// walls where the ray along n leaves the solid.
class Surfaces {
 public:
  Surfaces(const PosedSolid& a, const PosedSolid& b, const FlatFacet& fa, const FlatFacet& fb, const View& view)
      : a_(a), b_(b), fa_(fa), fb_(fb), view_(view), rounding_a_(roundingOf(a)), rounding_b_(roundingOf(b)) {}
  double top(const Vec2& x) const { return height(a_, fa_, -1, rounding_a_, x); }
  double bottom(const Vec2& x) const { return height(b_, fb_, 1, rounding_b_, x); }
  double roundings() const { return rounding_a_ + rounding_b_; }
  Vec3 place(const Vec2& x, double z) const {
    return x.x() * view_.R.col(0) + x.y() * view_.R.col(1) + z * view_.R.col(2);
  }

 private:
  double height(const PosedSolid& solid, const FlatFacet& f, double sign, double rounding, const Vec2& x) const {
    const double z = f.height(x);
    if (!(f.line_radius > 0)) return z + sign * rounding;
    return z + sign * reachOf(solid.shape, solid.inwards(place(x, z) - solid.p), solid.inwards(sign * view_.R.col(2)));
  }

  const PosedSolid& a_;
  const PosedSolid& b_;
  const FlatFacet& fa_;
  const FlatFacet& fb_;
  const View& view_;
  double rounding_a_, rounding_b_;
};

// The two surfaces' heights over each shared place.
struct Heights {
  std::array<double, kMostShared> top, bottom;
  double least_gap;

  void measure(const SharedOutline& shared, const Surfaces& surfaces) {
    least_gap = kInfinity;
    for (int i = 0; i < shared.count; ++i) {
      const auto at = static_cast<std::size_t>(i);
      top[at] = surfaces.top(shared.corners[at].x);
      bottom[at] = surfaces.bottom(shared.corners[at].x);
      least_gap = std::min(least_gap, top[at] - bottom[at]);
    }
  }
};

// True of a polygon of `solid` of which no place is further along d_W than the others.
bool isLevel(const PosedSolid& solid, const Facet& polygon, const Vec3& d_W, double size) {
  return polygon.count > 2 && polygon.n.cross(solid.inwards(d_W)).norm() * size <= kSameGap;
}

// Where an edge of what faces the end of a cylinder comes near the rim between two of its corners, one more is added;
// of edges that are all beyond the rim, where the nearest comes.
void reachOut(const PosedSolid& cylinder, const PosedSolid& other, const Facet& faced, const Vec3& d_W, double size,
              Facet& end) {
  if (!(end.rim_radius > 0)) return;
  const auto seen = [&](const Vec3& p) -> Vec2 { return cylinder.inwards(p - cylinder.p).head<2>(); };
  if (!isLevel(other, faced, d_W, size)) {
    const Vec2 furthest = seen(other.support(d_W));
    if (furthest.norm() < end.rim_radius) addRimCorner(furthest, end);
  }
  if (faced.rim_radius > 0) return addRimCorner(seen(other.p), end);
  Vec2 nearest = Vec2::Constant(kInfinity);
  for (int i = 0; i < faced.count; ++i) {
    const Vec2 from = seen(other.place(faced.corners[static_cast<std::size_t>(i)].p));
    const Vec2 side = seen(other.place(faced.corners[static_cast<std::size_t>((i + 1) % faced.count)].p)) - from;
    const double t = side.squaredNorm() > 0 ? std::clamp(-from.dot(side) / side.squaredNorm(), 0.0, 1.0) : 0;
    const Vec2 q = from + t * side;
    if (q.norm() < end.rim_radius * (1 + kSamePlace)) addRimCorner(q, end);
    if (q.squaredNorm() < nearest.squaredNorm()) nearest = q;
  }
  if (nearest.norm() > end.rim_radius) addRimCorner(nearest, end);
}

}  // namespace

bool overlapFacets(const PosedSolid& a, const PosedSolid& b, const Separation& along, double size, double margin,
                   const LastPoints& last, PairPoints& out) {
  const Vec3& n = along.n;
  PINCER_ASSERT(isUnitIfFinite(n));
  PINCER_ASSERT(size > 0);
  const View view{frameFromNormal(n)};
  Facet facet_a, facet_b;
  facetOf(a.shape, a.inwards(-n), facet_a);
  facetOf(b.shape, b.inwards(n), facet_b);
  reachOut(a, b, facet_b, n, size, facet_a);
  reachOut(b, a, facet_a, -n, size, facet_b);
  FlatFacet fa, fb;
  flatten(a, facet_a, -1, view, kCornerOfA, size, fa);
  flatten(b, facet_b, 1, view, kCornerOfB, size, fb);
  const Surfaces surfaces(a, b, fa, fb, view);
  const double least = along.gap - surfaces.roundings();
  SharedOutline shared;
  Heights heights;
  bool found = false, exactly = false;
  for (double slack = kSamePlace; slack < 2e-4 && !found;
       slack *= 10) {  // the direction may be right to round-off only
    shared.count = 0;
    shareOutline(fa, fb, slack * size, size, shared);
    heights.measure(shared, surfaces);
    found = heights.least_gap < least + slack * size;
    exactly = exactly || (found && slack == kSamePlace);
  }
  if (!found) {
    shared.count = 0;
    shared.add(view.across(0.5 * (a.support(-n) + b.support(n))), featureOf(kSupports, 0, 0));
    heights.measure(shared, surfaces);
  }

  std::array<Vec3, kMostShared> points;
  std::array<double, kMostShared> gaps;
  std::array<std::uint32_t, kMostShared> features;
  const double beside = found ? heights.least_gap - least : 0;  // an effect of the slack
  for (int i = 0; i < shared.count; ++i) {
    const auto at = static_cast<std::size_t>(i);
    const SharedCorner& c = shared.corners[at];
    const double top = heights.top[at], bottom = heights.bottom[at];
    gaps[at] = found ? std::max(top - bottom - std::max(beside, 0.0), least) : least;
    points[at] = surfaces.place(c.x, 0.5 * (top + bottom));
    features[at] = c.feature;
  }
  const auto count = static_cast<std::size_t>(shared.count);
  const KnownGaps support(points.data(), gaps.data(), n);
  const ExtremePoints candidates{{points.data(), count}, {features.data(), count}, 0};
  const PointChoice choice(candidates, support, margin, last);
  out.count = 0;
  for (int k = 0; k < choice.count(); ++k) {
    const auto [i, phi] = choice[k];
    const auto at = static_cast<std::size_t>(i);
    out.points[static_cast<std::size_t>(out.count++)] = {points[at], n, phi, features[at]};
  }
  std::sort(out.points.begin(), out.points.begin() + out.count,
            [](const PairPoint& x, const PairPoint& y) { return x.feature < y.feature; });
  return exactly;
}

}  // namespace pincer::contact
