#include "devices/arm/arm.h"

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

}  // namespace pincer::devices
