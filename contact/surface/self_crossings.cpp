#include "pincer/contact/surface/self_crossings.h"

#include <algorithm>
#include <array>
#include <limits>

#include "pincer/contact/surface/aabb_tree.h"

namespace pincer::contact {

namespace {

using Corners = std::array<Vec3, 3>;

Corners cornersOf(const TriangleMesh& mesh, std::int32_t triangle) {
  const auto& t = mesh.triangles[static_cast<std::size_t>(triangle)];
  const auto at = [&](std::size_t i) -> const Vec3& { return mesh.vertices[static_cast<std::size_t>(t[i])]; };
  return {at(0), at(1), at(2)};
}

// 1 or -1 on either side of the plane through a, b, c; 0 within round-off of it.
int sideOf(const Vec3& a, const Vec3& b, const Vec3& c, const Vec3& d) {
  constexpr double kRoundOff = 16 * std::numeric_limits<double>::epsilon();  // of a product of three differences
  const Vec3 u = b - a, v = c - a, w = d - a, n = v.cross(w);
  const double volume = u.dot(n);
  const double size =
      std::max({a.cwiseAbs().maxCoeff(), b.cwiseAbs().maxCoeff(), c.cwiseAbs().maxCoeff(), d.cwiseAbs().maxCoeff()});
  const double edge = std::max({u.norm(), v.norm(), w.norm()});
  const double error = kRoundOff * size * edge * edge;  // each difference errs by the coordinates' round-off
  return volume > error ? 1 : volume < -error ? -1 : 0;
}

bool goesThrough(const Vec3& a, const Vec3& b, const Corners& t) {
  const int side = sideOf(t[0], t[1], t[2], a);
  if (side == 0 || sideOf(t[0], t[1], t[2], b) != -side) return false;
  const int turn = sideOf(a, b, t[0], t[1]);
  return turn != 0 && sideOf(a, b, t[1], t[2]) == turn && sideOf(a, b, t[2], t[0]) == turn;
}

bool anyEdgeGoesThrough(const Corners& from, const Corners& t) {
  return goesThrough(from[0], from[1], t) || goesThrough(from[1], from[2], t) || goesThrough(from[2], from[0], t);
}

Aabb boxOf(const Corners& c) { return {c[0].cwiseMin(c[1]).cwiseMin(c[2]), c[0].cwiseMax(c[1]).cwiseMax(c[2])}; }

}  // namespace

bool crossEachOther(const TriangleMesh& mesh, std::int32_t a, std::int32_t b) {
  const Corners ca = cornersOf(mesh, a), cb = cornersOf(mesh, b);
  return anyEdgeGoesThrough(ca, cb) || anyEdgeGoesThrough(cb, ca);
}

SelfCrossings findSelfCrossings(const TriangleMesh& mesh) {
  constexpr std::int64_t kCandidates = 200;  // per triangle, in the mean
  SelfCrossings found;
  if (mesh.triangles.empty()) return found;
  const auto n = static_cast<std::int32_t>(mesh.triangles.size());
  std::vector<Aabb> boxes;
  boxes.reserve(mesh.triangles.size());
  for (std::int32_t t = 0; t < n; ++t) boxes.push_back(boxOf(cornersOf(mesh, t)));
  const AabbTree tree(boxes);
  std::int64_t left = kCandidates * n;
  for (std::int32_t t = 0; t < n && left > 0; ++t) {
    const Aabb& box = boxes[static_cast<std::size_t>(t)];
    std::int32_t first = n;
    tree.visitBox(box.low, box.high, static_cast<int>(std::min<std::int64_t>(left, std::numeric_limits<int>::max())),
                  [&](std::int32_t place) {
                    --left;
                    const std::int32_t other = tree.order()[static_cast<std::size_t>(place)];
                    if (other <= t || !crossEachOther(mesh, t, other)) return;
                    ++found.pairs;
                    first = std::min(first, other);
                  });
    if (found.first >= 0 || first == n) continue;
    found.first = t;
    found.other = first;
  }
  found.is_all = left > 0;
  return found;
}

}  // namespace pincer::contact
