#include "pincer/contact/mesh/moving_mesh.h"

#include <algorithm>
#include <limits>

#include "pincer/contact/functions/invariants.h"

namespace pincer::contact {

namespace {

// Smallest x > 0 with a + b x + c x^2 = 0, a > 0; infinity if there is none.
double smallestPositiveRoot(double a, double b, double c) {
  const double discriminant = b * b - 4 * a * c;
  if (discriminant < 0) return kInfinity;
  const double q = -0.5 * (b + std::copysign(std::sqrt(discriminant), b));
  double root = kInfinity;
  if (q != 0 && a / q > 0) root = a / q;
  if (c != 0 && q / c > 0) root = std::min(root, q / c);
  return root;
}

}  // namespace

std::int32_t MovingMesh::add(const MovingPoint& point) {
  PINCER_ASSERT(isUnit(point.n));
  points_.push_back(point);
  return static_cast<std::int32_t>(points_.size()) - 1;
}

void MovingMesh::addTriangle(std::int32_t a, std::int32_t b, std::int32_t c) {
  if (a != b && b != c && c != a) triangles_.push_back({a, b, c});
}

void MovingMesh::addFace(const std::array<std::int32_t, 3>& corners, const Vec3& normal, std::int32_t source) {
  PINCER_ASSERT(isUnit(normal));
  faces_.push_back({corners, normal, source});
  triangles_.push_back(corners);
}

void MovingMesh::addSide(std::int32_t a, std::int32_t b, std::int32_t source) { sides_.push_back({a, b, source}); }

// Twice the area across the normal is a quadratic in rho. A part that begins with no area (at the tip of a cone) grows
// with the radius; there the constant vanishes and the linear term's root is what counts.
double MovingMesh::largestOf(const Face& face) const {
  const MovingPoint &x = point(face.corners[0]), &y = point(face.corners[1]), &z = point(face.corners[2]);
  const Vec3 e = y.p - x.p, f = z.p - x.p, de = y.w - x.w, df = z.w - x.w;
  const double a = e.cross(f).dot(face.normal);
  const double b = (e.cross(df) + de.cross(f)).dot(face.normal);
  const double c = de.cross(df).dot(face.normal);
  const double round_off = 1e-12 * e.norm() * f.norm();
  if (a <= round_off) return b > 0 && c < 0 ? -b / c : kInfinity;
  return smallestPositiveRoot(a, b, c);
}

double MovingMesh::largestOf(const Side& side) const {
  const MovingPoint &x = point(side.a), &y = point(side.b);
  const Vec3 e = y.p - x.p;
  const double shrink = -(y.w - x.w).dot(e);
  return shrink > 0 ? e.squaredNorm() / shrink : kInfinity;
}

RadiusLimit MovingMesh::limit() const {
  RadiusLimit limit{kInfinity, -1};
  const auto lower = [&](double radius, std::int32_t source) {
    if (radius < limit.radius) limit = {radius, source};
  };
  for (const Face& face : faces_) lower(largestOf(face), face.source);
  for (const Side& side : sides_) lower(largestOf(side), side.source);
  return limit;
}

TriangleMesh MovingMesh::at(double rho, const std::string& source) const {
  TriangleMesh mesh;
  mesh.source = source;
  for (const MovingPoint& point : points_) {
    mesh.vertices.push_back(point.at(rho));
    mesh.normals.push_back(point.n);
  }
  mesh.triangles = mesh.triangle_normals = triangles_;
  return mesh;
}

}  // namespace pincer::contact
