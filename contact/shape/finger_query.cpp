#include "contact/shape/finger_query.h"

#include <type_traits>

#include "contact/shape/closed_forms.h"
#include "contact/shape/pair_query.h"
#include "contact/surface/smooth_mesh.h"

namespace pincer::contact {
namespace {

SurfaceContacts contactAt(const NearestPoint& s, double r) {
  SurfaceContacts found;
  found.points[0] = {s.p_BS, s.n_B, s.distance - r, 0};
  found.count = 1;
  return found;
}

}  // namespace

SurfaceContacts querySphere(const Shape& shape, const Vec3& p_BC, double r, double margin, SurfaceTracker& tracker, PatchCache& cache) {
  return std::visit(
      [&](const auto& solid) -> SurfaceContacts {
        if constexpr (std::is_same_v<decltype(solid), const Mesh&>) {
          return solid.surface->querySphere(p_BC, r, margin, tracker, cache);
        } else {
          return contactAt(nearestPoint(solid, p_BC), r);
        }
      },
      shape);
}

double lowerBoundOfGap(const Shape& shape, const Vec3& p_BC, double r) {
  if (const auto* half_space = std::get_if<HalfSpace>(&shape)) return nearestPoint(*half_space, p_BC).distance - r;
  if (const auto* dish = std::get_if<Dish>(&shape)) return nearestPoint(*dish, p_BC).distance - r;
  return p_BC.norm() - boundingRadius(shape) - r;
}

}  // namespace pincer::contact
