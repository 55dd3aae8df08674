// point_choice: up to four of a solid's extreme points, those that carry it best on a support.
//
// Up to four points within the margin are all kept. Of more, in this order, with distances across the normal n at the first point:
//   1. the deepest
//   2. the one furthest from 1
//   3. the one furthest from the line 1-2
//   4. the one furthest outside the triangle 1-2-3
// each of 2-4 by  distance - 2 (gap - gap of the deepest):  without the second term the upper corners of a thin tilted plate, which stick
// out further than the lower ones, would be taken and the plate would sink. The factor 2 holds up to a tilt of atan 2 = 63 degrees, where
// another face has long become the lower one (for a box at 55 degrees at the latest).
// Differences below 1e-7 m count as none, and then the smaller feature wins: the points of a resting body don't change with round-off.
// Cost: one scan over all points and four over those within the margin, 1 and 20 ns per point. More than 256 of these are not listed
// (no memory is allocated) but found again by each scan: 10 us for a hull of 10,000 vertices with few of them near, 230 us with most.
#pragma once
#include <algorithm>
#include <array>
#include <limits>

#include "contact/shape/direction.h"
#include "contact/shape/extreme_points.h"
#include "contact/shape/pair_query.h"

namespace pincer::contact {

struct Chosen {
  int index;   // of the extreme point
  double gap;  // [m]
};

template <class Support>
class PointChoice {
 public:
  PointChoice(const ExtremePoints& solid, const Support& support, double margin) : solid_(solid), support_(support), margin_(margin) {
    listNear();
    near_count_ <= kMaxPairPoints ? keepAll() : keepBestFour();
  }

  int count() const { return count_; }
  const Chosen& operator[](int i) const { return chosen_[i]; }  // by ascending index

 private:
  static constexpr int kListed = 256;
  static constexpr double kSame = 1e-7;      // [m]
  static constexpr double kGapWeight = 2.0;  // [-]

  double gapOf(int i) const { return support_.gap(solid_.points[i]) - solid_.rounding; }
  int candidates() const { return static_cast<int>(solid_.points.size()); }
  const Vec3& chosenPoint(int i) const { return solid_.points[chosen_[i].index]; }
  bool isChosen(int i) const {
    return std::any_of(chosen_.begin(), chosen_.begin() + count_, [i](const Chosen& c) { return c.index == i; });
  }

  void listNear() {
    for (int i = 0; i < candidates(); ++i) {
      const double gap = gapOf(i);
      if (!(gap < margin_)) continue;
      if (near_count_ < kListed) near_[near_count_] = {i, gap};
      ++near_count_;
      deepest_ = std::min(deepest_, gap);
    }
  }

  template <class Visit>
  void forEachNear(Visit visit) const {
    if (near_count_ <= kListed) return static_cast<void>(std::for_each(near_.begin(), near_.begin() + near_count_, visit));
    for (int i = 0; i < candidates(); ++i) {
      const double gap = gapOf(i);
      if (gap < margin_) visit(Chosen{i, gap});
    }
  }

  void keepAll() {
    count_ = near_count_;
    std::copy(near_.begin(), near_.begin() + count_, chosen_.begin());
  }

  void keepBestFour() {
    keepDeepest();
    keepFurthest();
    keepFurthestFromLine();
    keepFurthestFromTriangle();
    std::sort(chosen_.begin(), chosen_.end(), [](const Chosen& a, const Chosen& b) { return a.index < b.index; });
  }

  void keepDeepest() {
    Chosen first{-1, 0};
    forEachNear([&](const Chosen& c) {
      if (first.index < 0 && c.gap <= deepest_ + kSame) first = c;
    });
    chosen_[count_++] = first;
    n_A_ = support_.normal(chosenPoint(0));
  }

  void keepFurthest() {
    const Vec3& p0 = chosenPoint(0);
    keepBest([&](const Vec3& p) { return n_A_.cross(p - p0).norm(); });
  }

  void keepFurthestFromLine() {
    const Vec3& p0 = chosenPoint(0);
    const Vec3 across = acrossEdge(p0, chosenPoint(1));
    keepBest([&](const Vec3& p) { return std::abs(across.dot(p - p0)); });
  }

  void keepFurthestFromTriangle() {
    const Vec3& a = chosenPoint(0);
    const bool turns_left = acrossEdge(a, chosenPoint(1)).dot(chosenPoint(2) - a) < 0;
    const Vec3& b = chosenPoint(turns_left ? 1 : 2);
    const Vec3& c = chosenPoint(turns_left ? 2 : 1);
    const Vec3 ab = acrossEdge(a, b);
    const Vec3 bc = acrossEdge(b, c);
    const Vec3 ca = acrossEdge(c, a);
    keepBest([&](const Vec3& p) { return std::max({ab.dot(p - a), bc.dot(p - b), ca.dot(p - c)}); });
  }

  // Unit vector across the normal, to the right of the edge from `a` to `b`; zero where the two lie on one normal.
  Vec3 acrossEdge(const Vec3& a, const Vec3& b) const { return directionOf<Vec3>((b - a).cross(n_A_), Vec3::Zero()).n; }

  template <class Distance>
  void keepBest(Distance distance) {
    double best = -std::numeric_limits<double>::infinity();
    Chosen next{0, 0};
    forEachNear([&](const Chosen& c) {
      const double score = distance(solid_.points[c.index]) - kGapWeight * (c.gap - deepest_);
      if (!(score > best + kSame) || isChosen(c.index)) return;
      best = score;
      next = c;
    });
    chosen_[count_++] = next;
  }

  const ExtremePoints& solid_;
  const Support& support_;
  double margin_;                                             // [m]
  double deepest_ = std::numeric_limits<double>::infinity();  // smallest gap [m]
  Vec3 n_A_ = Vec3::UnitZ();
  std::array<Chosen, kMaxPairPoints> chosen_{};
  int count_ = 0;
  std::array<Chosen, kListed> near_;  // of near_count_ points within the margin, the first
  int near_count_ = 0;
};

}  // namespace pincer::contact
