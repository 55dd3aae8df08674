// point_choice: up to four of a solid's extreme points, those that carry it on a
// support now or will first when it rocks.
//
// Up to four points within the margin are all kept. Of more, first the deepest; then, again and again, that outside the
// polygon of those already kept which has the
//
//   largest  d^2 / (g + s)     d  how far the point is outside that polygon, seen
//                                 along the normal n at the first point [m]
//                              g  its gap less the deepest's [m], s = 1 um the difference that counts as none
//
// d^2 / 2 g is the radius on which the solid would roll onto that point: flat comes before round. A body at rest keeps
// the corners of the facet that it rests on, even where they are close together, and corners that are open join where
// these leave room. Among equally deep ones the widest spread wins. (Rejected: d - 2 g takes far, open corners in
// place of near, carrying ones, and the body falls from one set of corners to the next for ever; d / (g + s) favours
// the low side of a tilted face so much that its far side is missing when it lands. Six or eight points: meshes came
// to rest no sooner, and the solver paid.) A score must be better by a hundredth to win over a smaller feature, twice
// as good to win over a point that was kept in the last tick, a hundred times over one that carried; that is also the
// first among the deepest to within s: a body that rests or rocks by less than s keeps its points, and so its impulses.
// (Without that a cube on a cube, whose faces share eight corners, went from one four of them to another and back,
// which moved the gaps that chose them, for ever; and where an open corner was twice as good as the one that carried
// most, a box sank into that by 2 um, was pushed out, and so on.) Cost: one scan over all points and four over those
// within the margin, where
//
//   d <= |p - p_k| + s   for each chosen p_k: none is further than s outside an edge
//
// A point that couldn't win even so far outside is passed by: its edges aren't looked at.
// More than 1024 of these are not listed (no memory is allocated) but found again by each scan.
#pragma once
#include <algorithm>
#include <array>
#include <limits>

#include "pincer/contact/assert.h"
#include "pincer/contact/pair_query.h"
#include "pincer/contact/shape/direction.h"
#include "pincer/contact/shape/extreme_points.h"
#include "pincer/contact/shape/tolerances.h"

namespace pincer::contact {

constexpr int kMaxChosen = 4;  // more bring no rest, but cost the solver, see above

// By how much a point's score counts more for what it did in the last tick.
inline double favourOf(const LastPoints& last, std::uint32_t feature) {
  const LastPoints::Role role = last.roleOf(feature);
  return role == LastPoints::Role::kCarried ? kCarries : role == LastPoints::Role::kKept ? kStays : 1;
}

struct Chosen {
  int index;   // of the extreme point
  double gap;  // [m]
};

template <class Support>
class PointChoice {
 public:
  PointChoice(const ExtremePoints& solid, const Support& support, double margin, const LastPoints& last)
      : solid_(solid), support_(support), margin_(margin), last_(last) {
    listNear();
    near_count_ <= kMaxChosen ? keepAll() : keepBest();
  }

  int count() const { return count_; }
  const Chosen& operator[](int i) const { return chosen_[i]; }  // by ascending index

 private:
  static constexpr int kListed = 1024;  // chosen, 24 KB; more points are found again by each scan

  struct Near : Chosen {
    double reach2;  // no less than the square of d [m^2]
    double favour;  // times its score
  };

  // From a chosen point to another, none to the right of it; two points have two edges, there and back.
  struct Edge {
    Vec3 right_A;  // unit vector across the edge and the normal; zero where both ends lie on one normal
    double offset;

    double distance(const Vec3& p) const { return right_A.dot(p) - offset; }  // [m]
  };
  static constexpr int kMaxEdges = (kMaxChosen - 1) * (kMaxChosen - 2);  // between all but the last, there and back

  double gapOf(int i) const { return support_.gap(solid_.points[i]) - solid_.rounding; }
  Near near(int i, double gap) const { return {{i, gap}, kInfinity, favourOf(last_, solid_.featureOf(i))}; }
  int candidates() const { return static_cast<int>(solid_.points.size()); }
  const Vec3& chosenPoint(int i) const { return solid_.points[chosen_[i].index]; }
  template <class Predicate>
  bool anyChosen(Predicate is) const {
    return std::any_of(chosen_.begin(), chosen_.begin() + count_, is);
  }

  // True of all points within the margin, and of few others.
  auto sieve() const {
    if constexpr (requires { support_.sieve(margin_); })
      return support_.sieve(margin_ + solid_.rounding);
    else
      return [](const Vec3&) { return true; };
  }

