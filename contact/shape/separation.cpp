#include "pincer/contact/shape/separation.h"

#include <algorithm>
#include <limits>

#include "pincer/contact/functions/invariants.h"
#include "pincer/contact/shape/core_distance.h"
#include "pincer/contact/shape/direction.h"
#include "pincer/contact/shape/tolerances.h"

namespace pincer::contact {
namespace {

constexpr double kTrustedGap = 1e-8;  // of the size: solids that are apart by more have nearest points to trust
// the same for round ones, whose nearest points take the more steps the nearer they are
constexpr double kTrustedRound = 1e-3;
constexpr double kMovedApart = 1e-2;  // of the size

// Kinks of gap: normals of faces, edges.
struct Kinks {
  std::array<Vec3, 2 * Strata::kMost> normals;
  std::array<Vec3, Strata::kMost> edges_a, edges_b;
  int normal_count = 0, edge_count_a = 0, edge_count_b = 0;
};

class Search {
 public:
  Search(const PosedSolid& a, const PosedSolid& b, double size)
      : a_(a), b_(b), size_(size), round_(isRound(a.shape) || isRound(b.shape)) {}

  const Separation& best() const { return best_; }
  bool isApart() const { return best_.gap > (round_ ? kTrustedRound : kTrustedGap) * size_; }

  void offer(const Vec3& n) {
    const double gap = gapAlong(a_, b_, n);
    if (gap > best_.gap) best_ = {n, gap};
  }
  // True if the normal of a face that is near `n` is the best of all: what lies on a face is known from four points.
  bool isOnFaceNear(const Vec3& n) {
    const Kinks kinks = kinksNear(n, kNear, 0);
    for (int i = 0; i < kinks.normal_count; ++i) offer(kinks.normals[static_cast<std::size_t>(i)]);
    if (kinks.normal_count == 0) return false;
    lookAtFaces();
    if (!isProved()) lookAround();
    if (isProved() && isOnlyOne()) return true;
    seen_ = {};
    return false;
  }
  void tryNearestPoints(const Vec3& start, double reach) {
    const CoreAccuracy accuracy{kRelative, round_ ? kAbsolute * size_ : 0, reach};
    const CoreDistance d = distanceOfCores(a_, b_, Vec3::Zero(), start, size_, accuracy);
    if (!d.apart) return;
    seen_ = {d.around, d.v.norm()};
    offer(d.v.normalized());
  }
  // The greatest gap around `n`, if it is greater than what is known.
  void climb(const Vec3& n) {
    const Separation known = best_;
    const SeenDisc known_disc = seen_;
    best_ = {n, gapAlong(a_, b_, n)};
    seen_ = {};
    improve();
    if (best_.gap > known.gap - kGapRounding * size_) return;
    best_ = known;
    seen_ = known_disc;
  }
  void tryWaysOut() {
    Search axes(a_, b_, size_);
    axes.offerBoth(directionOf<Vec3>(a_.p - b_.p, Vec3::UnitZ()).n);
    for (int i = 0; i < 3; ++i) {
      axes.offerBoth(a_.R.col(i));
      axes.offerBoth(b_.R.col(i));
    }
    climb(axes.best_.n);
    if (isOnlyOne()) return;
    Search edges(a_, b_, size_);
    for (int i = 0; i < 3; ++i) {
      for (int j = 0; j < 3; ++j) edges.offerBoth(directionOf<Vec3>(a_.R.col(i).cross(b_.R.col(j)), a_.R.col(i)).n);
    }
    climb(edges.best_.n);
    const CoreDistance inner = distanceOfInsets(a_, b_, best_.n, size_);
    if (inner.apart) climb(inner.v.normalized());
    if (isOnlyOne()) return;
    const DirectionGuess way_out = guessWayOut(a_, b_, size_);
    if (way_out.found) climb(way_out.n);
  }
  // True if no other direction can have a greater gap than the best, see separation.h.
  bool isOnlyOne() const {
    constexpr double kSamePlane = 1e-8;  // of the size
    const double depth = -best_.gap;
    if (!(depth > 4 * kGapRounding * size_)) return true;
    if (!(seen_.radius > kWider * depth && best_.gap > seen_.gap - kSamePlane * size_)) return false;
    const Vec3 far = a_.support(best_.n) - b_.support(-best_.n);
    return best_.n.dot(far) > depth + 2 * depth / seen_.radius * far.norm();
  }
  // The search that the nearest points leave to be done.
  void finish() {
    if (!isProvedOnFace() && round_) polish();
  }

