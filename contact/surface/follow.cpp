#include "pincer/contact/surface/follow.h"

#include "pincer/contact/surface/flat_contact.h"
#include "pincer/contact/surface/published_iteration.h"
#include "pincer/contact/surface/shell_edge.h"
#include "pincer/contact/surface/surface_search.h"
#include "pincer/contact/surface/tolerances.h"

namespace pincer::contact {

ShellContact follow(const FeltSurface& surface, const Vec3& C, double r, const Foot& start) {
  switch (surface.variant) {
    case SurfaceVariant::smooth:
      return solveShell(surface.net, surface.cache, C, start);
    case SurfaceVariant::facet:
    case SurfaceVariant::force:
      return followFlat(surface.net, C, start);
    case SurfaceVariant::smooth_published:
      return followPublished(surface.net, surface.cache, C, r, start);
  }
  return {};
}

ShellContact followSlot(const FeltSurface& surface, const Vec3& C, double r, const Vec3& dC, const SurfaceSlot& slot) {
  const Foot start = footOf(slot);
  if (surface.variant == SurfaceVariant::smooth && knowsMotion(slot)) {
    const ShellContact beside = solveShellBeside(surface.net, surface.cache, C, start, {slot.du, slot.dv}, dC);
    if (beside.converged) return beside;
  }
  return follow(surface, C, r, start);
}

bool isFarSide(const FeltSurface& surface, const Vec3& C, double r, const SurfaceSlot& from,
               const ShellContact& contact) {
  return contact.h < 0 && tangentContact(surface.net, surface.cache, C, footOf(from)).h > kWellAbove * r;
}

ShellContact straightTo(const FeltSurface& surface, const Vec3& C, const SurfaceSeed& seed) {
  const PatchPoint x =
      evaluate(surface.net.cell(seed.foot.triangle, surface.cache).patch, seed.foot.b[1], seed.foot.b[2]);
  const double sign = (C - x.S).dot(x.N) < 0 ? -1 : 1;
  return {seed.foot, sign / seed.distance * (C - x.S), sign * seed.distance, seed.distance > 0, {}};
}

namespace {

bool isOnBorder(const SurfaceNet& net, const Foot& foot) {
  constexpr double kOn = 1e-12;  // of a barycentric coordinate
  for (int i = 0; i < 3; ++i) {
    if (foot.b[static_cast<std::size_t>((i + 2) % 3)] < kOn && net.neighbour(foot.triangle, i).triangle < 0)
      return true;
    if (foot.b[static_cast<std::size_t>(i)] > 1 - kOn && net.visitCorners({foot.triangle, i}, [](const CellCorner&) {}))
      return true;
  }
  return false;
}

}  // namespace

std::optional<ShellContact> wireUnder(const FeltSurface& surface, const Vec3& C, double r, const SurfaceSlot& slot) {
  constexpr double kAtPoint = 1e-6;  // of r: nearer to a point of a border the direction to it is lost
  if (!isOnBorder(surface.net, footOf(slot))) return std::nullopt;
  const FeatureContact wire = contactWithPoint(C, slot.p_BS, slot.n_B, true, kAtPoint * r);
  return ShellContact{footOf(slot), wire.n, wire.h, true, {}};
}

}  // namespace pincer::contact
