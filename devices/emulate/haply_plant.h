// haply_plant: an Inverse3 that isn't there: a simulated arm (devices/arm), seen through the place and the turn of its
// base in the frame H of Haply's service, with what stands between the service and its motors.
//
//   p_H = c + Rz(-turn) (x, -z, y)_D         its own words for the mapping, so that the driver's can be wrong
//
// All numbers that the service tells are of single precision, as there. Dead man: the fate of the last force when
// commands end isn't documented; so it is a setting.
#pragma once
#include <string>

#include "pincer/devices/arm/sim_arm.h"

namespace pincer::devices::emulate {

enum class DeadMan : std::uint8_t { kKeepsForEver, kIdleAfter, kZeroOnClose };

struct HaplyPlantSettings {
  std::string id = "049D", grip = "1605";
  std::string type = "inverse3";
  Vec3 centre_H{0, -0.17, 0.16};  // of the workspace [m]
  double turn = 0;                // of the mount about H's z [rad]
  DeadMan dead_man = DeadMan::kIdleAfter;
  double idle_after = 0.1;  // [s]
  double peak_force = 8;    // [N]
  double grip_drift = 0;    // of the grip's yaw, about H's z [rad/s]
};

class HaplyPlant {
 public:
  explicit HaplyPlant(const HaplyPlantSettings& settings);

  // Scaled already. `share` of a force gets through while its sign changed less than 0.1 s ago.
  void command(const Vec3& f_H, double share = 1);
  void sessionEnded();
  void advance(double dt);

  const HaplyPlantSettings& settings() const { return settings_; }
  SimArm& arm() { return arm_; }
  Vec3 place_H();           // as its encoders tell it [m]
  Vec3 velocity_H() const;  // [m/s]
  Quat grip_H();            // of the handle's grip
  Vec3 force_H() const;     // that the motors are told [N]
  Vec3 force_D() const { return f_D_; }
  bool idle() const { return idle_; }

 private:
  Vec3 toH(const Vec3& v_D) const;
  Vec3 toD(const Vec3& v_H) const;

  HaplyPlantSettings settings_;
  SimArm arm_;
  Vec3 f_D_ = Vec3::Zero();
  Vec3 asked_H_ = Vec3::Zero();                     // the last force that wasn't zero
  double since_command_ = 0, since_reversal_ = 10;  // [s]
  double grip_yaw_ = 0;                             // so far has it drifted [rad]
  bool idle_ = true;
};

}  // namespace pincer::devices::emulate
