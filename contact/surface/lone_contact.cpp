#include "pincer/contact/surface/lone_contact.h"

#include "pincer/contact/functions/invariants.h"
#include "pincer/contact/surface/surface_search.h"

namespace pincer::contact {

namespace {

// Rounded up: what the lanes let through is shown one by one.
Lanes atLeast(double x) { return LanesPoint::toLanes(x * (1 + LanesPoint::kShare)); }

}  // namespace

LoneContact::LoneContact(const Vec3& C, const Vec3& n, double h, double reach, double most, double rounding)
    : C_(C),
      n_(n),
      h_(h),
      reach_(reach),
      x_(C),
      along_(n),
      hollowest_(LanesPoint::toLanes(kFits / reach)),
      rounding_(LanesPoint::toLanes(rounding)) {
  PINCER_ASSERT(isUnitIfFinite(n));
  PINCER_ASSERT(!(reach <= 0) && !(h <= most));
  setWay(most);
}

void LoneContact::setWay(double way) {
  way_ = way;
  rho_ = reach_ * kSinBeta + way;
  zone_ = math::hypot(rho_, h_ + rho_ * kTanBeta);
  way_lanes_ = atLeast(way_);
  rho_lanes_ = atLeast(rho_);
  zone_lanes_ = atLeast(std::max(zone_, reach_ + way_));
}

// True if a ball may touch the graph within rho, or what is above it.
bool LoneContact::isBeside(double across, double up, double distance2, double R) const {
  const double zone = zone_ + R;
  return across < rho_ + R && h_ - up + R + (across + R) * kTanBeta >= 0 && distance2 < zone * zone;
}

void LoneContact::show(const PatchBounds& part) {
  const Vec3 D = C_ - part.middle();
  const double up = D.dot(n_), distance2 = D.squaredNorm(), across = std::sqrt(std::max(0.0, distance2 - up * up));
  double way = std::min<double>(way_, part.approach(C_, reach_));
  if (isBeside(across, up, distance2, part.radius))
    way = std::min(way, std::max(0.0, across - part.radius - reach_ * kSinBeta));
  if (way < way_) setWay(way);
}

}  // namespace pincer::contact
