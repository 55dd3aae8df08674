#include <LinearMath/btConvexHullComputer.h>

#include <algorithm>

#include "pincer/contact/surface/bullet_memory.h"
#include "pincer/contact/surface/convex_hull.h"

namespace pincer::contact {
namespace {

static_assert(sizeof(btScalar) == sizeof(double));

void computeHull(const std::vector<Vec3>& points, double shrink, double clamp, btConvexHullComputer& hull) {
  if (points.empty()) return;
  letBulletThrow();
  hull.compute(points.front().data(), sizeof(Vec3), static_cast<int>(points.size()), shrink, clamp);
}

}  // namespace

std::vector<std::int32_t> hullCorners(const std::vector<Vec3>& points) {
  btConvexHullComputer hull;
  computeHull(points, 0, 0, hull);
  std::vector<std::int32_t> corners;
  for (int i = 0; i < hull.original_vertex_index.size(); ++i) corners.push_back(hull.original_vertex_index[i]);
  std::sort(corners.begin(), corners.end());
  return corners;
}

std::vector<Vec3> insetCorners(const std::vector<Vec3>& points, double distance) {
  btConvexHullComputer hull;
  computeHull(points, distance, 0.5, hull);
  std::vector<Vec3> corners;
  for (int i = 0; i < hull.vertices.size(); ++i) {
    const btVector3& v = hull.vertices[i];
    corners.emplace_back(v.x(), v.y(), v.z());
  }
  return corners;
}

}  // namespace pincer::contact