  void listNear() {
    const auto may_be_near = sieve();
    for (int i = 0; i < candidates(); ++i) {
      if (!may_be_near(solid_.points[i])) continue;
      const double gap = gapOf(i);
      if (!(gap < margin_)) continue;
      if (near_count_ < kListed) near_[near_count_] = near(i, gap);
      ++near_count_;
      deepest_ = std::min(deepest_, gap);
    }
  }

  template <class Visit>
  void forEachNear(Visit visit) {
    if (near_count_ <= kListed)
      return static_cast<void>(std::for_each(near_.begin(), near_.begin() + near_count_, visit));
    for (int i = 0; i < candidates(); ++i) {
      Near found = near(i, gapOf(i));
      if (found.gap < margin_) visit(found);
    }
  }

  void keepAll() {
    count_ = near_count_;
    std::copy(near_.begin(), near_.begin() + count_, chosen_.begin());
  }

  void keepBest() {
    keepDeepest();
    while (count_ < kMaxChosen && keepNext()) continue;
    std::sort(chosen_.begin(), chosen_.begin() + count_,
              [](const Chosen& a, const Chosen& b) { return a.index < b.index; });
  }

  void keepDeepest() {
    Near first{{-1, 0}, 0, 0};
    forEachNear([&](const Near& c) {
      if (c.favour > first.favour && c.gap <= deepest_ + kSameGap) first = c;
    });
    PINCER_ASSERT(first.index >= 0);  // as many near ones as this is called for can't all be no number
    chosen_[count_++] = first;
    n_A_ = support_.normal(chosenPoint(0));
  }

  // False where no point is outside the polygon: those within it carry nothing that its corners don't.
  bool keepNext() {
    joinEdges();
    double best = 0;
    Chosen next{-1, 0};
    const Vec3 last = chosenPoint(count_ - 1);
    forEachNear([&](Near& c) {
      const double higher = (kSameGap + c.gap - deepest_) / c.favour;
      if (!(c.reach2 > kBetter * best * higher)) return;
      const Vec3& p = solid_.points[c.index];
      c.reach2 = std::min(c.reach2, reachFrom((p - last).squaredNorm()));
      if (!(c.reach2 > kBetter * best * higher)) return;
      const double d = outside(p);
      const double score = d > 0 ? d * d / higher : 0;
      if (!(score > kBetter * best) || anyChosen([&](const Chosen& other) { return other.index == c.index; })) return;
      best = score;
      next = c;
    });
    if (next.index < 0) return false;
    chosen_[count_++] = next;
    return true;
  }

  // (a + s)^2 <= (1 + x) a^2 + (1 + 1/x) s^2 for any x > 0; it is also more than round-off adds.
  static double reachFrom(double a2) {
    constexpr double x = 0.01;
    return (1 + x) * a2 + (1 + 1 / x) * kSameGap * kSameGap;
  }

  // How far `p` is outside the polygon of the chosen points; where it is nearest to a corner, a little less.
  double outside(const Vec3& p) const {
    if (count_ == 1) return n_A_.cross(p - chosenPoint(0)).norm();
    double distance = -std::numeric_limits<double>::infinity();
    for (int i = 0; i < edge_count_; ++i) distance = std::max(distance, edges_[i].distance(p));
    return distance;
  }

  void joinEdges() {
    edge_count_ = 0;
    for (int i = 0; i < count_; ++i) {
      for (int j = 0; j < count_; ++j) {
        const Edge edge = edgeBetween(chosenPoint(i), chosenPoint(j));
        if (i != j && isOutermost(edge)) edges_[edge_count_++] = edge;
      }
    }
  }

  Edge edgeBetween(const Vec3& a, const Vec3& b) const {
    const Vec3 right_A = directionOf<Vec3>((b - a).cross(n_A_), Vec3::Zero()).n;
    return {right_A, right_A.dot(a)};
  }

  bool isOutermost(const Edge& edge) const {
    return !anyChosen([&](const Chosen& c) { return edge.distance(solid_.points[c.index]) > kSameGap; });
  }

  const ExtremePoints& solid_;
  const Support& support_;
  double margin_;  // [m]
  const LastPoints& last_;
  double deepest_ = std::numeric_limits<double>::infinity();  // smallest gap [m]
  Vec3 n_A_ = Vec3::UnitZ();
  std::array<Chosen, kMaxChosen> chosen_{};
  int count_ = 0;
  std::array<Edge, kMaxEdges> edges_{};
  int edge_count_ = 0;
  std::array<Near, kListed> near_;  // of near_count_ points within the margin, the first
  int near_count_ = 0;
};

}  // namespace pincer::contact
