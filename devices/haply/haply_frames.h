// haply_frames: from the service's space H to pincer's frame D of an arm, and back.
//
//   p_DF = R_DH (p_H - c),   f_H = R_DH^T f_D,   q_DF = R_DH Rz(-grip_yaw) q_grip q_align
//   R_DH = [1 0 0; 0 0 1; 0 -1 0] Rz(mount_turn)
//
// H (preset "defaults"): z up, x right, the arm reaches to -y. D: z where the arm reaches, y up. c is the middle of the
// workspace; mount_turn is 0 for arms that face each other; side by side before the operator -pi/2 (index finger) and
// +pi/2 (thumb). q_align turns the grip's own axes to the finger's, and stays as long as the grip sits in its handle as
// it does. A grip's yaw, about the vertical, may drift: grip_yaw. Another q_align would take a drift out where the
// finger points now, and be wrong elsewhere by up to the drift times the turn from there.
#pragma once
#include "pincer/devices/math.h"

namespace pincer::devices::haply {

struct HaplyFrame {
  Vec3 centre_H{0, -0.17, 0.16};  // [m]
  double mount_turn = 0;          // [rad]
  Quat q_align = Quat::Identity();
  double grip_yaw = 0;  // how far it has drifted [rad]
};

// From the turn that a finger has to the one that is told: about the vertical, and what is left of it, which no drift
// explains [rad].
struct GripDrift {
  double yaw = 0, tilt = 0;  // -pi .. pi, 0 .. pi
};
GripDrift gripDrift(const Quat& told_DF, const Quat& q_DF);

class HaplyMap {
 public:
  explicit HaplyMap(const HaplyFrame& frame = {});
  Vec3 place(const Vec3& p_H) const { return R_DH_ * (p_H - centre_H_); }
  Vec3 velocity(const Vec3& v_H) const { return R_DH_ * v_H; }
  Quat turn(const Quat& q_grip) const { return (q_DG_ * q_grip * q_align_).normalized(); }
  Vec3 force(const Vec3& f_D) const { return R_DH_.transpose() * f_D; }

 private:
  Mat3 R_DH_;
  Quat q_DG_, q_align_;  // G: H as the grip has it, drifted
  Vec3 centre_H_;
};

}  // namespace pincer::devices::haply
