#include "pincer/devices/arm/arm.h"

#include <cmath>

namespace pincer::devices {

std::string nameOf(DeviceState state) {
  switch (state) {
    case DeviceState::kClosed:
      return "closed";
    case DeviceState::kConnecting:
      return "connecting";
    case DeviceState::kHoming:
      return "homing";
    case DeviceState::kReady:
      return "ready";
    case DeviceState::kFaulted:
      return "faulted";
  }
  return "unknown";
}

bool isFinite(const ArmSample& sample) {
  return std::isfinite(sample.time) && sample.p_DF.allFinite() && (!sample.v_DF || sample.v_DF->allFinite()) &&
         (!sample.q_DF || sample.q_DF->coeffs().allFinite()) && (!sample.J || sample.J->allFinite());
}

}  // namespace pincer::devices
