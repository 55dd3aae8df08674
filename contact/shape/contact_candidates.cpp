#include "pincer/contact/shape/contact_candidates.h"

#include <algorithm>
#include <cmath>

#include "pincer/contact/functions/invariants.h"
#include "pincer/contact/shape/point_choice.h"
#include "pincer/contact/shape/tolerances.h"

namespace pincer::contact {
namespace {

// The kept points of one group, and the sides of their outline seen along the first one's normal.
struct Group {
  struct Side {
    Vec3 right, from;
  };
  std::array<const PairPoint*, kMaxChosen> kept{};
  int count = 0;
  std::array<Side, kMaxChosen*(kMaxChosen - 1)> sides;
  int side_count = 0;

  const Vec3& normal() const { return kept[0]->n_W; }
  const Vec3& point(int i) const { return kept[static_cast<std::size_t>(i)]->p_W; }
  Vec3 flat(const Vec3& v) const { return v - normal().dot(v) * normal(); }

  void add(const PairPoint& p) {
    PINCER_ASSERT(count < kMaxChosen);
    kept[static_cast<std::size_t>(count++)] = &p;
    side_count = 0;
    for (int i = 0; i < count; ++i) {
      for (int j = 0; j < count; ++j) {
        if (i == j) continue;
        const Vec3 right = flat(point(j) - point(i)).cross(normal()).normalized();
        bool outermost = true;
        for (int k = 0; k < count; ++k) outermost = outermost && right.dot(point(k) - point(i)) <= kSameGap;
        if (outermost) sides[static_cast<std::size_t>(side_count++)] = {right, point(i)};
      }
    }
  }
  // Distance of `p` from what the group has: from its point, the line between two, or the outline of more.
  double outside(const Vec3& p) const {
    if (count == 1) return flat(p - point(0)).norm();
    if (count == 2) return outsideLine(flat(p - point(0)), flat(point(1) - point(0)));
    double most = -1;
    for (int i = 0; i < side_count; ++i) {
      const Side& side = sides[static_cast<std::size_t>(i)];
      most = std::max(most, side.right.dot(p - side.from));
    }
    return most;
  }

 private:
  static double outsideLine(const Vec3& p, const Vec3& line) {
    const double share = std::clamp(p.dot(line) / line.squaredNorm(), 0.0, 1.0);
    return (p - share * line).norm();
  }
};

}  // namespace

void FoundPoints::place(const Pose& X_WF, PairPoints& out) const {
  for (int i = 0; i < count; ++i) {
    PairPoint& point = out.points[static_cast<std::size_t>(i)] = points[static_cast<std::size_t>(i)];
    point.p_W = X_WF * point.p_W;
    point.n_W = X_WF.q * point.n_W;
  }
  out.count = count;
}

void ContactCandidates::add(const FoundPoint& point) {
  FoundPoint* place = nullptr;
  for (int i = 0; i < count_; ++i) {
    FoundPoint& other = points_[static_cast<std::size_t>(i)];
    if (other.feature == point.feature) {
      if (std::abs(point.phi) < std::abs(other.phi)) other = point;
      return;
    }
    if (!place || other.phi > place->phi) place = &other;
  }
  if (count_ < kMost)
    place = &points_[static_cast<std::size_t>(count_++)];
  else if (!(place->phi > point.phi))
    return;
  *place = point;
}

FoundPoints ContactCandidates::keepBest(const LastPoints& last) {
  FoundPoints out;
  if (refused_.phi > -kInfinity && !overlap()) add(refused_);
  constexpr std::int8_t kNone = -1, kTaken = -2;  // marks of places in the table
  std::array<std::int8_t, kMost> group_of;
  std::fill_n(group_of.begin(), count_, kNone);
  std::array<Group, kMaxPairPoints> groups;
  int group_count = 0;
  const auto at = [&](int i) -> const FoundPoint& { return points_[static_cast<std::size_t>(i)]; };
  const auto keep = [&](int i, Group& g) {
    group_of[static_cast<std::size_t>(i)] = kTaken;
    g.add(at(i));
    PINCER_ASSERT(out.count < kMaxPairPoints);
    PINCER_ASSERT(isUnitIfFinite(at(i).n_W));
    out.points[static_cast<std::size_t>(out.count++)] = at(i);
  };
  const auto favour = [&](int i) { return favourOf(last, at(i).feature); };
  const auto comesFirst = [&](int i, int j) {  // deeper, or as deep and there before, or with the smaller feature
    if (j < 0 || at(i).phi < at(j).phi - kSameGap) return true;
    if (!(at(i).phi < at(j).phi + kSameGap)) return false;
    return favour(i) != favour(j) ? favour(i) > favour(j) : at(i).feature < at(j).feature;
  };
  while (group_count < kMaxPairPoints) {
    int leader = -1;
    for (int i = 0; i < count_; ++i) {
      if (group_of[static_cast<std::size_t>(i)] == kNone && comesFirst(i, leader)) leader = i;
    }
    if (leader < 0) break;
    keep(leader, groups[static_cast<std::size_t>(group_count)]);
    for (int i = 0; i < count_; ++i) {
      std::int8_t& group = group_of[static_cast<std::size_t>(i)];
      if (group == kNone && at(leader).n_W.dot(at(i).n_W) > kLikeNormals) group = static_cast<std::int8_t>(group_count);
    }
    ++group_count;
  }
  const auto furthestOf = [&](int g) {
    const Group& group = groups[static_cast<std::size_t>(g)];
    double best = 0;
    int next = -1;
    for (int i = 0; i < count_; ++i) {
      if (group_of[static_cast<std::size_t>(i)] != g) continue;
      const double d = group.outside(at(i).p_W);
      const double score =
          d > kSameGap ? favour(i) * d * d / (kSameGap + std::max(0.0, at(i).phi - group.kept[0]->phi)) : 0;
      const bool wins =
          score > kBetter * best || (next >= 0 && score * kBetter > best && at(i).feature < at(next).feature);
      if (score > 0 && wins) best = score, next = i;
    }
    return next;
  };
  for (bool more = true; more;) {
    more = false;
    for (int g = 0; g < group_count && out.count < kMaxPairPoints; ++g) {
      Group& group = groups[static_cast<std::size_t>(g)];
      const int next = group.count < kMaxChosen ? furthestOf(g) : -1;
      if (next < 0) continue;
      keep(next, group);
      more = true;
    }
  }
  std::sort(out.points.begin(), out.points.begin() + out.count,
            [](const PairPoint& x, const PairPoint& y) { return x.feature < y.feature; });
  return out;
}

}  // namespace pincer::contact
