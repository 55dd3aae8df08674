#include "pincer/contact/shape/facet_overlap.h"

#include <algorithm>
#include <limits>

#include "pincer/contact/functions/invariants.h"
#include "pincer/contact/shape/point_choice.h"
#include "pincer/contact/shape/tolerances.h"

namespace pincer::contact {
namespace {

enum : std::uint32_t { kCornerOfA = 0, kCornerOfB = 1, kCrossing = 2, kSupports = 3 };
std::uint32_t featureOf(std::uint32_t kind, std::uint32_t a, std::uint32_t b) { return kind << 28 | a << 14 | b; }

// A facet seen along n: places across n, and its height as an affine function of them.
struct FlatCorner {
  Vec2 x;
  std::uint32_t feature;
  std::uint32_t edge;  // to the next corner, in the facet's own names
};
struct FlatFacet {
  std::array<FlatCorner, Facet::kMost> corners;  // counter-clockwise seen against n
  int count = 0;
  Vec2 x0 = Vec2::Zero(), slope = Vec2::Zero();
  double z0 = 0;
  double line_radius = 0;  // as Facet's

  const FlatCorner& corner(int i) const { return corners[static_cast<std::size_t>(i)]; }
  double height(const Vec2& x) const { return z0 + slope.dot(x - x0); }
};

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
    return {Vec2::Zero(), featureOfCorner(kind == kCornerOfA, name), corner(edge).edge};
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

struct Corner {
  Vec2 x;
  std::uint32_t feature;
};

// At most: the corners of one facet, and two for each edge of the other.
constexpr int kMostShared = 3 * Facet::kMost;
struct Shared {
  std::array<Corner, kMostShared> corners;
  int count = 0;

  void add(const Vec2& x, std::uint32_t feature) {
    if (count < kMostShared) corners[static_cast<std::size_t>(count++)] = {x, feature};
  }
};

// The line along the edge that begins at corner j of `f`.
struct EdgeLine {
  Vec2 from, edge;
  double length;

  EdgeLine(const FlatFacet& f, int j)
      : from(f.corner(j).x), edge(f.corner(j + 1 < f.count ? j + 1 : 0).x - from), length(edge.norm()) {}
  // how far `x` is to its left [m]
  double leftOf(const Vec2& x) const { return length > 0 ? cross(edge, x - from) / length : 0; }
};

// A polygon being clipped: each edge belongs to the facet that is clipped, or lies on an edge of the clipping one.
struct ClipCorner {
  Vec2 x;
  std::uint32_t feature;
  std::uint32_t edge;
  int clip;  // place of the clipping edge that the edge to the next corner lies on; -1 for the facet's own
};
struct ClipPolygon {
  std::array<ClipCorner, kMostShared> corners;
  int count = 0;

