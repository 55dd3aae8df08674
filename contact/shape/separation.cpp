#include "contact/shape/separation.h"

#include <algorithm>
#include <limits>

#include "contact/shape/direction.h"

namespace pincer::contact {
namespace {

constexpr double kEqual = 1e-12;  // of the size: a gap must be larger by this to win over an earlier candidate

struct Kinks {
  std::array<Vec3, 2 * Strata::kMost> normals;
  std::array<Vec3, Strata::kMost> edges_a, edges_b;
  int normal_count = 0, edge_count_a = 0, edge_count_b = 0;
};

class Search {
 public:
  Search(const PosedSolid& a, const PosedSolid& b, double size)
      : a_(a), b_(b), same_(kEqual * size), round_(isRound(a.shape) || isRound(b.shape)) {}

  void start(const Vec3& n) { best_ = {n, gapAlong(a_, b_, n)}; }
  void run() {
    constexpr int kMostPasses = 3;  // each from what the last one found
    if (needsClimbing()) climb();   // from the start itself: the kinks may lead to another hill
    for (int pass = 0; pass < kMostPasses; ++pass) {
      const double before = best_.gap;
      tryKinks();
      if (needsClimbing()) climb();
      if (!(best_.gap > before)) break;
    }
  }
  // Deep overlap has many ways out, of which EPA may find a long one: the centres' and the axes' are tried as well.
  void tryAxes() {
    offerBoth(directionOf<Vec3>(a_.p - b_.p, Vec3::UnitZ()).n);
    for (int i = 0; i < 3; ++i) {
      offerBoth(a_.R.col(i));
      offerBoth(b_.R.col(i));
    }
  }
  void tryKinks() {
    const Kinks kinks = kinksNear(best_.n);
    for (int i = 0; i < kinks.normal_count; ++i) offer(kinks.normals[static_cast<std::size_t>(i)]);
    for (int i = 0; i < kinks.edge_count_a; ++i) {
      for (int j = 0; j < kinks.edge_count_b; ++j) {
        offerAcross(kinks.edges_a[static_cast<std::size_t>(i)], kinks.edges_b[static_cast<std::size_t>(j)]);
      }
    }
  }
  void climb() {
    const Kinks kinks = kinksNear(best_.n);
    climbFrom(best_.n, nullptr);
    for (int i = 0; i < kinks.edge_count_a; ++i) climbFrom(best_.n, &kinks.edges_a[static_cast<std::size_t>(i)]);
    for (int j = 0; j < kinks.edge_count_b; ++j) climbFrom(best_.n, &kinks.edges_b[static_cast<std::size_t>(j)]);
  }
  bool needsClimbing() const { return round_ || best_.gap > same_; }
  const Separation& best() const { return best_; }

 private:
  void offer(const Vec3& n) {
    const double gap = gapAlong(a_, b_, n);
    if (gap > best_.gap + same_) best_ = {n, gap};
  }

  void offerBoth(const Vec3& n) {
    offer(n);
    offer(-n);
  }

  void offerAcross(const Vec3& e, const Vec3& f) {
    constexpr double kParallel = 1e-6;  // sine
    const Vec3 n = e.cross(f);
    const double length = n.norm();
    if (length > kParallel) offer(n.dot(best_.n) < 0 ? Vec3(n / -length) : Vec3(n / length));
  }

  Kinks kinksNear(const Vec3& n) const {
    constexpr double kNear = 0.5;  // cosine
    Kinks kinks;
    Strata strata;
    const auto collect = [&](const PosedSolid& solid, double sign, std::array<Vec3, Strata::kMost>& edges, int& edge_count) {
      strataOf(solid.shape, solid.inwards(sign * n), strata);
      for (int i = 0; i < strata.normal_count; ++i) {
        const Vec3 normal = sign * solid.outwards(strata.normals[static_cast<std::size_t>(i)]);
        if (normal.dot(n) > kNear) kinks.normals[static_cast<std::size_t>(kinks.normal_count++)] = normal;
      }
      for (int i = 0; i < strata.edge_count; ++i) {
        const Vec3 edge = solid.outwards(strata.edges[static_cast<std::size_t>(i)]);
        if (std::abs(edge.dot(n)) < 1 - kNear) edges[static_cast<std::size_t>(edge_count++)] = edge;
      }
    };
    collect(b_, 1, kinks.edges_b, kinks.edge_count_b);
    collect(a_, -1, kinks.edges_a, kinks.edge_count_a);
    return kinks;
  }

  Mat3 bendAt(const PosedSolid& s, const Vec3& d) const {
    return isRound(s.shape) ? Mat3(s.R * bendOf(s.shape, s.inwards(d)) * s.R.transpose()) : Mat3(Mat3::Zero());
  }

