#include "pincer/contact/shape/edge_on_solid.h"

#include <algorithm>

#include "pincer/contact/functions/invariants.h"

namespace pincer::contact {
namespace {

struct Looked {
  Vec3 n, b;      // a direction and the solid's furthest point along it
  double rising;  // derivative of gap as n turns towards n_hi [m]
};

class EdgeSearch {
 public:
  EdgeSearch(const Vec3& p, const Vec3& e, const PosedSolid& solid, double deepest)
      : p_(p), e_(e), solid_(solid), round_(isRound(solid.shape)), deepest_(deepest), tiny_(-1e-13 * deepest) {}

  EdgeContacts find(const Vec3& n_lo, const Vec3& n_hi) {
    const Looked lo = look(n_lo), hi = look(n_hi);
    const bool is_outside = lo.n.dot(p_ - lo.b) > 0 || hi.n.dot(p_ - hi.b) > 0;  // then there is one maximum only
    if (!is_outside || (lo.rising > 0 && hi.rising < 0)) explore(lo, hi, 0);
    return found_;
  }

 private:
  Looked look(const Vec3& n) const { return lookAt(n, solid_.support(n)); }
  Looked lookAt(const Vec3& n, const Vec3& b) const { return {n, b, e_.cross(n).dot(p_ - b)}; }

  void offer(const Vec3& n, const Vec3& b) {
    if (found_.count < EdgeContacts::kMost)
      found_.all[static_cast<std::size_t>(found_.count++)] = {n, b, n.dot(p_ - b)};
  }

  // No direction between the two has a greater gap: that of one point of the solid.
  double bound(const Looked& lo, const Looked& hi, const Vec3& b) const {
    const Looked at_lo = lookAt(lo.n, b), at_hi = lookAt(hi.n, b);
    const Vec3 v = p_ - b;
    if (at_lo.rising > 0 && at_hi.rising < 0) return (v - e_.dot(v) * e_).norm();
    return std::max(lo.n.dot(v), hi.n.dot(v));
  }

  void explore(const Looked& lo, const Looked& hi, int depth) {
    constexpr int kDeepest = 12;      // halvings of the arc of normals: to a 4096th
    constexpr double kNarrow = 0.05;  // [rad]
    if (std::min(bound(lo, hi, lo.b), bound(lo, hi, hi.b)) < deepest_) return;
    if (lo.b == hi.b) return exploreCorner(lo, hi);
    if (depth > kDeepest || (round_ && (hi.n - lo.n).squaredNorm() < kNarrow * kNarrow)) return close(lo, hi);
    const Looked c = look(chordNormal(lo, hi));
    if (c.n.dot(c.b - lo.b) > tiny_) {
      explore(lo, c, depth + 1);
      return explore(c, hi, depth + 1);
    }
    const Looked before = lookAt(c.n, lo.b), after = lookAt(c.n, hi.b);
    if (before.rising >= 0 && after.rising <= 0) return offerKink(before, after);
    exploreCorner(lo, before);
    exploreCorner(after, hi);
  }

  // Across the chord from one's point to the other's: between the two, or nearly so.
  Vec3 chordNormal(const Looked& lo, const Looked& hi) const {
    const Vec3 n = e_.cross(hi.b - lo.b), middle = lo.n + hi.n;
    const double length = n.norm();
    if (!(length > tiny_)) return middle.normalized();
    return n.dot(middle) < 0 ? Vec3(n / -length) : Vec3(n / length);
  }

  // The same point is furthest all the way: the greatest gap is that towards it.
  void exploreCorner(const Looked& lo, const Looked& hi) {
    if (!(lo.rising > 0 && hi.rising < 0)) return;
    Vec3 n = p_ - lo.b;
    n -= e_.dot(n) * e_;
    const double length = n.norm();
    if (length > tiny_ && n.dot(lo.n + hi.n) > 0) offer(n / length, lo.b);
  }

  void offerKink(const Looked& before, const Looked& after) {
    const double all = before.rising - after.rising;
    const double share = all > 0 ? std::clamp(before.rising / all, 0.0, 1.0) : 0.5;
    offer(before.n, before.b + share * (after.b - before.b));
  }

  // One maximum at most is left.
  void close(Looked lo, Looked hi) {
    constexpr int kMostSteps = 40;  // of bisection, to round-off
    if (!(lo.rising > 0 && hi.rising < 0)) return;
    for (int i = 0; i < kMostSteps && (lo.n - hi.n).squaredNorm() > 1e-24; ++i) {
      const Looked c = look(chordNormal(lo, hi));
      if (!(c.n.dot(c.b - lo.b) > tiny_)) {
        const Looked before = lookAt(c.n, lo.b), after = lookAt(c.n, hi.b);
        if (before.rising >= 0 && after.rising <= 0) return offerKink(before, after);
      }
      (c.rising > 0 ? lo : hi) = c;
      const double share = lo.rising / (lo.rising - hi.rising);
      const Looked d = look(((1 - share) * lo.n + share * hi.n).normalized());
      (d.rising > 0 ? lo : hi) = d;
    }
    const Vec3 n = (lo.n + hi.n).normalized();
    offerKink(lookAt(n, lo.b), lookAt(n, hi.b));
  }

  Vec3 p_, e_;
  const PosedSolid& solid_;
  bool round_;
  double deepest_, tiny_;
  EdgeContacts found_;
};

}  // namespace

EdgeContacts edgeOnSolid(const Vec3& p, const Vec3& e, const Vec3& n_lo, const Vec3& n_hi, const PosedSolid& solid,
                         double deepest) {
  PINCER_ASSERT(isUnitIfFinite(e) && isUnitIfFinite(n_lo) && isUnitIfFinite(n_hi));
  PINCER_ASSERT(deepest < 0);
  return EdgeSearch(p, n_lo.cross(n_hi).dot(e) < 0 ? Vec3(-e) : e, solid, deepest).find(n_lo, n_hi);
}

}  // namespace pincer::contact