  void add(const ClipCorner& c) {
    if (count < kMostShared) corners[static_cast<std::size_t>(count++)] = c;
  }
};

// The name of the point where the clipping edge j meets the edge that `c` begins: a
// crossing, or a corner of the clipping facet.
std::uint32_t nameOfCut(const ClipCorner& c, const FlatFacet& clipper, int j, bool clipper_is_a) {
  if (c.clip < 0) {
    const std::uint32_t other = clipper.corner(j).edge;
    return clipper_is_a ? featureOf(kCrossing, other, c.edge) : featureOf(kCrossing, c.edge, other);
  }
  return clipper.corner((c.clip + 1) % clipper.count == j ? j : c.clip).feature;
}

// False where nothing of `in` is beyond the edge: then `out` isn't written.
bool clipBy(const FlatFacet& clipper, int j, bool clipper_is_a, double tolerance, const ClipPolygon& in,
            ClipPolygon& out) {
  const EdgeLine line(clipper, j);
  std::array<double, kMostShared> left;
  bool all_in = true;
  for (int i = 0; i < in.count; ++i) {
    const auto at = static_cast<std::size_t>(i);
    left[at] = line.leftOf(in.corners[at].x);
    all_in = all_in && left[at] >= -tolerance;
  }
  if (all_in) return false;
  out.count = 0;
  for (int i = 0; i < in.count; ++i) {
    const auto at = static_cast<std::size_t>(i), after = static_cast<std::size_t>(i + 1 < in.count ? i + 1 : 0);
    const ClipCorner &c = in.corners[at], &next = in.corners[after];
    const double here = left[at], there = left[after];
    const bool is_in = here >= -tolerance, next_in = there >= -tolerance;
    if (is_in) out.add(c);
    if (is_in == next_in) continue;
    const double t = std::clamp(here / (here - there), 0.0, 1.0);
    // Leaving, the outline goes on along the clipping edge; entering, along its own.
    ClipCorner cut{c.x + t * (next.x - c.x), nameOfCut(c, clipper, j, clipper_is_a), c.edge, c.clip};
    if (is_in) cut.clip = j;
    out.add(cut);
  }
  return true;
}

// Of polygon and polygon, or of segment and polygon (a segment is clipped as a polygon there and back).
void clipFacet(const FlatFacet& facet, const FlatFacet& clipper, bool clipper_is_a, double tolerance, Shared& out) {
  std::array<ClipPolygon, 2> polygons;
  ClipPolygon *from = &polygons[0], *to = &polygons[1];
  for (int i = 0; i < facet.count; ++i)
    from->add({facet.corner(i).x, facet.corner(i).feature, facet.corner(i).edge, -1});
  for (int j = 0; j < clipper.count && from->count > 0; ++j) {
    if (clipBy(clipper, j, clipper_is_a, tolerance, *from, *to)) std::swap(from, to);
  }
  for (int i = 0; i < from->count; ++i) {
    const ClipCorner& c = from->corners[static_cast<std::size_t>(i)];
    const auto isSame = [&](const Corner& other) {
      return other.feature == c.feature || (other.x - c.x).squaredNorm() <= tolerance * tolerance;
    };
    if (std::none_of(out.corners.begin(), out.corners.begin() + out.count, isSame)) out.add(c.x, c.feature);
  }
}

// True of two round walls whose lines cross at so small an angle that they touch all along: there they are hardly
// nearer to each other than at the ends, and round-off would move the place from end to end.
//   radii  of both walls together [m], 0 unless both are round
bool touchAllAlong(const Vec2& a, const Vec2& b, double radii, double size) {
  constexpr double kNearer = 1e-7;  // of the size
  const double aside = std::abs(cross(a, b)) / std::max(a.norm(), b.norm());
  return aside * aside < 2 * radii * kNearer * size;
}

// The part of segment f that lies over the segment g, measured along f: the ends of f or the feet of g's ends; and
// where they cross, without ends within kOnePoint of that: of two such now one, now the other would carry.
void overlapSegments(const FlatFacet& fa, const FlatFacet& fb, double tolerance, double size, Shared& out) {
  const Vec2 a0 = fa.corner(0).x, b0 = fb.corner(0).x;
  const Vec2 a = fa.corner(1).x - a0, b = fb.corner(1).x - b0;
  const double sine = cross(a, b), lengths = a.norm() * b.norm();
  const double radii = fa.line_radius + fb.line_radius;
  const bool are_round = fa.line_radius > 0 && fb.line_radius > 0;
  if (std::abs(sine) > kNoAngle * lengths && !touchAllAlong(a, b, are_round ? radii : 0, size)) {
    const double s = cross(b0 - a0, b) / sine, t = cross(b0 - a0, a) / sine;
    const double slack_a = tolerance / a.norm(), slack_b = tolerance / b.norm();
    if (s >= -slack_a && s <= 1 + slack_a && t >= -slack_b && t <= 1 + slack_b)
      out.add(a0 + std::clamp(s, 0.0, 1.0) * a, featureOf(kCrossing, fa.corner(0).edge, fb.corner(0).edge));
  }
  if (std::abs(sine) > kNearlyParallelEdges * lengths) return;
  // `share`: of the way to the other line after which the two walls are as steep as each other.
  const auto addEnd = [&](const FlatCorner& end, const Vec2& from, const Vec2& line, double share) {
    const double at = (end.x - from).dot(line) / line.squaredNorm();
    const double slack = tolerance / line.norm();
    if (at < -slack || at > 1 + slack) return;
    const Vec2 beside = from + at * line - end.x;
    if (beside.norm() > tolerance + radii) return;
    const Vec2 x = end.x + share * beside;
    const auto isSame = [&](const Corner& other) { return (other.x - x).norm() <= kOnePoint * size; };
    if (std::none_of(out.corners.begin(), out.corners.begin() + out.count, isSame)) out.add(x, end.feature);
  };
  const double share_a = radii > 0 ? fa.line_radius / radii : 0.5;
  for (int i = 0; i < 2; ++i) addEnd(fa.corner(i), b0, b, share_a);
  for (int i = 0; i < 2; ++i) addEnd(fb.corner(i), a0, a, 1 - share_a);
}

void share(const FlatFacet& fa, const FlatFacet& fb, double tolerance, double size, Shared& out) {
  if (fa.count == 1) return out.add(fa.corner(0).x, fa.corner(0).feature);
  if (fb.count == 1) return out.add(fb.corner(0).x, fb.corner(0).feature);
  if (fa.count == 2 && fb.count == 2) return overlapSegments(fa, fb, tolerance, size, out);
  if (fb.count > 2) return clipFacet(fa, fb, false, tolerance, out);
  clipFacet(fb, fa, true, tolerance, out);
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

  void measure(const Shared& shared, const Surfaces& surfaces) {
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

// Where what faces the end of a cylinder comes near the rim between two of its corners, one more is added.
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
    if (q.squaredNorm() < nearest.squaredNorm()) nearest = q;
  }
  addRimCorner(nearest, end);
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
  Shared shared;
  Heights heights;
  bool found = false, exactly = false;
  for (double slack = kSamePlace; slack < 2e-4 && !found;
       slack *= 10) {  // the direction may be right to round-off only
    shared.count = 0;
    share(fa, fb, slack * size, size, shared);
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
    const Corner& c = shared.corners[at];
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
