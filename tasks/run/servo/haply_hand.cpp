#include <fmt/format.h>

#include <algorithm>
#include <numbers>

#include "pincer/contact/error.h"
#include "pincer/devices/haply/haply_host.h"
#include "pincer/devices/haply/last_zero.h"
#include "pincer/tasks/run/servo/hand_devices_parts.h"
#include "pincer/tasks/run/servo/haply_calibration.h"

namespace pincer::tasks {
namespace {

using devices::haply::HaplyHost;
using devices::haply::HaplyHostOptions;

class HaplyHand final : public HandDevices {
 public:
  explicit HaplyHand(const DeviceOptions& options)
      : calibrations_(calibrationsOf(options)), host_(hostOptions(options)) {
    devices::haply::LastZero::install();
    host_.waitReady(std::max(options.timeout, 5.0));
    for (std::size_t i = 0; i < calibrations_.size(); ++i) bases_.push_back(armBaseIn(calibrations_[i]));
    if (!options.displays.empty()) wearDisplays(options);
  }
  devices::Arm& arm(int finger) override { return host_.arm(static_cast<std::size_t>(finger)); }
  // One of pincer's USB protocol, where the finger wears one.
  devices::TactileDisplay* display(int finger) override {
    return static_cast<std::size_t>(finger) < displays_.size() ? displays_[static_cast<std::size_t>(finger)] : nullptr;
  }
  ArmBase base(int finger) const override { return bases_[static_cast<std::size_t>(finger)]; }
  void setEpoch(std::int64_t ns) override {
    host_.setEpoch(ns);
    if (usb_) usb_->setEpoch(ns);
  }
  std::string complaint() override { return host_.complaint(); }
  std::vector<std::string> describe() override {
    std::vector<std::string> lines;
    for (std::size_t i = 0; i < host_.arms(); ++i) {
      const auto& arm = host_.arm(i).settings();
      lines.push_back(fmt::format("finger {}: Haply Inverse3 {}{}, {:g} N at peak, its mount turned by {:.0f} degrees",
                                  i, arm.id, arm.grip.empty() ? ", no grip" : ", VerseGrip " + arm.grip, arm.peak_force,
                                  180 / std::numbers::pi * arm.frame.mount_turn));
    }
    lines.push_back(fmt::format(
        "Haply's service {}.{}. Nobody here has tried it on hardware yet: the device's power switch is the last stop.",
        host_.version().major, host_.version().minor));
    return lines;
  }

 private:
  // Per finger. How two arms without files stand to each other isn't known; a test of one alone needs none.
  static std::vector<DeviceCalibration> calibrationsOf(const DeviceOptions& options) {
    const auto fingers = static_cast<std::size_t>(options.fingers);
    if (options.arms.size() < fingers)
      throw DeviceError(fmt::format(
          "--devices haply needs the ids of {} Inverse3: --arms 049D,04BA (pincer devices list --devices haply).",
          fingers));
    std::vector<DeviceCalibration> chosen;
    for (std::size_t i = 0; i < fingers; ++i) {
      if (std::count(options.arms.begin(), options.arms.end(), options.arms[i]) > 1)
        throw DeviceError(fmt::format("--arms: two fingers can't hold the same Inverse3, {}.", options.arms[i]));
      chosen.push_back(calibrationOf(options.arms[i], options.calibrations, fingers == 1));
    }
    return chosen;
  }
  static DeviceCalibration calibrationOf(const std::string& id, const std::vector<std::string>& files, bool alone) {
    for (const std::string& path : files) {
      if (DeviceCalibration calibration = readCalibration(path); calibration.serial == id) return calibration;
    }
    if (alone) return uncalibratedHaply(id);
    throw DeviceError(
        fmt::format("Inverse3 {} has no calibration file: how it stands isn't known, and forces would go elsewhere "
                    "than the finger. Make "
                    "one: pincer devices calibrate {} --devices haply --set mount_turn=0 --save {}.json, then "
                    "--calibration {}.json "
                    "(docs/devices/haply.md).",
                    id, id, id, id));
  }
  void wearDisplays(const DeviceOptions& options) {
    usb_ = startUsb();
    usb_->waitFor(0, options.displays.size(), options.timeout);
    for (const std::string& serial : options.displays) {
      const auto all = usb_->displays();
      const auto found =
          std::find_if(all.begin(), all.end(), [&](const auto* d) { return d->deviceIdentity().serial == serial; });
      if (found == all.end())
        throw DeviceError(
            fmt::format("No display with serial number {} is plugged in. See which are: pincer devices list", serial));
      displays_.push_back(*found);
    }
  }
  HaplyHostOptions hostOptions(const DeviceOptions& options) const {
    HaplyHostOptions host;
    const auto place = devices::haply::servicePlaceOf(options.service);
    if (!place)
      throw InputError(fmt::format(
          "--service {}: it isn't HOST:PORT or HOST:PORT:EVENTS on this computer, as 127.0.0.1:10001:10020.",
          options.service));
    host.service = *place;
    host.gate_gain = options.force_gate;
    for (std::size_t i = 0; i < calibrations_.size(); ++i)
      host.arms.push_back(haplyArmOf(calibrations_[i], i < options.grips.size() ? options.grips[i] : ""));
    return host;
  }

  std::vector<DeviceCalibration> calibrations_;
  HaplyHost host_;
  std::vector<ArmBase> bases_;
  std::unique_ptr<devices::usb::UsbHost> usb_;  // of displays alone
  std::vector<devices::TactileDisplay*> displays_;
};

}  // namespace

std::unique_ptr<HandDevices> openHaplyHand(const DeviceOptions& options) {
  return withDeviceErrors([&] { return std::make_unique<HaplyHand>(options); });
}

}  // namespace pincer::tasks
