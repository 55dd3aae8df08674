#include "pincer/engine/world/contact_sides.h"

#include <algorithm>
#include <cmath>

#include "pincer/contact/functions/invariants.h"
#include "pincer/engine/world/joints.h"
#include "pincer/engine/world/tree_sides.h"

namespace pincer::engine {
namespace {

// Of a point that turns against a spring, about its centre.
void fillTurn(const Contact& c, int rows, double root, ContactSide& out) {
  const Vec3& arm_W = c.a.kind == SideKind::kPoint ? c.arm_a_W : c.arm_b_W;
  for (int k = 0; k < rows; ++k) {
    const Vec3 turn_W = k < kTorsionRow ? Vec3(arm_W.cross(c.R_WC.col(k))) : Vec3(radiusOf(c, k) * axisOf(c, k));
    for (int j = 0; j < 3; ++j) out.A[k][3 + j] = root * turn_W[j];
  }
  out.is_point = false;
}

void fillPointSide(const Contact& c, int rows, double sign, const PointScratch& point, ContactSide& out) {
  const Vec3 root = sign * point.root_inverse_mass;
  for (int k = 0; k < kPointRows; ++k) {
    double* const A = out.A[k];
    for (int j = 0; j < 3; ++j) A[j] = root[j] * (point.turned ? point.R_WA.col(j).dot(c.R_WC.col(k)) : c.R_WC(j, k));
    A[3] = A[4] = A[5] = 0;
  }
  for (int k = kTorsionRow; k < rows; ++k) std::fill(out.A[k], out.A[k] + kMoverFreedoms, 0.0);
  if (rows > kTorsionRow) out.A[kTorsionRow][3] = sign * radiusOf(c, kTorsionRow) * std::sqrt(point.inverse_twist);
  if (point.inverse_turn > 0) fillTurn(c, rows, sign * std::sqrt(point.inverse_turn), out);
}

// F  of a sphere a multiple of the identity
void fillBodySide(const Contact& c, int rows, double sign, const Vec3& arm_W, double root_mass, const Mat3& F,
                  bool is_sphere, ContactSide& out) {
  const double linear = sign * root_mass;
  const double root_inertia = is_sphere ? sign * F(0, 0) : 1;
  const double arm[3] = {root_inertia * arm_W[0], root_inertia * arm_W[1], root_inertia * arm_W[2]};
  for (int k = 0; k < 3; ++k) {
    const double x = c.R_WC(0, k), y = c.R_WC(1, k), z = c.R_WC(2, k);
    const double ang[3] = {arm[1] * z - arm[2] * y, arm[2] * x - arm[0] * z, arm[0] * y - arm[1] * x};
    double* const A = out.A[k];
    A[0] = linear * x;
    A[1] = linear * y;
    A[2] = linear * z;
    for (int j = 0; j < 3; ++j)
      A[3 + j] = is_sphere ? ang[j] : sign * (F(0, j) * ang[0] + F(1, j) * ang[1] + F(2, j) * ang[2]);
  }
  for (int k = kTorsionRow; k < rows; ++k) {
    const Vec3 ang = (sign * radiusOf(c, k)) * axisOf(c, k);
    for (int j = 0; j < 3; ++j) {
      out.A[k][j] = 0;
      out.A[k][3 + j] = F(0, j) * ang[0] + F(1, j) * ang[1] + F(2, j) * ang[2];
    }
  }
}

}  // namespace

Mat3 rootOfInertia(const FreeRotation& rotation, const Quat& q_WI) {
  if (rotation.kind == FreeRotation::Kind::kSpherical) return rotation.root_inverse_moments[0] * Mat3::Identity();
  return q_WI.toRotationMatrix() * rotation.root_inverse_moments.asDiagonal();
}

void fillSide(const WorldModel& model, WorldScratch& scratch, const Contact& c, int rows, bool is_a, int mover,
              int number, const std::vector<Mat3>& root_inertia, ContactSide& out) {
  out.mover = number;
  if (mover < 0) return;
  const Side& side = is_a ? c.a : c.b;
  if (side.kind == SideKind::kJoint || (side.kind == SideKind::kBody && model.bodies[side.index].tree >= 0)) {
    out.is_point = false;
    return fillTreeSide(model, scratch, c, rows, is_a, mover, out);
  }
  out.is_point = side.kind == SideKind::kPoint && rows == kPointRows;
  const double sign = is_a ? 1 : -1;
  if (side.kind == SideKind::kPoint) return fillPointSide(c, rows, sign, scratch.points[side.index], out);
  PINCER_ASSERT(isIndex(mover, root_inertia.size()) && model.bodies[side.index].dynamic);
  const BodyModel& body = model.bodies[side.index];
  const Vec3& arm_W = is_a ? c.arm_a_W : c.arm_b_W;
  if (body.joint_group < 0) {
    const bool is_sphere = body.rotation.kind == FreeRotation::Kind::kSpherical &&
                           !scratch.bodies[static_cast<std::size_t>(side.index)].rocks;
    return fillBodySide(c, rows, sign, arm_W, body.root_inverse_mass, root_inertia[mover], is_sphere, out);
  }
  for (int k = 0; k < rows; ++k) std::fill(out.A[k], out.A[k] + kMoverFreedoms, 0.0);
  addJointedSide(model, scratch, c, rows, sign, side.index, arm_W, out);
}

void addSide(int rows, const ContactSide& from, ContactSide& to) {
  for (int k = 0; k < rows; ++k) {
    for (int j = 0; j < kMoverFreedoms; ++j) to.A[k][j] += from.A[k][j];
  }
  to.is_point = false;
}

void joinSides(int rows, ContactSides& sides) {
  PINCER_ASSERT(sides[0].mover == sides[1].mover);
  addSide(rows, sides[1], sides[0]);
  sides[1].mover = -1;
}

}  // namespace pincer::engine
