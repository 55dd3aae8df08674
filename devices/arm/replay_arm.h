// replay_arm: an arm whose fingertip goes where a recorded one went; forces reach nobody.
//
//   p_DF(t) between two recorded places on the straight line; before the first it waits
//   there, after the last its samples are invalid
//
// So a session, a scene or a tick can be run again on what a person did, as often as one likes; a
// finger that was recorded doesn't give way.
#pragma once
#include <string>
#include <vector>

#include "pincer/devices/arm/arm.h"

namespace pincer::devices {

struct ReplayPoint {
  double time = 0;           // [s], growing
  Vec3 p_DF = Vec3::Zero();  // [m]
};

class ReplayArm final : public Arm {
 public:
  // Throws std::invalid_argument for no points, times that don't grow, or places that aren't numbers.
  ReplayArm(std::string name, std::vector<ReplayPoint> points);

  std::string identity() const override { return "recording " + name_; }
  const ArmCapabilities& capabilities() const override { return capabilities_; }
  DeviceState state() const override { return DeviceState::kReady; }
  ArmSample sample() override { return sample_; }
  void commandForce(const Vec3&) override {}

  // `time` on the recording's clock [s]; may go anywhere.
  void moveTo(double time);
  double duration() const { return points_.back().time; }  // [s]

 private:
  std::string name_;
  std::vector<ReplayPoint> points_;
  ArmCapabilities capabilities_;
  ArmSample sample_;
};

}  // namespace pincer::devices
