#include "pincer/contact/shape/quick_hull.h"

#include <algorithm>
#include <map>

#include "pincer/contact/functions/invariants.h"
#include "pincer/contact/shape/tolerances.h"

namespace pincer::contact {
namespace {

class QuickHull {
 public:
  explicit QuickHull(const std::vector<Vec3>& points) : points_(points) {
    Vec3 low = points.front(), high = points.front();
    for (const Vec3& p : points) low = low.cwiseMin(p), high = high.cwiseMax(p);
    tolerance_ = kOutOfPlane * (high - low).norm();
  }

  std::vector<std::array<int, 3>> build() {
    if (!startWithTetrahedron()) return {};
    for (std::size_t f = 0; f < facets_.size(); ++f) {  // new facets come at the end
      if (facets_[f].alive && !facets_[f].outside.empty()) addFurthest(static_cast<int>(f));
    }
    std::vector<std::array<int, 3>> alive;
    for (const Facet& f : facets_) {
      if (f.alive) alive.push_back(f.v);
    }
    return alive;
  }

 private:
  struct Facet {
    std::array<int, 3> v;
    Vec3 n;
    double d;
    std::vector<int> outside;  // points above it, each in one facet's list
    bool alive = true;
  };

  const Vec3& at(int i) const { return points_[static_cast<std::size_t>(i)]; }
  Facet& facet(int f) { return facets_[static_cast<std::size_t>(f)]; }
  double above(int f, int p) { return facet(f).n.dot(at(p)) - facet(f).d; }

  int addFacet(int a, int b, int c) {
    const Vec3 n = (at(b) - at(a)).cross(at(c) - at(a)).normalized();
    facets_.push_back({{a, b, c}, n, n.dot(at(a)), {}, true});
    const int f = static_cast<int>(facets_.size()) - 1;
    for (const auto& [from, to] : {std::pair(a, b), std::pair(b, c), std::pair(c, a)}) across_[{from, to}] = f;
    return f;
  }

  // The point with the largest value; -1 where none exceeds the tolerance.
  template <class Value>
  int furthest(Value value) const {
    int best = -1;
    double most = tolerance_;
    for (int i = 0; i < static_cast<int>(points_.size()); ++i) {
      const double x = value(at(i));
      if (x > most) most = x, best = i;
    }
    return best;
  }

  bool startWithTetrahedron() {
    const int a = 0;
    const int b = furthest([&](const Vec3& p) { return (p - at(a)).norm(); });
    if (b < 0) return false;
    const Vec3 line = (at(b) - at(a)).normalized();
    int c = furthest([&](const Vec3& p) { return line.cross(p - at(a)).norm(); });
    if (c < 0) return false;
    const Vec3 n = line.cross(at(c) - at(a)).normalized();
    const int d = furthest([&](const Vec3& p) { return std::abs(n.dot(p - at(a))); });
    if (d < 0) return false;
    int first = b;
    if (n.dot(at(d) - at(a)) > 0) std::swap(first, c);
    const std::array<int, 4> facets = {addFacet(a, first, c), addFacet(a, d, first), addFacet(first, d, c),
                                       addFacet(c, d, a)};
    std::vector<int> all;
    for (int i = 0; i < static_cast<int>(points_.size()); ++i) all.push_back(i);
    share(all, {facets.begin(), facets.end()});
    return true;
  }

  void share(const std::vector<int>& points, const std::vector<int>& facets) {
    for (const int p : points) {
      for (const int f : facets) {
        if (above(f, p) <= tolerance_) continue;
        facet(f).outside.push_back(p);
        break;
      }
    }
  }

  // Replaces the facets that the furthest point outside of facet `f` sees by a fan from their border to it.
  void addFurthest(int f) {
    const std::vector<int>& outside = facet(f).outside;
    PINCER_ASSERT(facet(f).alive && !outside.empty());
    const int p =
        *std::max_element(outside.begin(), outside.end(), [&](int x, int y) { return above(f, x) < above(f, y); });
    std::vector<int> seen = {f};
    std::vector<std::pair<int, int>> border;
    facet(f).alive = false;
    for (std::size_t i = 0; i < seen.size(); ++i) {
      const std::array<int, 3> v = facet(seen[i]).v;
      for (std::size_t k = 0; k < 3; ++k) {
        const int from = v[k], to = v[(k + 1) % 3], other = across_.at({to, from});
        if (!facet(other).alive) continue;
        if (above(other, p) > tolerance_) {
          facet(other).alive = false;
          seen.push_back(other);
        } else {
          border.emplace_back(from, to);
        }
      }
    }
    std::vector<int> orphans, fan;
    for (const int s : seen) {
      orphans.insert(orphans.end(), facet(s).outside.begin(), facet(s).outside.end());
      facet(s).outside.clear();
    }
    // An edge may have come to the border before the facet beyond it turned out to be seen.
    std::erase_if(border, [&](const auto& e) { return !facet(across_.at({e.second, e.first})).alive; });
    PINCER_ASSERT(border.size() >= 3);
    for (const auto& [from, to] : border) fan.push_back(addFacet(from, to, p));
    share(orphans, fan);
  }

  const std::vector<Vec3>& points_;
  double tolerance_;
  std::vector<Facet> facets_;
  std::map<std::pair<int, int>, int> across_;  // half-edge -> facet; the latest facet that has it
};

}  // namespace

std::vector<std::array<int, 3>> quickHull(const std::vector<Vec3>& points) {
  if (points.size() < 4) return {};
  return QuickHull(points).build();
}

}  // namespace pincer::contact