 private:
  static constexpr double kRelative = 1e-9;   // of the distance
  static constexpr double kAbsolute = 1e-12;  // of the size
  static constexpr double kLargest = 0.1;     // step of Newton's method [rad]
  static constexpr double kBeside = 1e-4;     // of a kink [rad]
  static constexpr double kNear = 0.02;       // kinks to be looked at [rad]
  static constexpr double kWider = 4;         // than the overlap is deep: a disc that proves something

  // A disc in A - B about the point below the origin, across the way out [m]: no direction within 90 degrees of its
  // normal has a greater gap than its own, if it is wide enough.
  struct SeenDisc {
    double radius = 0, gap = -std::numeric_limits<double>::infinity();
  };

  void improve() {
    constexpr int kMostSteps = 12;     // of GJK, each from the best direction so far
    constexpr double kRoughly = 1e-6;  // of the size: Newton's method does the rest
    for (int i = 0; i < kMostSteps && !isApart(); ++i) {
      const Vec3 shift = (kMovedApart * size_ - best_.gap) * best_.n;
      const CoreDistance d = distanceOfCores(a_, b_, shift, best_.n, size_, {round_ ? 1e-7 : kRelative});
      if (!d.apart) break;
      const Vec3 n = d.v.normalized();
      seen_ = {d.around - (shift - n.dot(shift) * n).norm(), d.v.norm() - n.dot(shift)};
      const double before = best_.gap;
      offer(n);
      if (!(best_.gap > before + (round_ ? kRoughly : kGapRounding) * size_)) break;
    }
    if (isProvedOnFace()) return;
    if (best_.gap > 0) tryNearestPoints(best_.n, kInfinity);
    finish();
  }
  bool isProvedOnFace() {
    snapToFaces();
    if (!isProved()) lookAround();
    return isProved();
  }
  // The disc about the foot of the one solid's deepest corner within the other's face: A - B has the face there, moved
  // by the corner. Half of what lookAround costs, for faces with corners whose normal is the best direction.
  void lookAtFaces() {
    lookAtFace(b_, best_.n, a_.support(-best_.n));
    if (!isProved()) lookAtFace(a_, -best_.n, b_.support(best_.n));
  }
  void lookAtFace(const PosedSolid& solid, const Vec3& d, const Vec3& corner) {
    Facet facet;
    facetOf(solid.shape, solid.inwards(d), facet);
    if (facet.count < 3 || facet.rim_radius > 0) return;
    const Vec3 n = solid.inwards(d);
    if ((facet.n - n).squaredNorm() > kOneNormal * kOneNormal) return;
    const Vec3 p = solid.inwards(corner - solid.p);
    double radius = kInfinity;
    for (int i = 0; i < facet.count; ++i) {
      const Vec3& from = facet.corners[static_cast<std::size_t>(i)].p;
      const Vec3 side = facet.corners[static_cast<std::size_t>(i + 1 < facet.count ? i + 1 : 0)].p - from;
      radius = std::min(radius, n.dot(side.cross(p - from)) / side.norm());
    }
    if (radius > seen_.radius) seen_ = {radius, best_.gap};
  }
  // The disc that four points of A - B span in the plane across the best direction,
  // furthest along four directions in that plane.
  void lookAround() {
    constexpr double kTurn = 1e-11;  // towards each [rad]
    // off the axes of the frame, along which edges often lie
    constexpr double kCosine = 0.92, kSine = 0.39191835884530846;
    const Mat3 F = frameFromNormal(best_.n);
    std::array<Vec2, 4> corners;
    Vec2 towards(kCosine, kSine);
    for (Vec2& corner : corners) {
      const Vec3 d = best_.n - kTurn * (towards.x() * F.col(0) + towards.y() * F.col(1));
      const Vec3 p = a_.support(-d) - b_.support(d);
      if (best_.n.dot(p) > best_.gap + kOutOfPlane * size_) return;
      corner = {F.col(0).dot(p), F.col(1).dot(p)};
      towards = {-towards.y(), towards.x()};
    }
    double radius = std::numeric_limits<double>::infinity();
    for (std::size_t i = 0; i < corners.size(); ++i) {
      const Vec2 side = corners[(i + 1) % corners.size()] - corners[i];
      const double length = side.norm();
      if (length > kOutOfPlane * size_) radius = std::min(radius, cross(corners[i], side) / length);
    }
    if (std::isfinite(radius) && radius > seen_.radius) seen_ = {radius, best_.gap};
  }
  // True if the disc shows that nothing around the best is better by more than round-off.
  bool isProved() const {
    return seen_.radius > kWider * std::max(-best_.gap, 0.0) && best_.gap > seen_.gap - 4 * kGapRounding * size_;
  }

