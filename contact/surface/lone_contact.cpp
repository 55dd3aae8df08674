#include "contact/surface/lone_contact.h"

#include "contact/surface/surface_search.h"

namespace pincer::contact {

namespace {

constexpr double kTanBeta = LoneContact::kSinBeta / LoneContact::kCosBeta;

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
  setWay(most);
}

void LoneContact::setWay(double way) {
  way_ = way;
  rho_ = reach_ * kSinBeta + way;
  zone_ = std::hypot(rho_, h_ + rho_ * kTanBeta);
  way_lanes_ = atLeast(way_);
  rho_lanes_ = atLeast(rho_);
  zone_lanes_ = atLeast(std::max(zone_, reach_ + way_));
}

LaneMask LoneContact::mayMatter(const std::array<Lanes, 3>& centre, Lanes radius, Lanes hollow, const LaneCones& cones) const {
  constexpr auto cos_beta = static_cast<float>(kCosBeta), sin_beta = static_cast<float>(kSinBeta), tan_beta = static_cast<float>(kTanBeta);
  Lanes distance2{}, along{}, up{}, lean{};
  for (std::size_t k = 0; k < 3; ++k) {
    const Lanes D = x_.x[k] - centre[k];
    distance2 += D * D;
    along += cones.axis[k] * D;
    up += along_.x[k] * D;
    lean += along_.x[k] * cones.axis[k];
  }
  const Lanes R = radius + rounding_, rho = rho_lanes_ + R, zone = zone_lanes_ + R;
  const LaneMask is_gentle = (hollow < hollowest_) & (cones.cosine >= cos_beta) &
                             (lean >= cos_beta * cones.cosine + sin_beta * cones.sine + 2 * LanesPoint::kShare);
  const LaneMask is_beside =
      (distance2 - up * up <= rho * rho + LanesPoint::kShare * distance2) & (LanesPoint::toLanes(h_) - up + R + (rho + R) * tan_beta >= 0);
  return ~is_gentle & (distance2 < zone * zone) & (is_beside | cones.mayFace(along, distance2, R + way_lanes_));
}

// Whether a ball may touch the graph within rho, or what is above it.
bool LoneContact::isBeside(double across, double up, double distance2, double R) const {
  const double zone = zone_ + R;
  return across < rho_ + R && h_ - up + R + (across + R) * kTanBeta >= 0 && distance2 < zone * zone;
}

void LoneContact::show(const PatchBounds& part) {
  const Vec3 D = C_ - part.middle();
  const double up = D.dot(n_), distance2 = D.squaredNorm(), across = std::sqrt(std::max(0.0, distance2 - up * up));
  double way = std::min<double>(way_, part.approach(C_, reach_));
  if (isBeside(across, up, distance2, part.radius)) way = std::min(way, std::max(0.0, across - part.radius - reach_ * kSinBeta));
  if (way < way_) setWay(way);
}

}  // namespace pincer::contact
