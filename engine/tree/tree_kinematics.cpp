#include "pincer/engine/tree/tree_kinematics.h"

#include "pincer/engine/tree/slot.h"

namespace pincer::engine {
namespace {

double senseOf(const TreeLink& link) { return link.reversed ? -1 : 1; }

Quat turnAbout(double angle) {
  const math::SinCos half = math::sinCos(0.5 * angle);
  return {half.cos, 0, 0, half.sin};
}

// Where the joint's frame is on the side of what carries the link, from O.
Pose carrierOf(const TreeModel& tree, const TreeBase& base, const TreeLink& link, const TreePlace& place) {
  if (link.parent < 0) {
    // The difference first: both may be far from the base's origin.
    return {base.X_WB.q * link.X_PJ.q, base.X_WB.q * (link.X_PJ.p - tree.links.front().X_PJ.p)};
  }
  const LinkPlace& parent = place.links[slot(link.parent)];
  return {parent.q_WL * link.X_PJ.q, parent.p_OL + parent.q_WL * link.X_PJ.p};
}

void placeLink(const Pose& X_OJ, const TreeLink& link, std::span<const double> q, TreePlace& place, LinkPlace& out) {
  Quat q_WJ = X_OJ.q;
  out.p_OJ = X_OJ.p;
  if (link.kind == JointKind::kBall) {
    const double* const turn = &q[slot(link.first_q)];
    q_WJ = X_OJ.q * Quat(turn[0], turn[1], turn[2], turn[3]);
    const Mat3 axes_W = X_OJ.q.toRotationMatrix();
    for (int k = 0; k < 3; ++k) place.coordinates[slot(link.first_v + k)].axis_W = axes_W.col(k);
  } else if (link.kind != JointKind::kWeld) {
    const double way = senseOf(link) * q[slot(link.first_q)];
    const Vec3 z_W = X_OJ.q * Vec3::UnitZ();
    place.coordinates[slot(link.first_v)].axis_W = senseOf(link) * z_W;
    if (link.kind == JointKind::kSlider) out.p_OJ += way * z_W;
    if (link.kind == JointKind::kPivot) q_WJ = X_OJ.q * turnAbout(way);
  }
  out.q_WL = (q_WJ * link.X_LJ.q.conjugate()).normalized();
  out.p_OL = out.p_OJ - out.q_WL * link.X_LJ.p;
}

struct Followed {
  double value, slope, curvature;
};
Followed follow(const std::array<double, 5>& c, double z) {
  Followed f{c.back(), 0, 0};
  for (std::size_t k = c.size() - 1; k-- > 0;) {
    f.curvature = f.curvature * z + 2 * f.slope;
    f.slope = f.slope * z + f.value;
    f.value = f.value * z + c[k];
  }
  return f;
}

}  // namespace

void placeLinks(const TreeModel& tree, const TreeBase& base, std::span<const double> q, TreePlace& place) {
  place.p_WO = base.X_WB * tree.links.front().X_PJ.p;
  for (std::size_t l = 0; l < tree.links.size(); ++l) {
    const TreeLink& link = tree.links[l];
    placeLink(carrierOf(tree, base, link, place), link, q, place, place.links[l]);
  }
  for (std::size_t i = 0; i < tree.coordinates.size(); ++i) {
    const TreeCoordinate& coordinate = tree.coordinates[i];
    if (coordinate.leader < 0) continue;
    place.coordinates[i].share =
        follow(coordinate.polynomial, q[slot(tree.coordinates[slot(coordinate.leader)].q)]).slope;
  }
}

void moveLinks(const TreeModel& tree, const TreeBase& base, std::span<const double> q, std::span<const double> u,
               TreePlace& place) {
  for (std::size_t i = 0; i < tree.coordinates.size(); ++i) {
    const TreeCoordinate& coordinate = tree.coordinates[i];
    if (coordinate.leader < 0) continue;
    const double z = q[slot(tree.coordinates[slot(coordinate.leader)].q)];
    place.coordinates[i].share_rate = follow(coordinate.polynomial, z).curvature * u[slot(coordinate.column)];
  }
  const Vec3 p_OB = base.X_WB.q * -tree.links.front().X_PJ.p;
  for (std::size_t l = 0; l < tree.links.size(); ++l) {
    const TreeLink& link = tree.links[l];
    LinkPlace& out = place.links[l];
    const bool on_base = link.parent < 0;
    const Motion& carrier = on_base ? base.motion : place.links[slot(link.parent)].motion;
    const Vec3& p_OP = on_base ? p_OB : place.links[slot(link.parent)].p_OL;
    out.motion.w_W = carrier.w_W;
    Vec3 v_joint_W = carrier.v_W + carrier.w_W.cross(out.p_OJ - p_OP);
    for (int k = 0; k < coordinatesOf(link.kind); ++k) {
      const CoordinatePlace& coordinate = place.coordinates[slot(link.first_v + k)];
      const double rate = coordinate.share * u[slot(tree.coordinates[slot(link.first_v + k)].column)];
      (link.kind == JointKind::kSlider ? v_joint_W : out.motion.w_W) += rate * coordinate.axis_W;
    }
    out.motion.v_W = v_joint_W + out.motion.w_W.cross(out.p_OL - out.p_OJ);
  }
}

Pose linkPose(const TreePlace& place, int link) {
  return {place.links[slot(link)].q_WL, place.p_WO + place.links[slot(link)].p_OL};
}

void growCoordinates(const TreeModel& tree, std::span<const double> q, std::span<const double> step,
                     std::span<double> out) {
  for (const TreeLink& link : tree.links) {
    if (link.kind == JointKind::kWeld) continue;
    const double* const from = &q[slot(link.first_q)];
    double* const to = &out[slot(link.first_q)];
    if (link.kind != JointKind::kBall) {
      to[0] = from[0] + step[slot(tree.coordinates[slot(link.first_v)].column)];
      continue;
    }
    // a ball's columns are neighbours
    const double* const turn = &step[slot(tree.coordinates[slot(link.first_v)].column)];
    const Quat grown =
        (quatFromRotationVector({turn[0], turn[1], turn[2]}) * Quat(from[0], from[1], from[2], from[3])).normalized();
    to[0] = grown.w(), to[1] = grown.x(), to[2] = grown.y(), to[3] = grown.z();
  }
  if (!tree.has_couplings) return;
  for (const TreeCoordinate& coordinate : tree.coordinates) {
    if (coordinate.leader < 0) continue;
    out[slot(coordinate.q)] =
        follow(coordinate.polynomial, out[slot(tree.coordinates[slot(coordinate.leader)].q)]).value;
  }
}

void ratesOfColumns(const TreeModel& tree, std::span<const double> v, std::span<double> u) {
  for (std::size_t c = 0; c < u.size(); ++c) u[c] = v[slot(tree.column_coordinate[c])];
}

void ratesOfCoordinates(const TreeModel& tree, const TreePlace& place, std::span<const double> u, std::span<double> v) {
  for (std::size_t i = 0; i < v.size(); ++i) v[i] = place.coordinates[i].share * u[slot(tree.coordinates[i].column)];
}

void addJacobian(const TreeModel& tree, const TreePlace& place, int link, const Vec3& p_OX, const Vec3& n_W,
                 const Vec3& m_W, std::span<double> J) {
  forEachCoordinateOf(tree, link, [&](std::size_t i) {
    const Motion unit = unitMotion(tree, place, i, p_OX);
    J[slot(tree.coordinates[i].column)] += place.coordinates[i].share * (n_W.dot(unit.v_W) + m_W.dot(unit.w_W));
  });
}

void addWrench(const TreeModel& tree, const TreePlace& place, int link, const Vec3& f_W, const Vec3& moment_W,
               std::span<double> impulse) {
  addJacobian(tree, place, link, place.links[slot(link)].p_OL, f_W, moment_W, impulse);
}

}  // namespace pincer::engine
