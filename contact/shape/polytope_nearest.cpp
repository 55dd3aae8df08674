// Nearest point of a convex hull: within, on the nearest face; outside, on the
// nearest of the faces that look at the point.
#include <limits>

#include "pincer/contact/polytope.h"
#include "pincer/contact/shape/closed_forms.h"
#include "pincer/contact/shape/direction.h"

namespace pincer::contact {
namespace {

// Nearest point of a face to `p`, which lies above its plane by `height`.
Vec3 nearestOnFace(const Polytope& hull, const Polytope::Face& face, const Vec3& p, double height) {
  const std::span<const int> loop = hull.cornersOf(face);
  const Vec3 foot = p - height * face.n;
  Vec3 nearest = foot;
  double least = std::numeric_limits<double>::infinity();
  bool inside = true;
  for (std::size_t k = 0; k < loop.size(); ++k) {
    const Vec3& from = hull.vertices()[static_cast<std::size_t>(loop[k])];
    const Vec3 edge = hull.vertices()[static_cast<std::size_t>(loop[(k + 1) % loop.size()])] - from;
    if (face.n.cross(edge).dot(foot - from) >= 0) continue;
    inside = false;
    const double t = std::min(std::max(edge.dot(foot - from) / edge.squaredNorm(), 0.0), 1.0);
    const Vec3 q = from + t * edge;
    const double distance2 = (foot - q).squaredNorm();
    if (distance2 < least) least = distance2, nearest = q;
  }
  return inside ? foot : nearest;
}

}  // namespace

NearestPoint nearestPoint(const Convex& convex, const Vec3& p_BC) {
  const Polytope& hull = *convex.hull;
  const Polytope::Face* top = &hull.faces().front();
  double highest = -std::numeric_limits<double>::infinity();
  for (const Polytope::Face& face : hull.faces()) {
    const double height = face.n.dot(p_BC) - face.d;
    if (height > highest) highest = height, top = &face;
  }
  if (highest <= 0) return {p_BC - highest * top->n, top->n, highest};
  NearestPoint best{p_BC, top->n, std::numeric_limits<double>::infinity()};
  for (const Polytope::Face& face : hull.faces()) {
    const double height = face.n.dot(p_BC) - face.d;
    if (!(height > 0) || height >= best.distance) continue;
    const Vec3 q = nearestOnFace(hull, face, p_BC, height);
    const auto [n, distance] = directionOf<Vec3>(p_BC - q, face.n);
    if (distance < best.distance) best = {q, q == p_BC - height * face.n ? face.n : n, distance};
  }
  return best;
}

}  // namespace pincer::contact