  void offerBoth(const Vec3& n) {
    offer(n);
    offer(-n);
  }

  // Wins over a direction that is better by round-off only: what lies flat on a
  // face has the face's normal, to the last bit.
  void prefer(const Vec3& n) {
    const double gap = gapAlong(a_, b_, n);
    if (gap > best_.gap - kGapRounding * size_) best_ = {n, gap};
  }

  void snapToFaces() {
    const Kinks kinks = kinksNear(best_.n, kBeside, 0);
    for (int i = 0; i < kinks.normal_count; ++i) prefer(kinks.normals[static_cast<std::size_t>(i)]);
  }

  // Again where that leads away: of a corner that all but meets a rim the gap hardly changes over most
  // of a quarter turn, to a kink at its end.
  void polish() {
    constexpr int kMostRounds = 4;  // of ascents from the best direction so far
    for (int i = 0; i < kMostRounds; ++i) {
      const Vec3 n = best_.n;
      polishAround();
      if ((best_.n - n).squaredNorm() < kNear * kNear) return;
    }
  }
  void polishAround() {
    const Kinks kinks = kinksNear(best_.n, kNear, kNear);
    for (int i = 0; i < kinks.normal_count; ++i) prefer(kinks.normals[static_cast<std::size_t>(i)]);
    // where two corners are nearest
    if (best_.gap > 0) offer(directionOf<Vec3>(a_.support(-best_.n) - b_.support(best_.n), best_.n).n);
    climbFrom(best_.n, nullptr);
    for (int i = 0; i < kinks.edge_count_a; ++i) climbBeside(kinks.edges_a[static_cast<std::size_t>(i)]);
    for (int j = 0; j < kinks.edge_count_b; ++j) climbBeside(kinks.edges_b[static_cast<std::size_t>(j)]);
    for (int i = 0; i < kinks.edge_count_a; ++i) {
      for (int j = 0; j < kinks.edge_count_b; ++j) {
        preferAcross(kinks.edges_a[static_cast<std::size_t>(i)], kinks.edges_b[static_cast<std::size_t>(j)]);
      }
    }
  }

  // On the circle across an edge, and to both sides of it, where one or the other end of the edge decides.
  void climbBeside(const Vec3& edge) {
    climbFrom(best_.n, &edge);
    const Vec3 n = best_.n;
    for (const double side : {-kBeside, kBeside}) climbFrom((n + side * edge).normalized(), nullptr);
  }

  void preferAcross(const Vec3& e, const Vec3& f) {
    const Vec3 n = e.cross(f);
    const double length = n.norm();
    if (length > kNoAngle) prefer(n.dot(best_.n) < 0 ? Vec3(n / -length) : Vec3(n / length));
  }

  // Faces whose normal, and edges whose circle is within these angles of n [rad].
  Kinks kinksNear(const Vec3& n, double to_normal, double to_circle) const {
    Kinks kinks;
    Strata strata;
    strata.with_edges = to_circle > 0;
    const auto collect = [&](const PosedSolid& solid, double sign, std::array<Vec3, Strata::kMost>& edges,
                             int& edge_count) {
      strataOf(solid.shape, solid.inwards(sign * n), strata);
      for (int i = 0; i < strata.normal_count; ++i) {
        const Vec3 normal = sign * solid.outwards(strata.normals[static_cast<std::size_t>(i)]);
        if ((normal - n).squaredNorm() < to_normal * to_normal)
          kinks.normals[static_cast<std::size_t>(kinks.normal_count++)] = normal;
      }
      for (int i = 0; i < strata.edge_count; ++i) {
        const Vec3 edge = solid.outwards(strata.edges[static_cast<std::size_t>(i)]);
        if (std::abs(edge.dot(n)) < to_circle) edges[static_cast<std::size_t>(edge_count++)] = edge;
      }
    };
    collect(b_, 1, kinks.edges_b, kinks.edge_count_b);
    collect(a_, -1, kinks.edges_a, kinks.edge_count_a);
    return kinks;
  }

  Mat3 bendAt(const PosedSolid& s, const Vec3& d) const {
    return isRound(s.shape) ? Mat3(s.R * bendOf(s.shape, s.inwards(d)) * s.R.transpose()) : Mat3(Mat3::Zero());
  }

