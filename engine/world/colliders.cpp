#include "pincer/engine/world/colliders.h"

#include <algorithm>

namespace pincer::engine {
namespace {

// True if `other` lies further than `margin` above `plane`.
bool isAbove(const ColliderModel& plane, const Pose& X_WPlane, const ColliderModel& other, const Vec3& p_W,
             double margin) {
  return isPlane(plane) && (X_WPlane.q * Vec3::UnitZ()).dot(p_W - X_WPlane.p) > other.bounding_radius + margin;
}

}  // namespace

bool mayTouch(const WorldModel& model, int a, int b) {
  const auto shapes_a = collidersOf(model, model.bodies[a]), shapes_b = collidersOf(model, model.bodies[b]);
  return std::any_of(shapes_a.begin(), shapes_a.end(), [&](const ColliderModel& x) {
    return std::any_of(shapes_b.begin(), shapes_b.end(),
                       [&](const ColliderModel& y) { return mayTouch(x.bits, y.bits); });
  });
}

bool areApart(const ColliderModel& a, const Pose& X_WA, const ColliderModel& b, const Pose& X_WB, double margin) {
  const double reach = a.bounding_radius + b.bounding_radius + margin;
  if ((X_WA.p - X_WB.p).squaredNorm() > reach * reach) return true;
  return isAbove(a, X_WA, b, X_WB.p, margin) || isAbove(b, X_WB, a, X_WA.p, margin);
}

}  // namespace pincer::engine
