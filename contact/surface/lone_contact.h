// lone_contact: how far a finger's centre may move before anything but the contact that it has can
// matter, where the surface around is gentle.
//
//   A part is gentle where all its normals are within beta of the contact's n and no concave curvature is sharper than
//   kFits / reach. Until the centre C has moved by `way`, other contacts face it from parts that are
//     not gentle:  as any part is looked for (near_parts.h), with its own `approach`, or
//     gentle:      no further than rho = reach sin beta + way from the line through C along n.
//   Where nothing else than gentle parts comes within rho of that line, from C to below the contact as deep
//   as slopes of tan beta may lead from it, the closed surface is one graph over the plane across n there.
//   Along it the squared distance from C is convex, for kFits / cos^3 beta < 1: the contact is its only
//   minimum, and hides what lies below. So that
//
//   way = min over the parts that aren't gentle of
//         max( its least distance from that line - reach sin beta,  0 )  and of  its approach
//
//   C  centre, n  unit normal of the contact, h  its height over the contact [m]
//   reach  how far from C contacts are wanted [m]; frame B
#pragma once
#include "pincer/contact/surface/four_lanes.h"

namespace pincer::contact {

struct PatchBounds;

class LoneContact {
 public:
  static constexpr double kCosBeta = 0.8660254037844387, kSinBeta = 0.5, kTanBeta = kSinBeta / kCosBeta;  // 30 degrees
  static constexpr double kFits = 0.6;  // [-]: 0.6 / cos^3 beta = 0.92 < 1

  // `most` [m]: no longer way is asked for; it should be less than h. `rounding` is what
  // single precision may move a distance by [m].
  LoneContact(const Vec3& C, const Vec3& n, double h, double reach, double most, double rounding);

  double way() const { return way_; }  // [m], >= 0: by the parts shown so far
  // Which of four balls with normal cones may shorten the way.
  LaneMask mayMatter(const std::array<Lanes, 3>& centre, Lanes radius, Lanes hollow, const LaneCones& cones) const;
  void show(const PatchBounds& part);

 private:
  void setWay(double way);
  bool isBeside(double across, double up, double distance2, double R) const;

  const Vec3 C_, n_;
  const double h_, reach_;
  double way_, rho_, zone_;  // [m]; zone: from C to the furthest of what may lie on the graph within rho

  const LanesPoint x_, along_;
  const Lanes hollowest_, rounding_;
  Lanes way_lanes_, rho_lanes_, zone_lanes_;
};

inline LaneMask LoneContact::mayMatter(const std::array<Lanes, 3>& centre, Lanes radius, Lanes hollow,
                                       const LaneCones& cones) const {
  constexpr auto cos_beta = static_cast<float>(kCosBeta), sin_beta = static_cast<float>(kSinBeta),
                 tan_beta = static_cast<float>(kTanBeta);
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
  const LaneMask is_beside = (distance2 - up * up <= rho * rho + LanesPoint::kShare * distance2) &
                             (LanesPoint::toLanes(h_) - up + R + (rho + R) * tan_beta >= 0);
  return ~is_gentle & (distance2 < zone * zone) & (is_beside | cones.mayFace(along, distance2, R + way_lanes_));
}

}  // namespace pincer::contact