  // Newton on the sphere (edge: null) or on the circle across an edge; leaves where the gap has no maximum of that
  // kind. The gap tells the direction to the root of round-off only, so that the last steps are judged by their length.
  void climbFrom(Vec3 n, const Vec3* edge) {
    constexpr int kMostSteps = 20, kMostHalvings = 6;  // of Newton; of a step that doesn't climb
    constexpr double kSmallest = 1e-14;                // [rad]
    if (edge) n = (n - edge->dot(n) * *edge).normalized();
    double gap = gapAlong(a_, b_, n);
    double last = std::numeric_limits<double>::infinity(), before = -last;
    for (int i = 0; i < kMostSteps; ++i) {
      const Vec3 step = newtonStep(n, gap, edge);
      const double length = step.norm();
      if (!(length > kSmallest && (length < 0.9 * last || gap > before))) break;
      Vec3 next = (n + std::min(1.0, kLargest / length) * step).normalized();
      double next_gap = gapAlong(a_, b_, next);
      for (int halving = 0; halving < kMostHalvings && next_gap < gap - kGapRounding * size_; ++halving) {
        next = (n + next).normalized();
        next_gap = gapAlong(a_, b_, next);
      }
      if (!(next_gap > gap - kGapRounding * size_)) break;
      n = next;
      before = gap + kGapRounding * size_;
      gap = next_gap;
      last = length;
    }
    if (gap > best_.gap - kGapRounding * size_) best_ = {n, gap};
  }

  // Where the gap isn't concave, as far uphill as one goes at most.
  Vec3 newtonStep(const Vec3& n, double gap, const Vec3* edge) const {
    const Vec3 g = a_.support(-n) - b_.support(n);
    const Mat3 H = bendAt(a_, -n) + bendAt(b_, n);
    if (edge) {
      const Vec3 w = edge->cross(n);
      const double curvature = w.dot(H * w) + gap;
      return curvature > 0 ? Vec3(g.dot(w) / curvature * w) : Vec3(kLargest * signOf(g.dot(w)) * w);
    }
    const Mat3 F = frameFromNormal(n);
    const Vec2 gt(F.col(0).dot(g), F.col(1).dot(g));
    const double m00 = F.col(0).dot(H * F.col(0)) + gap, m01 = F.col(0).dot(H * F.col(1)),
                 m11 = F.col(1).dot(H * F.col(1)) + gap;
    const double det = m00 * m11 - m01 * m01;
    const Vec2 step = det > 0 && m00 > 0 ? Vec2(m11 * gt.x() - m01 * gt.y(), m00 * gt.y() - m01 * gt.x()) / det
                                         : stepUphill(m00, m01, m11, gt);
    return F.leftCols<2>() * step;
  }

  // Newton's step along the directions in which the gap is concave, as far uphill as one goes at most along the others:
  // along the first it may be narrow as a rim's bend, and nearly flat along the other.
  static Vec2 stepUphill(double m00, double m01, double m11, const Vec2& g) {
    const double mean = 0.5 * (m00 + m11), half = 0.5 * (m00 - m11), root = std::sqrt(half * half + m01 * m01);
    const Vec2 v = directionOf<Vec2>(half > 0 ? Vec2(half + root, m01) : Vec2(m01, root - half), Vec2::UnitX()).n;
    Vec2 step = Vec2::Zero();
    const auto add = [&](const Vec2& axis, double curvature) {
      const double rise = axis.dot(g);
      if (rise != 0) step += (curvature > 0 ? rise / curvature : kLargest * signOf(rise)) * axis;
    };
    add(v, mean + root);
    add({-v.y(), v.x()}, mean - root);
    return step;
  }

  const PosedSolid& a_;
  const PosedSolid& b_;
  double size_;
  bool round_;
  Separation best_{Vec3::UnitZ(), -std::numeric_limits<double>::infinity()};
  SeenDisc seen_;
};

}  // namespace

double gapAlong(const PosedSolid& a, const PosedSolid& b, const Vec3& n) {
  PINCER_ASSERT(isUnitIfFinite(n));
  return n.dot(a.support(-n)) - n.dot(b.support(n));
}

Separation separate(const PosedSolid& a, const PosedSolid& b, double size, double reach, const Vec3& last) {
  Search search(a, b, size);
  const bool warm = last != Vec3::Zero();
  if (warm && search.isOnFaceNear(last)) return search.best();
  if (warm) search.offer(last);
  if (search.best().gap >= reach) return search.best();
  if (!warm || search.isApart()) {
    search.tryNearestPoints(warm ? last : directionOf<Vec3>(a.p - b.p, Vec3::UnitZ()).n, reach);
    if (search.best().gap >= reach) return search.best();
    if (search.isApart()) {
      search.finish();
      return search.best();
    }
  }
  if (search.best().gap > -std::numeric_limits<double>::infinity()) search.climb(search.best().n);
  if (!search.isOnlyOne()) search.tryWaysOut();
  return search.best();
}

}  // namespace pincer::contact
