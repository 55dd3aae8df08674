#include "contact/mesh/polygon.h"

#include <algorithm>
#include <numeric>

namespace pincer::contact {

namespace {

// Height of a triangle over its longest edge, relative to that edge, below which it counts as flat: some thousand units of round-off.
constexpr double kFlat = 1e-12;

double cross(const Vec2& a, const Vec2& b) { return a.x() * b.y() - a.y() * b.x(); }

Vec3 newellNormal(const std::vector<Vec3>& polygon) {
  Vec3 n = Vec3::Zero();
  for (std::size_t i = 1; i + 1 < polygon.size(); ++i) n += (polygon[i] - polygon[0]).cross(polygon[i + 1] - polygon[0]);
  return n;
}

std::vector<Vec2> inPlane(const std::vector<Vec3>& polygon, const Vec3& n) {
  const Mat3 R = frameFromNormal(n);
  std::vector<Vec2> flat;
  flat.reserve(polygon.size());
  for (const Vec3& p : polygon) flat.emplace_back(R.col(0).dot(p - polygon[0]), R.col(1).dot(p - polygon[0]));
  return flat;
}

// Whether a, b, c turn left by more than round-off.
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
    turn += std::atan2(cross(b - a, c - b), (b - a).dot(c - b));
  }
  return turn < 7;  // 2 pi, or at least 4 pi
}

bool isEar(const std::vector<Vec2>& p, const std::vector<int>& left, std::size_t i) {
  const std::size_t n = left.size();
  const int a = left[(i + n - 1) % n], b = left[i], c = left[(i + 1) % n];
  if (!turnsLeft(p[a], p[b], p[c])) return false;
  return std::none_of(left.begin(), left.end(), [&](int k) { return k != a && k != b && k != c && triangleHolds(p[a], p[b], p[c], p[k]); });
}

std::vector<CornerTriple> clipEars(const std::vector<Vec2>& p) {
  std::vector<int> left(p.size());
  std::iota(left.begin(), left.end(), 0);
  std::vector<CornerTriple> triangles;
  while (left.size() >= 3) {
    std::size_t i = 0;
    while (i < left.size() && !isEar(p, left, i)) ++i;
    if (i == left.size()) return {};
    const std::size_t n = left.size();
    triangles.push_back({left[(i + n - 1) % n], left[i], left[(i + 1) % n]});
    left.erase(left.begin() + static_cast<std::ptrdiff_t>(i));
    if (left.size() == 2) break;
  }
  return triangles;
}

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
  const Vec3 n = newellNormal(polygon);
  if (!(n.norm() > 0)) return {};
  const std::vector<Vec2> flat = inPlane(polygon, n.normalized());
  if (isStrictlyConvex(flat)) return fan(static_cast<int>(polygon.size()));
  return clipEars(flat);
}

}  // namespace pincer::contact
