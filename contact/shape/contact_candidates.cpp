#include "contact/shape/contact_candidates.h"

#include <algorithm>
#include <cmath>

namespace pincer::contact {
namespace {

constexpr double kLike = 0.95;     // cosine: normals within 18 degrees form a group
constexpr double kSameGap = 1e-6;  // [m]
constexpr double kBetter = 1.01;   // ratio of scores, as in point_choice.h

// The kept points of one group.
struct Group {
  std::array<const PairPoint*, kMaxPairPoints> kept{};
  int count = 0;
};

// Distance of `p` from what the group has: from its point, its line, or the outline of more; across the leader's normal.
double outside(const Group& g, const Vec3& p) {
  const Vec3& n = g.kept[0]->n_W;
  const auto flat = [&](const Vec3& v) -> Vec3 { return v - n.dot(v) * n; };
  const Vec3 d0 = flat(p - g.kept[0]->p_W);
  if (g.count == 1) return d0.norm();
  double most = g.count == 2 ? 0 : -1;
  for (int i = 0; i < g.count; ++i) {
    for (int j = 0; j < g.count; ++j) {
      if (i == j) continue;
      const Vec3& from = g.kept[static_cast<std::size_t>(i)]->p_W;
      const Vec3 right = flat(g.kept[static_cast<std::size_t>(j)]->p_W - from).cross(n).normalized();
      bool outermost = true;
      for (int k = 0; k < g.count; ++k) outermost = outermost && right.dot(g.kept[static_cast<std::size_t>(k)]->p_W - from) <= kSameGap;
      if (outermost) most = std::max(most, right.dot(p - from));
    }
  }
  return most;
}

}  // namespace

void ContactCandidates::add(const PairPoint& point) {
  PairPoint* place = nullptr;
  for (int i = 0; i < count_; ++i) {
    PairPoint& other = points_[static_cast<std::size_t>(i)];
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

void ContactCandidates::keepBest(PairPoints& out) const {
  out.count = 0;
  std::array<bool, kMost> taken{};
  std::array<Group, kMaxPairPoints> groups;
  int group_count = 0;
  const auto at = [&](int i) -> const PairPoint& { return points_[static_cast<std::size_t>(i)]; };
  const auto keep = [&](int i, Group& g) {
    taken[static_cast<std::size_t>(i)] = true;
    g.kept[static_cast<std::size_t>(g.count++)] = &at(i);
    out.points[static_cast<std::size_t>(out.count++)] = at(i);
  };
  const auto groupOf = [&](int i) {
    for (int g = 0; g < group_count; ++g) {
      if (groups[static_cast<std::size_t>(g)].kept[0]->n_W.dot(at(i).n_W) > kLike) return g;
    }
    return -1;
  };
  const auto comesFirst = [&](int i, int j) {  // deeper, or as deep with the smaller feature
    return j < 0 || at(i).phi < at(j).phi - kSameGap || (at(i).phi < at(j).phi + kSameGap && at(i).feature < at(j).feature);
  };
  while (group_count < kMaxPairPoints) {
    int leader = -1;
    for (int i = 0; i < count_; ++i) {
      if (groupOf(i) < 0 && comesFirst(i, leader)) leader = i;
    }
    if (leader < 0) break;
    keep(leader, groups[static_cast<std::size_t>(group_count++)]);
  }
  for (bool more = true; more && out.count < kMaxPairPoints;) {
    more = false;
    for (int g = 0; g < group_count && out.count < kMaxPairPoints; ++g) {
      Group& group = groups[static_cast<std::size_t>(g)];
      double best = 0;
      int next = -1;
      for (int i = 0; i < count_; ++i) {
        if (taken[static_cast<std::size_t>(i)] || groupOf(i) != g) continue;
        const double d = outside(group, at(i).p_W);
        const double score = d > kSameGap ? d * d / (kSameGap + std::max(0.0, at(i).phi - group.kept[0]->phi)) : 0;
        const bool wins = score > kBetter * best || (next >= 0 && score * kBetter > best && at(i).feature < at(next).feature);
        if (score > 0 && wins) best = score, next = i;
      }
      if (next < 0) continue;
      keep(next, group);
      more = true;
    }
  }
  std::sort(out.points.begin(), out.points.begin() + out.count,
            [](const PairPoint& x, const PairPoint& y) { return x.feature < y.feature; });
}

}  // namespace pincer::contact
