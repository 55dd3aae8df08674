#include "pincer/devices/emulate/haply_plant.h"

#include <algorithm>

namespace pincer::devices::emulate {
namespace {

constexpr double kLoop = 0.25e-3;  // of the device's own control [s]
constexpr double kReversed = 0.1;  // after a change of sign a force oscillates for so long [s]

Vec3 inSinglePrecision(const Vec3& v) { return v.cast<float>().cast<double>(); }

SimArmSettings plantOf(const HaplyPlantSettings& settings) {
  SimArmSettings arm;
  arm.serial = settings.id;
  arm.payload = 0;  // a knob: it is in the arm's own mass
  arm.peak_force = settings.peak_force;
  return arm;
}

}  // namespace

HaplyPlant::HaplyPlant(const HaplyPlantSettings& settings) : settings_(settings), arm_(plantOf(settings)) {}

Vec3 HaplyPlant::toH(const Vec3& v_D) const {
  const double c = math::cos(settings_.turn), s = math::sin(settings_.turn);
  const double x = v_D.x(), y = -v_D.z();
  return {c * x + s * y, -s * x + c * y, v_D.y()};
}

Vec3 HaplyPlant::toD(const Vec3& v_H) const {
  const double c = math::cos(settings_.turn), s = math::sin(settings_.turn);
  return {c * v_H.x() - s * v_H.y(), v_H.z(), -(s * v_H.x() + c * v_H.y())};
}

void HaplyPlant::command(const Vec3& f_H, double share) {
  if (f_H.dot(asked_H_) < 0) since_reversal_ = 0;
  if (!f_H.isZero(0)) asked_H_ = f_H;
  const Vec3 passed_H = since_reversal_ < kReversed ? Vec3(share * f_H) : f_H;
  const double size = passed_H.norm();
  f_D_ = toD(size > settings_.peak_force ? Vec3(passed_H * settings_.peak_force / size) : passed_H);
  since_command_ = 0;
  idle_ = false;
}

void HaplyPlant::sessionEnded() {
  if (settings_.dead_man != DeadMan::kZeroOnClose) return;
  f_D_.setZero();
  idle_ = true;
}

void HaplyPlant::advance(double dt) {
  for (double left = dt; left > 1e-9; left -= kLoop) {
    const double h = std::min(left, kLoop);
    since_command_ += h;
    since_reversal_ += h;
    grip_yaw_ += settings_.grip_drift * h;
    if (settings_.dead_man == DeadMan::kIdleAfter && since_command_ > settings_.idle_after) {
      f_D_.setZero();
      idle_ = true;
    }
    arm_.commandForce(f_D_);
    arm_.advance(h);
  }
}

Vec3 HaplyPlant::place_H() { return inSinglePrecision(settings_.centre_H + toH(arm_.sample().p_DF)); }

Vec3 HaplyPlant::velocity_H() const { return inSinglePrecision(toH(arm_.trueVelocity_D())); }

Vec3 HaplyPlant::force_H() const { return inSinglePrecision(toH(f_D_)); }

Quat HaplyPlant::grip_H() {
  Mat3 R_HD;
  R_HD << toH(Vec3::UnitX()), toH(Vec3::UnitY()), toH(Vec3::UnitZ());
  const Quat drifted{math::cos(0.5 * grip_yaw_), 0, 0, math::sin(0.5 * grip_yaw_)};
  return (drifted * Quat(R_HD) * arm_.sample().q_DF.value_or(Quat::Identity())).normalized();
}

}  // namespace pincer::devices::emulate