  // Newton on the sphere (edge: null) or on the circle across an edge; leaves where the gap has no maximum of that kind.
  void climbFrom(Vec3 n, const Vec3* edge) {
    constexpr int kMostSteps = 12;
    constexpr double kSmallest = 1e-9, kLargest = 0.3;  // [rad]
    if (edge) n = (n - edge->dot(n) * *edge).normalized();
    double gap = gapAlong(a_, b_, n);
    for (int i = 0; i < kMostSteps; ++i) {
      const Vec3 step = newtonStep(n, gap, edge);
      const double length = step.norm();
      if (!(length > kSmallest)) break;
      Vec3 next = (n + std::min(1.0, kLargest / length) * step).normalized();
      double next_gap = gapAlong(a_, b_, next);
      for (int halving = 0; halving < 3 && !(next_gap > gap); ++halving) {
        next = (n + next).normalized();
        next_gap = gapAlong(a_, b_, next);
      }
      if (!(next_gap > gap)) break;
      n = next;
      gap = next_gap;
    }
    if (gap > best_.gap + same_) best_ = {n, gap};
  }

  // Zero where the gap isn't concave.
  Vec3 newtonStep(const Vec3& n, double gap, const Vec3* edge) const {
    const Vec3 g = a_.support(-n) - b_.support(n);
    const Mat3 H = bendAt(a_, -n) + bendAt(b_, n);
    if (edge) {
      const Vec3 w = edge->cross(n);
      const double curvature = w.dot(H * w) + gap;
      return curvature > 0 ? Vec3(g.dot(w) / curvature * w) : Vec3(Vec3::Zero());
    }
    const Mat3 F = frameFromNormal(n);
    const Vec2 gt(F.col(0).dot(g), F.col(1).dot(g));
    const double m00 = F.col(0).dot(H * F.col(0)) + gap, m01 = F.col(0).dot(H * F.col(1)), m11 = F.col(1).dot(H * F.col(1)) + gap;
    const double det = m00 * m11 - m01 * m01;
    if (!(det > 0 && m00 > 0)) return Vec3::Zero();
    return (m11 * gt.x() - m01 * gt.y()) / det * F.col(0) + (m00 * gt.y() - m01 * gt.x()) / det * F.col(1);
  }

  const PosedSolid& a_;
  const PosedSolid& b_;
  double same_;
  bool round_;
  Separation best_;
};

}  // namespace

double gapAlong(const PosedSolid& a, const PosedSolid& b, const Vec3& n) { return n.dot(a.support(-n)) - n.dot(b.support(n)); }

Separation separate(const PosedSolid& a, const PosedSolid& b, double size) {
  constexpr double kApart = 1e-5, kOverlap = 1e-4;  // of the size, see the header
  Search search(a, b, size);
  const DirectionGuess first = guessDirection(a, b, size, Guess::kInset);
  search.start(first.found ? first.n : directionOf<Vec3>(a.p - b.p, Vec3::UnitZ()).n);
  if (!first.found) search.tryAxes();
  search.run();
  const double gap = search.best().gap;
  if (gap < kApart * size && gap > -kOverlap * size) return search.best();
  const DirectionGuess second = guessDirection(a, b, size, gap > 0 ? Guess::kApart : Guess::kOverlap);
  if (!second.found) return search.best();
  Search again(a, b, size);
  again.start(second.n);
  again.run();
  return again.best().gap > gap ? again.best() : search.best();
}

// Half widths along each axis are sums of |R_ij| half_j; edges nearly parallel add no direction of their own.
Separation separateBoxes(const PosedSolid& a, const PosedSolid& b) {
  constexpr double kParallel = 1e-6;  // sine
  constexpr double kBetter = 1e-9;    // of the size: faces win over edges that are no further apart
  const Vec3 half_a = std::get<Box>(a.shape).half, half_b = std::get<Box>(b.shape).half;
  const Vec3 d = a.p - b.p;
  const Mat3 C = a.R.transpose() * b.R;
  const Mat3 absC = C.cwiseAbs();
  const Vec3 d_a = a.inwards(d), d_b = b.inwards(d);
  Separation best;
  best.gap = -std::numeric_limits<double>::infinity();
  const double tolerance = kBetter * (half_a.maxCoeff() + half_b.maxCoeff());
  const auto offer = [&](const Vec3& n, double along, double gap) {
    if (gap > best.gap + tolerance) best = {along < 0 ? Vec3(-n) : n, gap};
  };
  for (int i = 0; i < 3; ++i) offer(b.R.col(i), d_b[i], std::abs(d_b[i]) - half_b[i] - absC.col(i).dot(half_a));
  for (int i = 0; i < 3; ++i) offer(a.R.col(i), d_a[i], std::abs(d_a[i]) - half_a[i] - absC.row(i).dot(half_b));
  for (int i = 0; i < 3; ++i) {
    const int i1 = (i + 1) % 3, i2 = (i + 2) % 3;
    for (int j = 0; j < 3; ++j) {
      const int j1 = (j + 1) % 3, j2 = (j + 2) % 3;
      const double sine2 = C(i1, j) * C(i1, j) + C(i2, j) * C(i2, j);
      if (!(sine2 > kParallel * kParallel)) continue;
      const double along = C(i1, j) * d_a[i2] - C(i2, j) * d_a[i1];  // (a_i x b_j) . d
      const double reach = half_a[i1] * absC(i2, j) + half_a[i2] * absC(i1, j) + half_b[j1] * absC(i, j2) + half_b[j2] * absC(i, j1);
      const double sine = std::sqrt(sine2);
      const double gap = (std::abs(along) - reach) / sine;
      if (gap > best.gap + tolerance) offer(a.R.col(i).cross(b.R.col(j)).normalized(), along, gap);
    }
  }
  return best;
}

}  // namespace pincer::contact
