#include "pincer/contact/shape/pad_contacts.h"

#include "pincer/contact/shape/convex_features.h"
#include "pincer/contact/shape/convex_pairs.h"
#include "pincer/contact/shape/mesh_pairs.h"

namespace pincer::contact {
namespace {

// The support comes nearer by the rounding, and the pad is its core: the points are then half
// the rounding off on either side, along n.
void onSupport(const Shape& core, double rounding, const Pose& X_BF, const Shape& nearer, double margin,
               PatchCache& cache, PairPoints& out) {
  collideShapes(core, X_BF, nearer, Pose{Quat::Identity(), Vec3(0, 0, rounding)}, margin, cache, out);
  for (int i = 0; i < out.count; ++i)
    out.points[static_cast<std::size_t>(i)].p_W -= rounding * out.points[static_cast<std::size_t>(i)].n_W;
}

}  // namespace

void capsuleOnShape(const CapsuleTip& capsule, const Pose& X_BF, const Shape& body, double margin, const Vec3& last_n_B,
                    PairPoints& out) {
  out.count = 0;
  if (std::holds_alternative<Sphere>(body) || !isConvex(body)) return;
  const double half = capsule.half_F.norm();
  const Pose X_BK{X_BF.q * Quat(frameFromNormal(capsule.half_F / half)), X_BF.p};
  collidePadWithConvex(Capsule{capsule.radius, half}, 0, X_BK, body, margin, {last_n_B}, out);
}

void padOnShape(const PadTip& pad, const Pose& X_BF, const Shape& body, double margin, const Vec3& last_n_B,
                PatchCache& cache, PairPoints& out) {
  out.count = 0;
  const Shape core = Convex{pad.hull};
  if (std::holds_alternative<Sphere>(body)) return;
  if (isConvex(body)) return collidePadWithConvex(core, pad.rounding, X_BF, body, margin, {last_n_B}, out);
  if (const auto* mesh = std::get_if<Mesh>(&body))
    return collidePadWithMesh(core, pad.rounding, X_BF, *mesh, margin, out);
  if (const auto* dish = std::get_if<Dish>(&body)) {
    if (!(pad.rounding < dish->radius)) return;
    return onSupport(core, pad.rounding, X_BF, Dish{dish->radius - pad.rounding}, margin, cache, out);
  }
  onSupport(core, pad.rounding, X_BF, HalfSpace{}, margin, cache, out);
}

}  // namespace pincer::contact
