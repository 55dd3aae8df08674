#include "pincer/contact/shape/core_distance.h"

#include <algorithm>
#include <limits>

#include "pincer/contact/functions/invariants.h"
#include "pincer/contact/shape/tolerances.h"

namespace pincer::contact {
namespace {

// Up to four points of A - B; after nearest(), those of the smallest face that holds the point nearest to the origin.
class DifferenceSimplex {
 public:
  bool has(const Vec3& w) const {
    for (int i = 0; i < count_; ++i) {
      if (at(i) == w) return true;
    }
    return false;
  }
  void add(const Vec3& w) { points_[static_cast<std::size_t>(count_++)] = w; }
  bool holdsOrigin() const { return count_ == 4; }

  // Radius of the disc about the point nearest to the origin that the triangle holds; 0 of less than a triangle.
  double around() const {
    if (count_ != 3) return 0;
    const Vec3 n = (at(1) - at(0)).cross(at(2) - at(0)).normalized();
    double least = std::numeric_limits<double>::infinity();
    for (int i = 0; i < 3; ++i) {
      const Vec3 side = at((i + 1) % 3) - at(i);
      least = std::min(least, n.cross(side).dot(-at(i)) / side.norm());
    }
    return std::max(least, 0.0);
  }

  Vec3 nearest() {
    if (count_ == 1) return at(0);
    const Face face = count_ == 2 ? ofSegment(0, 1) : count_ == 3 ? ofTriangle(0, 1, 2) : ofTetrahedron();
    if (face.count == 4) return Vec3::Zero();
    const std::array<Vec3, 4> all = points_;
    count_ = face.count;
    for (int i = 0; i < count_; ++i)
      points_[static_cast<std::size_t>(i)] = all[static_cast<std::size_t>(face.corners[static_cast<std::size_t>(i)])];
    return face.v;
  }

 private:
  struct Face {
    Vec3 v;
    std::array<int, 4> corners;
    int count;
  };
  const Vec3& at(int i) const { return points_[static_cast<std::size_t>(i)]; }

  Face ofSegment(int i, int j) const {
    const Vec3 &a = at(i), e = at(j) - a;
    const double along = -a.dot(e), all = e.squaredNorm();
    if (!(along > 0)) return {a, {i}, 1};
    if (along >= all) return {at(j), {j}, 1};
    const Vec3 v = a + along / all * e;
    return {v - v.dot(e) / all * e, {i, j}, 2};
  }

  static const Face& nearer(const Face& x, const Face& y) { return y.v.squaredNorm() < x.v.squaredNorm() ? y : x; }

  Face ofTriangle(int i, int j, int k) const {
    const Vec3 &a = at(i), &b = at(j), &c = at(k);
    const Vec3 n = (b - a).cross(c - a);
    const double area2 = n.squaredNorm();
    const bool in_ab = n.dot((b - a).cross(-a)) > 0, in_bc = n.dot((c - b).cross(-b)) > 0,
               in_ca = n.dot((a - c).cross(-c)) > 0;
    if (area2 > 0 && in_ab && in_bc && in_ca) return {a.dot(n) / area2 * n, {i, j, k}, 3};
    Face best{Vec3::Constant(std::numeric_limits<double>::infinity()), {}, 0};
    if (!in_ab || !(area2 > 0)) best = nearer(best, ofSegment(i, j));
    if (!in_bc || !(area2 > 0)) best = nearer(best, ofSegment(j, k));
    if (!in_ca || !(area2 > 0)) best = nearer(best, ofSegment(k, i));
    return best;
  }

  // The newest point, 3, is always part of the answer: without it the others were nearest already.
  Face ofTetrahedron() const {
    const Vec3& d = at(3);
    Face best{Vec3::Constant(std::numeric_limits<double>::infinity()), {}, 0};
    constexpr std::array<std::array<int, 3>, 3> faces = {{{0, 1, 2}, {1, 2, 0}, {2, 0, 1}}};
    for (const auto& [i, j, opposite] : faces) {
      const Vec3 n = (at(i) - d).cross(at(j) - d);
      const double side = n.dot(at(opposite) - d);
      if (side == 0 || side * n.dot(-d) <= 0) best = nearer(best, ofTriangle(i, j, 3));
    }
    if (best.count == 0) best = {Vec3::Zero(), {0, 1, 2, 3}, 4};
    return best;
  }

  std::array<Vec3, 4> points_;
  int count_ = 0;
};

// `furthest`: the point of A - B that is furthest against a direction.
template <class Furthest>
CoreDistance nearestToOrigin(Furthest furthest, const Vec3& start, double size, const CoreAccuracy& accuracy) {
  constexpr int kMostSteps = 60;  // of GJK
  DifferenceSimplex simplex;
  Vec3 v = start;
  double length2 = std::numeric_limits<double>::infinity();
  for (int step = 0; step < kMostSteps; ++step) {
    const Vec3 w = furthest(v);
    const double along = v.dot(w);
    if (step > 0) {
      const double length = std::sqrt(length2);
      if (simplex.has(w) || length2 - along <= (accuracy.relative * length + accuracy.absolute) * length ||
          along > accuracy.reach * length)
        break;
    }
    simplex.add(w);
    const Vec3 next = simplex.nearest();
    const double next2 = next.squaredNorm();
    if (simplex.holdsOrigin() || next2 <= kGapRounding * kGapRounding * size * size) return {};
    if (!(next2 < length2)) break;
    v = next;
    length2 = next2;
  }
  return {v, true, simplex.around()};
}

}  // namespace

CoreDistance distanceOfCores(const PosedSolid& a, const PosedSolid& b, const Vec3& shift, const Vec3& start,
                             double size, const CoreAccuracy& accuracy) {
  PINCER_ASSERT(size > 0 && accuracy.relative > 0);
  return nearestToOrigin([&](const Vec3& v) -> Vec3 { return a.support(-v) + shift - b.support(v); }, start, size,
                         accuracy);
}

CoreDistance distanceOfInsets(const PosedSolid& a, const PosedSolid& b, const Vec3& start, double size) {
  return nearestToOrigin([&](const Vec3& v) -> Vec3 { return a.inset(-v) - b.inset(v); }, start, size, {1e-6});
}

}  // namespace pincer::contact
