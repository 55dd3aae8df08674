// How far a ray runs in a convex solid: t of p + t d.
#include <algorithm>
#include <cmath>

#include "pincer/contact/functions/invariants.h"
#include "pincer/contact/shape/convex_features.h"

namespace pincer::contact {
namespace {

// On the infinite round wall about the z axis.
double wallReach(double radius, const Vec3& p, const Vec3& d) {
  const Vec2 u = d.head<2>(), q = p.head<2>();
  const double uu = u.squaredNorm(), uq = u.dot(q);
  if (!(uu > 0)) return kInfinity;
  return (std::sqrt(std::max(0.0, uq * uq - uu * (q.squaredNorm() - radius * radius))) - uq) / uu;
}
// `along`: from the point to the plane; of points on a rim it is round-off, which a small rate would blow up.
double planeReach(double along, double rate) { return rate > 0 ? std::max(along, 0.0) / rate : kInfinity; }
double ballReach(double radius, const Vec3& p, const Vec3& d) {
  const double along = d.dot(p);
  return std::sqrt(std::max(0.0, along * along - p.squaredNorm() + radius * radius)) - along;
}

double reach(const Capsule& c, const Vec3& p, const Vec3& d) {
  const double t = wallReach(c.radius, p, d);
  const double z = p.z() + t * d.z();
  if (std::abs(z) <= c.half_length) return t;
  return ballReach(c.radius, p - (z < 0 ? -c.half_length : c.half_length) * Vec3::UnitZ(), d);
}
double reach(const Cylinder& c, const Vec3& p, const Vec3& d) {
  return std::min(wallReach(c.radius, p, d), planeReach(c.half_length - signOf(d.z()) * p.z(), std::abs(d.z())));
}
double reach(const CylinderWithFlat& c, const Vec3& p, const Vec3& d) {
  return std::min(reach(Cylinder{c.radius, c.half_length}, p, d), planeReach(c.flat_distance - p.x(), d.x()));
}

}  // namespace

double reachOf(const Shape& shape, const Vec3& p, const Vec3& d) {
  PINCER_ASSERT(isUnitIfFinite(d));
  if (const auto* capsule = std::get_if<Capsule>(&shape)) return reach(*capsule, p, d);
  if (const auto* cylinder = std::get_if<Cylinder>(&shape)) return reach(*cylinder, p, d);
  if (const auto* cut = std::get_if<CylinderWithFlat>(&shape)) return reach(*cut, p, d);
  return d.dot(supportOf(shape, d) - p) + roundingOf(shape);
}

}  // namespace pincer::contact
