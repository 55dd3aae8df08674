#include "pincer/tasks/judge/bench/flat_distance.h"

#include <algorithm>
#include <array>
#include <limits>

namespace pincer::tasks {
namespace {

double distanceToSegment(const Vec3& p, const Vec3& a, const Vec3& b) {
  const double s = std::clamp((p - a).dot(b - a) / (b - a).squaredNorm(), 0.0, 1.0);
  return (p - a - s * (b - a)).norm();
}

// The plane's distance where the foot lies inside, else the nearest side's.
double distanceToTriangle(const Vec3& p, const std::array<Vec3, 3>& t) {
  const Vec3 n = (t[1] - t[0]).cross(t[2] - t[0]);
  bool inside = true;
  double nearest = std::numeric_limits<double>::infinity();
  for (std::size_t i = 0; i < 3; ++i) {
    const Vec3 &a = t[i], &b = t[(i + 1) % 3];
    inside = inside && n.cross(b - a).dot(p - a) >= 0;
    nearest = std::min(nearest, distanceToSegment(p, a, b));
  }
  return inside ? std::abs(n.dot(p - t[0])) / n.norm() : nearest;
}

}  // namespace

double distanceToTriangles(const contact::TriangleMesh& mesh, const Vec3& p) {
  double nearest = std::numeric_limits<double>::infinity();
  const auto corner = [&](std::int32_t v) { return mesh.vertices[static_cast<std::size_t>(v)]; };
  for (const auto& [a, b, c] : mesh.triangles)
    nearest = std::min(nearest, distanceToTriangle(p, {corner(a), corner(b), corner(c)}));
  return nearest;
}

}  // namespace pincer::tasks
