#include "pincer/contact/mesh/polygon.h"

#include <algorithm>

#include "pincer/contact/functions/invariants.h"

namespace pincer::contact {

namespace {

// Height of a triangle over its longest edge, relative to that edge, below which it counts
// as flat: some thousand units of round-off.
constexpr double kFlat = 1e-12;

Vec3 newellNormal(const std::vector<Vec3>& polygon) {
  Vec3 n = Vec3::Zero();
  for (std::size_t i = 1; i + 1 < polygon.size(); ++i)
    n += (polygon[i] - polygon[0]).cross(polygon[i + 1] - polygon[0]);
  return n;
}

std::vector<Vec2> inPlane(const std::vector<Vec3>& polygon, const Vec3& n) {
  PINCER_ASSERT(isUnit(n));
  const Mat3 R = frameFromNormal(n);
  std::vector<Vec2> flat;
  flat.reserve(polygon.size());
  for (const Vec3& p : polygon) flat.emplace_back(R.col(0).dot(p - polygon[0]), R.col(1).dot(p - polygon[0]));
  return flat;
}

// True if a, b, c turn left by more than round-off.
bool turnsLeft(const Vec2& a, const Vec2& b, const Vec2& c) {
  const double longest2 = std::max({(b - a).squaredNorm(), (c - b).squaredNorm(), (a - c).squaredNorm()});
  return cross(b - a, c - a) > kFlat * longest2;
}

// Inside or on the border.
bool triangleHolds(const Vec2& a, const Vec2& b, const Vec2& c, const Vec2& p) {
  return cross(b - a, p - a) >= 0 && cross(c - b, p - b) >= 0 && cross(a - c, p - c) >= 0;
}

bool isStrictlyConvex(const std::vector<Vec2>& p) {
  const std::size_t n = p.size();
  double turn = 0;  // a star also turns left at every corner, but more than once around
  for (std::size_t i = 0; i < n; ++i) {
    const Vec2& a = p[i];
    const Vec2& b = p[(i + 1) % n];
    const Vec2& c = p[(i + 2) % n];
    if (!turnsLeft(a, b, c)) return false;
    turn += math::atan2(cross(b - a, c - b), (b - a).dot(c - b));
  }
  return turn < 7;  // 2 pi, or at least 4 pi
}

// Cuts off one ear after the other. Whether a corner is an ear changes when a neighbour is cut off;
// others are looked at again only when no ear is left (corners that touch may have hidden one), and
// at most kRounds times: n^2 steps in all.
class EarClipper {
 public:
  explicit EarClipper(const std::vector<Vec2>& p)
      : p_(p), next_(p.size()), previous_(p.size()), ear_(p.size()), left_(size()) {
    for (int i = 0; i < size(); ++i) {
      next_[i] = (i + 1) % size();
      previous_[i] = (i + size() - 1) % size();
    }
  }

  std::vector<CornerTriple> clip() {
    for (int round = 0; round < kRounds && left_ >= 3; ++round) {
      for (int i = first_, k = 0; k < left_; i = next_[i], ++k) ear_[i] = isEar(i);
      clipKnownEars();
    }
    PINCER_ASSERT(left_ >= 3 || triangles_.size() + 2 == p_.size());
    return left_ < 3 ? triangles_ : std::vector<CornerTriple>();
  }

 private:
  static constexpr int kRounds = 16;  // of looks at all corners

  int size() const { return static_cast<int>(p_.size()); }

  void clipKnownEars() {
    for (int looked_at = 0, i = first_; left_ >= 3 && looked_at < left_; i = next_[i], ++looked_at) {
      if (!ear_[i]) continue;
      cut(i);
      looked_at = -1;
    }
  }

  void cut(int i) {
    const int a = previous_[i], b = next_[i];
    triangles_.push_back({a, i, b});
    next_[a] = b;
    previous_[b] = a;
    first_ = b;
    --left_;
    if (left_ == 2) left_ = 0;
    if (left_ < 3) return;
    ear_[a] = isEar(a);
    ear_[b] = isEar(b);
  }

  bool isEar(int i) const {
    const int a = previous_[i], b = next_[i];
    if (!turnsLeft(p_[a], p_[i], p_[b])) return false;
    for (int k = next_[b]; k != a; k = next_[k]) {
      if (triangleHolds(p_[a], p_[i], p_[b], p_[k])) return false;
    }
    return true;
  }

  const std::vector<Vec2>& p_;
  std::vector<int> next_, previous_;  // corners not yet cut off, in a ring
  std::vector<char> ear_;
  int first_ = 0;
  int left_;
  std::vector<CornerTriple> triangles_;
};

std::vector<CornerTriple> fan(int corners) {
  std::vector<CornerTriple> triangles;
  for (int i = 1; i + 1 < corners; ++i) triangles.push_back({0, i, i + 1});
  return triangles;
}

}  // namespace

bool hasZeroArea(const Vec3& p0, const Vec3& p1, const Vec3& p2) {
  const double longest2 = std::max({(p1 - p0).squaredNorm(), (p2 - p1).squaredNorm(), (p0 - p2).squaredNorm()});
  return !((p1 - p0).cross(p2 - p0).norm() > kFlat * longest2);
}

std::vector<CornerTriple> triangulate(const std::vector<Vec3>& polygon) {
  PINCER_ASSERT(polygon.size() >= 3);
  const Vec3 n = newellNormal(polygon);
  if (!(n.norm() > 0)) return {};
  const std::vector<Vec2> flat = inPlane(polygon, n.normalized());
  if (isStrictlyConvex(flat)) return fan(static_cast<int>(polygon.size()));
  return EarClipper(flat).clip();
}

}  // namespace pincer::contact
