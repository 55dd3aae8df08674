#include <LinearMath/btConvexHullComputer.h>

#include <algorithm>

#include "contact/surface/convex_hull.h"

namespace pincer::contact {

std::vector<std::int32_t> hullCorners(const std::vector<Vec3>& points) {
  static_assert(sizeof(btScalar) == sizeof(double));
  btConvexHullComputer hull;
  if (!points.empty()) hull.compute(points.front().data(), sizeof(Vec3), static_cast<int>(points.size()), 0, 0);
  std::vector<std::int32_t> corners;
  for (int i = 0; i < hull.original_vertex_index.size(); ++i) corners.push_back(hull.original_vertex_index[i]);
  std::sort(corners.begin(), corners.end());
  return corners;
}

}  // namespace pincer::contact
