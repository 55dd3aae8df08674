#include "pincer/devices/window/mouse_arm.h"

#include <algorithm>
#include <cmath>

#include "pincer/devices/sim_settings.h"

namespace pincer::devices {
namespace {

constexpr double kLongestMouseStep = 0.25e-3;  // [s]
constexpr double kMostForce = 8.5;             // [N]

ArmCapabilities mouseCapabilities() {
  ArmCapabilities c;
  c.peak_force = c.continuous_force = kMostForce;
  c.resolution = 1e-6;
  c.stiffness_limit = 3500;
  c.workspace_min_D.setConstant(-0.5);
  c.workspace_max_D.setConstant(0.5);
  return c;
}

}  // namespace

MouseArm::MouseArm(const MouseArmSettings& settings)
    : settings_(settings), capabilities_(mouseCapabilities()), p_D_(settings.start_D), p_hand_D_(settings.start_D) {
  requireSetting("mouse arm", settings.mass >= 0.01 && settings.mass <= 1, "mass", settings.mass, "[0.01, 1] kg");
  requireSetting("mouse arm", settings.stiffness >= 10 && settings.stiffness <= 2000, "stiffness", settings.stiffness,
                 "[10, 2000] N/m");
  requireSetting("mouse arm", settings.damping_ratio >= 0 && settings.damping_ratio <= 2, "damping_ratio",
                 settings.damping_ratio, "[0, 2]");
}

ArmSample MouseArm::sample() {
  ArmSample sample;
  sample.time = time_;
  sample.valid = true;
  sample.p_DF = p_D_;
  sample.v_DF = v_D_;
  sample.q_DF = settings_.q_DF;
  return sample;
}

void MouseArm::commandForce(const Vec3& f_D) {
  const double size = f_D.norm();
  f_D_ = std::isfinite(size) ? Vec3(f_D * std::min(1.0, kMostForce / std::max(size, kMostForce))) : Vec3::Zero();
}

void MouseArm::advance(double dt) {
  const int steps = std::max(1, static_cast<int>(std::ceil(dt / kLongestMouseStep - kTimeRounding)));
  const double h = dt / steps, b = 2 * settings_.damping_ratio * std::sqrt(settings_.stiffness * settings_.mass);
  for (int i = 0; i < steps; ++i) {
    p_D_ += 0.5 * h * v_D_;
    const Vec3 f = settings_.stiffness * (p_hand_D_ - p_D_) + f_D_;
    // damping taken at the end: stable whatever it is
    v_D_ = (v_D_ + h / settings_.mass * f) / (1 + h * b / settings_.mass);
    p_D_ += 0.5 * h * v_D_;
  }
  time_ += dt;
}

}  // namespace pincer::devices
