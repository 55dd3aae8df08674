#include "pincer/contact/finger_query.h"

#include <type_traits>

#include "pincer/contact/functions/invariants.h"
#include "pincer/contact/pair_query.h"
#include "pincer/contact/shape/closed_forms.h"
#include "pincer/contact/shape/core_descent.h"
#include "pincer/contact/shape/pad_query.h"
#include "pincer/contact/shape/tolerances.h"
#include "pincer/contact/smooth_mesh.h"

namespace pincer::contact {
namespace {

SurfaceContacts contactAt(const NearestPoint& s, double r) {
  SurfaceContacts found;
  PINCER_ASSERT(isUnitIfFinite(s.n_B));
  found.points[0] = {s.p_BS, s.n_B, s.distance - r, 0};
  found.count = 1;
  return found;
}

}  // namespace

SurfaceContacts querySphere(const Shape& shape, const Vec3& p_BC, double r, double margin, SurfaceTracker& tracker,
                            PatchCache& cache) {
  PINCER_ASSERT(r >= 0 && !(margin < 0));
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

namespace {

void add(const SurfaceContact& point, std::uint32_t ball, FingerContacts& out) {
  PINCER_ASSERT(out.count < kMaxFingerContacts);
  const auto i = static_cast<std::size_t>(out.count++);
  out.points[i] = point;
  out.points[i].feature = ball * kMaxSurfaceContacts + point.feature;
  out.p_BT[i] = point.p_BS + point.phi * point.n_B;
}

// A capsule's ends that come within the margin, where they aren't the deepest place `c_F` themselves.
void addEnds(const Shape& shape, const CapsuleTip& capsule, const Pose& X_BF, double margin, const Vec3& c_F,
             FingerTracker& tracker, PatchCache& cache, FingerContacts& out) {
  for (const std::uint32_t end : {1u, 2u}) {
    const Vec3 c_end = (end == 1 ? -1.0 : 1.0) * capsule.half_F;
    if ((c_end - c_F).norm() < kOnePoint * capsule.half_F.norm()) continue;
    ++out.queries;
    const SurfaceContact point =
        querySphere(shape, X_BF * c_end, capsule.radius, margin, tracker.feet[end - 1].ball, cache).main();
    if (point.phi < margin) add(point, end, out);
  }
}

}  // namespace

FingerContacts queryFinger(const Shape& shape, const FingerShape& finger, const Pose& X_BF, double margin,
                           FingerTracker& tracker, PatchCache& cache) {
  PINCER_ASSERT(isUnitIfFinite(X_BF.q));
  std::uint32_t memory = tracker.main.ball.memory;
  for (CoreTracker& foot : tracker.feet) foot.ball.memory = ++memory;
  if (std::holds_alternative<PadTip>(finger)) return queryPad(shape, finger, X_BF, margin, tracker, cache);
  FingerContacts out;
  const auto* const capsule = std::get_if<CapsuleTip>(&finger);
  const bool is_on_solid = capsule && !std::holds_alternative<Mesh>(shape);
  if (is_on_solid && touchOnFacets(shape, finger, X_BF, margin, tracker, cache, out)) return out;
  const CoreDescent deepest = descend(shape, finger, X_BF, margin, tracker.main, cache);
  out.queries = deepest.queries;
  for (int i = 0; i < deepest.found.count; ++i) add(deepest.found.points[static_cast<std::size_t>(i)], 0, out);
  if (capsule) addEnds(shape, *capsule, X_BF, margin, deepest.c_F, tracker, cache, out);
  return out;
}

double lowerBoundOfGap(const Shape& shape, const Vec3& p_BC, double r) {
  if (const auto* half_space = std::get_if<HalfSpace>(&shape)) return nearestPoint(*half_space, p_BC).distance - r;
  if (const auto* dish = std::get_if<Dish>(&shape)) return nearestPoint(*dish, p_BC).distance - r;
  return p_BC.norm() - boundingRadius(shape) - r;
}

}  // namespace pincer::contact
