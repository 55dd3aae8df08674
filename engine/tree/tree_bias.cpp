#include "pincer/engine/tree/tree_bias.h"

#include <algorithm>

#include "pincer/engine/tree/slot.h"

namespace pincer::engine {
namespace {

Vec3 momentum(const TreeLink& link, const Quat& q_WL, const Vec3& w_W) {
  return q_WL * link.moments.cwiseProduct(q_WL.conjugate() * w_W);
}

struct Carrier {
  Vec3 p_O, w_W, a_W, alpha_W;
};

// Acceleration that a coordinate's rate adds: the turn or slide past its carrier, whose axis turns with that; its own
// rate changes as its leader's polynomial bends.
void accelerate(const TreeModel& tree, const TreePlace& place, const TreeLink& link, const Carrier& carrier,
                std::span<const double> u, const LinkPlace& moved, LinkBias& out) {
  const Vec3 r_W = moved.p_OJ - carrier.p_O;
  Vec3 a_W = carrier.a_W + carrier.alpha_W.cross(r_W) + carrier.w_W.cross(carrier.w_W.cross(r_W));
  out.alpha_W = carrier.alpha_W;
  for (int k = 0; k < coordinatesOf(link.kind); ++k) {
    const CoordinatePlace& coordinate = place.coordinates[slot(link.first_v + k)];
    const double column_rate = u[slot(tree.coordinates[slot(link.first_v + k)].column)];
    const double rate = coordinate.share * column_rate, change = coordinate.share_rate * column_rate;
    const Vec3 turned = carrier.w_W.cross(coordinate.axis_W);
    if (link.kind == JointKind::kSlider) {
      a_W += 2 * rate * turned + change * coordinate.axis_W;
    } else {
      out.alpha_W += rate * turned + change * coordinate.axis_W;
    }
  }
  const Vec3 arm_W = moved.p_OL - moved.p_OJ;
  out.a_W = a_W + out.alpha_W.cross(arm_W) + moved.motion.w_W.cross(moved.motion.w_W.cross(arm_W));
}

}  // namespace

void fillBias(const TreeModel& tree, const TreePlace& place, const TreeBase& base, const Vec3& gravity_W,
              std::span<const LinkForce> forces, std::span<const double> u, std::span<LinkBias> links,
              std::span<double> C) {
  const Carrier ground{base.X_WB.q * -tree.links.front().X_PJ.p, base.motion.w_W, base.a_W - gravity_W, base.alpha_W};
  for (std::size_t l = 0; l < tree.links.size(); ++l) {
    const TreeLink& link = tree.links[l];
    const LinkPlace& moved = place.links[l];
    LinkBias& out = links[l];
    if (link.parent < 0) {
      accelerate(tree, place, link, ground, u, moved, out);
    } else {
      const LinkPlace& parent = place.links[slot(link.parent)];
      const LinkBias& bias = links[slot(link.parent)];
      accelerate(tree, place, link, {parent.p_OL, parent.motion.w_W, bias.a_W, bias.alpha_W}, u, moved, out);
    }
    out.f_W = link.mass * out.a_W;
    Vec3 moment_W =
        momentum(link, moved.q_WL, out.alpha_W) + moved.motion.w_W.cross(momentum(link, moved.q_WL, moved.motion.w_W));
    if (!forces.empty()) {
      out.f_W -= forces[l].f_W;
      moment_W -= forces[l].tau_W;
    }
    out.moment_W = moment_W + (moved.p_OL - moved.p_OJ).cross(out.f_W);
  }
  std::fill(C.begin(), C.end(), 0.0);
  for (std::size_t l = tree.links.size(); l-- > 0;) {
    const TreeLink& link = tree.links[l];
    const LinkBias& bias = links[l];
    for (int k = 0; k < coordinatesOf(link.kind); ++k) {
      const TreeCoordinate& coordinate = tree.coordinates[slot(link.first_v + k)];
      const CoordinatePlace& moved = place.coordinates[slot(link.first_v + k)];
      const double force = moved.axis_W.dot(link.kind == JointKind::kSlider ? bias.f_W : bias.moment_W);
      const double armature = coordinate.traits.armature * moved.share_rate * u[slot(coordinate.column)];
      C[slot(coordinate.column)] += moved.share * (force + armature);
    }
    if (link.parent < 0) continue;
    LinkBias& parent = links[slot(link.parent)];
    parent.moment_W += bias.moment_W + (place.links[l].p_OJ - place.links[slot(link.parent)].p_OJ).cross(bias.f_W);
    parent.f_W += bias.f_W;
  }
}

}  // namespace pincer::engine
