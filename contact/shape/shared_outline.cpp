#include "pincer/contact/shape/shared_outline.h"

#include <algorithm>

#include "pincer/contact/functions/invariants.h"
#include "pincer/contact/shape/tolerances.h"

namespace pincer::contact {
namespace {

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
void clipFacet(const FlatFacet& facet, const FlatFacet& clipper, bool clipper_is_a, double tolerance,
               SharedOutline& out) {
  std::array<ClipPolygon, 2> polygons;
  ClipPolygon *from = &polygons[0], *to = &polygons[1];
  for (int i = 0; i < facet.count; ++i)
    from->add({facet.corner(i).x, facet.corner(i).feature, facet.corner(i).edge, -1});
  for (int j = 0; j < clipper.count && from->count > 0; ++j) {
    if (clipBy(clipper, j, clipper_is_a, tolerance, *from, *to)) std::swap(from, to);
  }
  for (int i = 0; i < from->count; ++i) {
    const ClipCorner& c = from->corners[static_cast<std::size_t>(i)];
    const auto isSame = [&](const SharedCorner& other) {
      return other.feature == c.feature || (other.x - c.x).squaredNorm() <= tolerance * tolerance;
    };
    if (std::none_of(out.corners.begin(), out.corners.begin() + out.count, isSame)) out.add(c.x, c.feature);
  }
}

bool isOnePoint(const Vec2& x, const Vec2& y, double size) { return (x - y).norm() <= kOnePoint * size; }

// True of two round walls, or of one and an edge, whose lines cross at so small an angle that they touch all along:
// there they are hardly nearer to each other than at the ends, and round-off would move the place from end to end.
//   radii  of both walls together [m]; 0: they don't
bool touchAllAlong(const Vec2& a, const Vec2& b, double radii, double size) {
  constexpr double kNearer = 1e-7;  // of the size
  const double aside = std::abs(cross(a, b)) / std::max(a.norm(), b.norm());
  return aside * aside < 2 * radii * kNearer * size;
}

// The part of segment f that lies over the segment g, measured along f: the ends of f or the feet of g's ends; and
// where they cross, without ends within kOnePoint of that: of two such now one, now the other would carry.
void overlapSegments(const FlatFacet& fa, const FlatFacet& fb, double tolerance, double size, SharedOutline& out) {
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
    const auto isSame = [&](const SharedCorner& other) { return isOnePoint(other.x, x, size); };
    if (std::none_of(out.corners.begin(), out.corners.begin() + out.count, isSame)) out.add(x, end.feature);
  };
  const double share_a = radii > 0 ? fa.line_radius / radii : 0.5;
  for (int i = 0; i < 2; ++i) addEnd(fa.corner(i), b0, b, share_a);
  for (int i = 0; i < 2; ++i) addEnd(fb.corner(i), a0, a, 1 - share_a);
}

// Where the line of a round wall leaves a polygon at a small angle to its edge, the rest of it lies beside the edge,
// hardly further away: the ends of that part, on the edge, and the crossing only where the two don't touch all along.
class BesideEdges {
 public:
  BesideEdges(const FlatFacet& polygon, bool polygon_is_a, const FlatFacet& line, double tolerance, double size,
              SharedOutline& out)
      : polygon_(polygon), line_(line), polygon_is_a_(polygon_is_a), tolerance_(tolerance), size_(size), out_(out) {}

  void add() {
    for (int j = 0; j < polygon_.count; ++j) {
      const EdgeLine edge(polygon_, j);
      if (polygon_.corner(j).is_straight && (leaves(edge, begin()) || leaves(edge, end())) && isAlong(edge))
        addAlong(edge, j);
    }
  }

 private:
  const Vec2& begin() const { return line_.corner(0).x; }
  const Vec2& end() const { return line_.corner(1).x; }
  Vec2 way() const { return end() - begin(); }

  bool isAlong(const EdgeLine& edge) const {
    return edge.length > 0 && std::abs(cross(edge.edge, way())) <= kNearlyParallelEdges * edge.length * way().norm();
  }
  bool leaves(const EdgeLine& edge, const Vec2& x) const { return edge.leftOf(x) < -tolerance_; }
  bool isBeside(const EdgeLine& edge, const Vec2& x) const {
    const double left = edge.leftOf(x);
    return left <= tolerance_ && left > -line_.line_radius;
  }
  std::uint32_t crossingOf(int edge) const {
    const std::uint32_t other = polygon_.corner(edge).edge, own = line_.corner(0).edge;
    return polygon_is_a_ ? featureOf(kCrossing, other, own) : featureOf(kCrossing, own, other);
  }

  void addAlong(const EdgeLine& edge, int j) {
    if (touchAllAlong(edge.edge, way(), line_.line_radius, size_)) out_.drop(crossingOf(j));
    for (int i = 0; i < 2; ++i) {
      const Vec2& x = line_.corner(i).x;
      const double at = (x - edge.from).dot(edge.edge) / (edge.length * edge.length);
      if (at >= 0 && at <= 1 && isBeside(edge, x)) addOnce(edge.from + at * edge.edge, line_.corner(i).feature);
    }
    const int before = (j + polygon_.count - 1) % polygon_.count, after = (j + 1) % polygon_.count;
    addCorner(edge, j, before);
    addCorner(edge, after, after);
  }
  // Named as if the line still crossed the polygon's next edge there.
  void addCorner(const EdgeLine& edge, int corner, int next) {
    const Vec2& x = polygon_.corner(corner).x;
    const double at = (x - begin()).dot(way()) / way().squaredNorm();
    if (at >= 0 && at <= 1 && isBeside(edge, begin() + at * way())) addOnce(x, crossingOf(next));
  }
  void addOnce(const Vec2& x, std::uint32_t feature) {
    const auto isSame = [&](const SharedCorner& c) { return c.feature == feature || isOnePoint(c.x, x, size_); };
    if (std::none_of(out_.corners.begin(), out_.corners.begin() + out_.count, isSame)) out_.add(x, feature);
  }

  const FlatFacet& polygon_;
  const FlatFacet& line_;
  bool polygon_is_a_;
  double tolerance_, size_;
  SharedOutline& out_;
};

}  // namespace

void shareOutline(const FlatFacet& fa, const FlatFacet& fb, double tolerance, double size, SharedOutline& out) {
  if (fa.count == 1) return out.add(fa.corner(0).x, fa.corner(0).feature);
  if (fb.count == 1) return out.add(fb.corner(0).x, fb.corner(0).feature);
  if (fa.count == 2 && fb.count == 2) return overlapSegments(fa, fb, tolerance, size, out);
  const bool b_clips = fb.count > 2;
  const FlatFacet &clipped = b_clips ? fa : fb, &clipper = b_clips ? fb : fa;
  clipFacet(clipped, clipper, !b_clips, tolerance, out);
  if (clipped.count == 2 && clipped.line_radius > 0)
    BesideEdges(clipper, !b_clips, clipped, tolerance, size, out).add();
}

}  // namespace pincer::contact
