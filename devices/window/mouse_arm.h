// mouse_arm: an arm that is drawn along by the mouse through a spring, so that a force on
// the finger shows, though nobody feels it.
//
//   m a = k (p_hand - p) - b v + f,   b = 2 zeta sqrt(k m)
//
//   p fingertip, p_hand where the person wants it [m], f the force that the arm is told to
//   render [N], in D; m of finger and arm [kg]
//
// Half steps of at most 0.25 ms: a drift, a kick with the forces there, a drift. Position and velocity
// are exact: there is nothing to quantise.
#pragma once
#include "pincer/devices/arm/arm.h"

namespace pincer::devices {

struct MouseArmSettings {
  std::string serial = "mouse";
  Vec3 start_D = Vec3::Zero();  // [m]
  double mass = 0.07;           // m [kg], > 0
  double stiffness = 400;       // k [N/m], > 0: that of a hand (200..600)
  double damping_ratio = 0.9;   // zeta [-], >= 0
  std::optional<Quat> q_DF;     // of the fingertip; absent: unknown
};

class MouseArm final : public Arm {
 public:
  // Throws std::invalid_argument for settings out of range.
  explicit MouseArm(const MouseArmSettings& settings = {});

  std::string identity() const override { return "mouse " + settings_.serial; }
  const ArmCapabilities& capabilities() const override { return capabilities_; }
  DeviceState state() const override { return DeviceState::kReady; }
  ArmSample sample() override;
  void commandForce(const Vec3& f_D) override;

  void setHand(const Vec3& p_hand_D) { p_hand_D_ = p_hand_D; }
  void setOrientation(const Quat& q_DF) { settings_.q_DF = q_DF; }
  // Time moves only here. `dt` > 0 [s].
  void advance(double dt);

  double stiffness() const { return settings_.stiffness; }
  Vec3 place_D() const { return p_D_; }  // [m]
  Vec3 force_D() const { return f_D_; }  // that it renders [N]

 private:
  MouseArmSettings settings_;
  ArmCapabilities capabilities_;
  double time_ = 0;
  Vec3 p_D_, v_D_ = Vec3::Zero(), p_hand_D_, f_D_ = Vec3::Zero();
};

}  // namespace pincer::devices
