// Nearest points of the surfaces at constant distance from a point, a segment or a plane.
#include "pincer/contact/functions/invariants.h"
#include "pincer/contact/shape/closed_forms.h"
#include "pincer/contact/shape/direction.h"

namespace pincer::contact {

NearestPoint nearestPoint(const Sphere& sphere, const Vec3& p_BC) {
  PINCER_ASSERT(sphere.radius > 0);
  const auto [n, length] = directionOf<Vec3>(p_BC, Vec3::UnitZ());
  return {sphere.radius * n, n, length - sphere.radius};
}

NearestPoint nearestPoint(const Capsule& capsule, const Vec3& p_BC) {
  PINCER_ASSERT(capsule.radius > 0 && capsule.half_length >= 0);
  const double h = capsule.half_length;
  const Vec3 p_BA(0, 0, std::min(std::max(p_BC.z(), -h), h));  // nearest point of the axis
  const auto [n, length] = directionOf<Vec3>(p_BC - p_BA, Vec3::UnitX());
  return {p_BA + capsule.radius * n, n, length - capsule.radius};
}

NearestPoint nearestPoint(const HalfSpace&, const Vec3& p_BC) {
  return {{p_BC.x(), p_BC.y(), 0}, Vec3::UnitZ(), p_BC.z()};
}

NearestPoint nearestPoint(const Dish& dish, const Vec3& p_BC) {
  PINCER_ASSERT(dish.radius > 0);
  const Vec3 p_BM(0, 0, dish.radius);  // centre of curvature
  const auto [n, length] = directionOf<Vec3>(p_BM - p_BC, Vec3::UnitZ());
  return {p_BM - dish.radius * n, n, dish.radius - length};
}

}  // namespace pincer::contact
