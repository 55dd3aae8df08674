#include "pincer/devices/usb/usb_display.h"

namespace pincer::devices::usb {

TactileSample UsbDisplay::sample() {
  const auto& [state, sent_ns] = latestReading();
  TactileSample sample;
  sample.time = sinceEpoch(sent_ns);
  sample.valid = linkState() == DeviceState::kReady && state.valid;
  if (sample.valid) sample.place_L = state.place_L;
  return sample;
}

bool UsbDisplay::command(const TactileCommand& command) {
  const Vec2 wanted = command.parked ? Vec2::Zero() : command.place_L;
  if (!wanted.allFinite()) return true;
  const Vec2& reach = capabilities().reach;
  const Vec2 reachable = wanted.cwiseMax(-reach).cwiseMin(reach);
  post({reachable, command.parked, kPlaceDeadline, Signal::kNone});
  return reachable != wanted;
}

}  // namespace pincer::devices::usb
