// A hand of any devices, with WEART's TouchDIVER on its fingers besides.
#include <fmt/format.h>

#include <charconv>
#include <stdexcept>
#include <utility>

#include "pincer/contact/error.h"
#include "pincer/devices/weart/weart_host.h"
#include "pincer/tasks/run/servo/hand_devices_parts.h"

namespace pincer::tasks {
namespace {

using devices::weart::HandSide;
using devices::weart::Thimble;
using devices::weart::WeartHost;
using devices::weart::WeartOptions;

WeartOptions weartOf(const DeviceOptions& options) {
  WeartOptions weart;
  const std::size_t colon = options.pressure.rfind(':');
  const char* const end = options.pressure.data() + options.pressure.size();
  const char* const digits = colon == std::string::npos ? end : options.pressure.data() + colon + 1;
  const auto read = std::from_chars(digits, end, weart.port);
  if (colon == 0 || colon == std::string::npos || read.ec != std::errc{} || read.ptr != end || weart.port == 0)
    throw InputError(fmt::format(
        "--pressure {}: it isn't HOST:PORT. WEART's Middleware listens at 13031: --pressure 127.0.0.1:13031.",
        options.pressure));
  weart.host = options.pressure.substr(0, colon);
  weart.hand = options.pressure_hand == "left" ? HandSide::kLeft : HandSide::kRight;
  weart.thimbles = {Thimble::kIndex, Thimble::kThumb};
  weart.thimbles.resize(static_cast<std::size_t>(options.fingers));
  weart.full_force = options.full_pressure;
  return weart;
}

class PressedHand final : public HandDevices {
 public:
  PressedHand(std::unique_ptr<HandDevices> hand, const DeviceOptions& options)
      : hand_(std::move(hand)), options_(options), weart_(weartOf(options)) {}
  devices::Arm& arm(int finger) override { return hand_->arm(finger); }
  devices::TactileDisplay* display(int finger) override { return hand_->display(finger); }
  devices::PressureDisplay* pressure(int finger) override { return &weart_.display(static_cast<std::size_t>(finger)); }
  void setEpoch(std::int64_t ns) override { hand_->setEpoch(ns); }
  void advanceTo(double now) override { hand_->advanceTo(now); }
  void sound(DeviceTone tone) override { hand_->sound(tone); }
  ArmBase base(int finger) const override { return hand_->base(finger); }
  void setBase(int finger, const Vec3& p_W, const Quat& q_W) override { hand_->setBase(finger, p_W, q_W); }
  std::string complaint() override {
    const std::string arms = hand_->complaint();
    return arms.empty() ? weart_.complaint() : arms;
  }
  std::vector<std::string> describe() override {
    std::vector<std::string> lines = hand_->describe();
    lines.push_back(
        fmt::format("WEART TouchDIVER on the {} hand, by {}: pressure without a place, its highest level at {:g} N of "
                    "normal force. Nobody "
                    "here has tried it on "
                    "hardware yet.",
                    options_.pressure_hand, options_.pressure, options_.full_pressure));
    return lines;
  }

 private:
  std::unique_ptr<HandDevices> hand_;
  DeviceOptions options_;
  WeartHost weart_;
};

}  // namespace

std::unique_ptr<HandDevices> openPressedHand(std::unique_ptr<HandDevices> hand, const DeviceOptions& options) {
  return withDeviceErrors([&] { return std::make_unique<PressedHand>(std::move(hand), options); });
}

}  // namespace pincer::tasks
