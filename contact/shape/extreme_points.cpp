#include "pincer/contact/shape/extreme_points.h"

#include "pincer/contact/polytope.h"
#include "pincer/contact/shape/convex_features.h"
#include "pincer/contact/smooth_mesh.h"

namespace pincer::contact {
namespace {

ExtremePoints stored(const ExtremePointStore& store, double rounding = 0) {
  const auto count = static_cast<std::size_t>(store.count);
  return {{store.points.data(), count}, {store.features.data(), count}, rounding};
}

// Four points of the rim at height z, but none with x > x_most.
void addRim(const Vec2& first, double z, double x_most, std::uint32_t feature, ExtremePointStore& store) {
  Vec2 p = first;
  for (std::uint32_t k = 0; k < 4; ++k) {
    if (p.x() <= x_most) store.add({p.x(), p.y(), z}, feature + k);
    p = Vec2(-p.y(), p.x());
  }
}

ExtremePoints pointsOf(const Sphere& sphere, const Vec2&, ExtremePointStore& store) {
  store.add(Vec3::Zero(), 0);
  return stored(store, sphere.radius);
}

ExtremePoints pointsOf(const Capsule& capsule, const Vec2&, ExtremePointStore& store) {
  store.add({0, 0, capsule.half_length}, 0);
  if (capsule.half_length > 0) store.add({0, 0, -capsule.half_length}, 1);
  return stored(store, capsule.radius);
}

ExtremePoints pointsOf(const Box& box, const Vec2&, ExtremePointStore& store) {
  const auto at = [](bool positive, double half) { return positive ? half : -half; };
  for (std::uint32_t i = 0; i < 8; ++i)
    store.add({at(i & 1, box.half.x()), at(i & 2, box.half.y()), at(i & 4, box.half.z())}, i);
  return stored(store);
}

ExtremePoints pointsOf(const Cylinder& cylinder, const Vec2& steepest, ExtremePointStore& store) {
  const Vec2 first = startOfRim(cylinder.radius, steepest, kBetweenFour);
  const double everywhere = 2 * cylinder.radius;
  addRim(first, cylinder.half_length, everywhere, 0, store);
  addRim(first, -cylinder.half_length, everywhere, 4, store);
  return stored(store);
}

ExtremePoints pointsOf(const CylinderWithFlat& cylinder, const Vec2& steepest, ExtremePointStore& store) {
  const double h = cylinder.half_length;
  const double d = cylinder.flat_distance;
  const Vec2 first = startOfRim(cylinder.radius, steepest, kBetweenFour);
  addRim(first, h, d, 0, store);
  addRim(first, -h, d, 4, store);
  const double w = std::sqrt((cylinder.radius - d) * (cylinder.radius + d));
  store.add({d, w, h}, 8);
  store.add({d, -w, h}, 9);
  store.add({d, w, -h}, 10);
  store.add({d, -w, -h}, 11);
  return stored(store);
}

ExtremePoints pointsOf(const HalfSpace&, const Vec2&, ExtremePointStore&) { return {}; }
ExtremePoints pointsOf(const Dish&, const Vec2&, ExtremePointStore&) { return {}; }
ExtremePoints pointsOf(const Mesh& mesh, const Vec2&, ExtremePointStore&) {
  return {mesh.surface->hullVertices(), {}, 0};
}

ExtremePoints pointsOf(const Convex& convex, const Vec2&, ExtremePointStore&) {
  return {convex.hull->vertices(), {}, 0};
}

}  // namespace

ExtremePoints extremePoints(const Shape& solid, const Vec2& steepest, ExtremePointStore& store) {
  return std::visit([&](const auto& s) { return pointsOf(s, steepest, store); }, solid);
}

}  // namespace pincer::contact
