#include "devices/usb/usb_display.h"

namespace pincer::devices::usb {

std::string UsbDisplay::identity() const { return deviceIdentity().model + " " + deviceIdentity().serial; }

TactileSample UsbDisplay::sample() {
  readings_.take();
  const auto& [state, sent_ns] = readings_.latest();
  TactileSample sample;
  sample.time = sinceEpoch(sent_ns);
  sample.valid = linkState() == DeviceState::kReady && state.valid;
  if (sample.valid) sample.place_L = state.place_L;
  return sample;
}

bool UsbDisplay::command(const TactileCommand& command) {
  const Vec2 wanted = command.parked ? Vec2::Zero() : command.place_L;
  if (!wanted.allFinite()) return true;
  const Vec2 reachable = wanted.cwiseMax(-capabilities_.reach).cwiseMin(capabilities_.reach);
  commands_.put({reachable, command.parked, kPlaceDeadline, Signal::kNone});
  waker_.wake();
  return reachable != wanted;
}

bool UsbDisplay::takeState(const Frame& frame, std::int64_t sent) {
  const auto state = displayStateIn(frame);
  if (!state) return false;
  readings_.put({*state, sent});
  answered(state->answers);
  return true;
}

bool UsbDisplay::takeCapabilities(const Frame& frame) {
  const auto capabilities = displayCapabilitiesIn(frame);
  if (!capabilities) return false;
  if (!has_capabilities_) capabilities_ = *capabilities;
  return has_capabilities_ = true;
}

bool UsbDisplay::takeCommand(Frame& frame) {
  if (!commands_.take()) return false;
  frame = toFrame(commands_.latest());
  return true;
}

}  // namespace pincer::devices::usb
