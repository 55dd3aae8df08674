#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <chrono>
#include <numbers>
#include <thread>

#include "pincer/contact/error.h"
#include "pincer/devices/usb/usb_host.h"
#include "pincer/tasks/run/servo/hand_devices_parts.h"

namespace pincer::tasks {
namespace {

using devices::usb::UsbArm;
using devices::usb::UsbDisplay;
using devices::usb::UsbHost;

std::string listOf(UsbHost& host) {
  std::vector<std::string> names;
  for (UsbArm* arm : host.arms())
    names.push_back(fmt::format("{} ({})", arm->identity(), devices::nameOf(arm->state())));
  for (UsbDisplay* display : host.displays())
    names.push_back(fmt::format("{} ({})", display->identity(), devices::nameOf(display->state())));
  return names.empty() ? "none" : fmt::format("{}", fmt::join(names, ", "));
}

// The finger's device: the one asked for, or the next in the order of the serial numbers.
template <typename Device>
Device* chosenDevice(const std::vector<Device*>& all, const std::vector<std::string>& serials, std::size_t finger,
                     const char* kind) {
  if (finger >= serials.size()) return finger < all.size() ? all[finger] : nullptr;
  const auto found =
      std::find_if(all.begin(), all.end(), [&](Device* d) { return d->deviceIdentity().serial == serials[finger]; });
  if (found != all.end()) return *found;
  throw DeviceError(fmt::format("No {} with serial number {} is plugged in. See which are: pincer devices list", kind,
                                serials[finger]));
}

class UsbHand final : public HandDevices {
 public:
  explicit UsbHand(const DeviceOptions& options) {
    const auto fingers = static_cast<std::size_t>(options.fingers);
    const bool found = host_.waitFor(fingers, options.needs_displays ? fingers : 0, options.timeout);
    if (!found) refuse(options);
    for (std::size_t i = 0; i < fingers; ++i) {
      arms_.push_back(chosenDevice(host_.arms(), options.arms, i, "arm"));
      displays_.push_back(chosenDevice(host_.displays(), options.displays, i, "display"));
      arms_.back()->setDeadline(kArmDeadline * options.watchdog);
    }
    for (UsbArm* arm : arms_) bases_.push_back(armBaseIn(keptCalibration(*arm)));
    for (const std::string& path : options.calibrations) calibrate(path);
  }
  ArmBase base(int finger) const override { return bases_[static_cast<std::size_t>(finger)]; }
  devices::Arm& arm(int finger) override { return *arms_[static_cast<std::size_t>(finger)]; }
  devices::TactileDisplay* display(int finger) override { return displays_[static_cast<std::size_t>(finger)]; }
  void setEpoch(std::int64_t ns) override { host_.setEpoch(ns); }
  void sound(DeviceTone tone) override {
    arms_[0]->signal(static_cast<devices::usb::Signal>(static_cast<int>(tone) + 1));
  }
  std::vector<std::string> describe() override {
    std::vector<std::string> lines;
    for (std::size_t i = 0; i < arms_.size(); ++i) {
      lines.push_back(fmt::format("finger {}: {}, {}{}", i, arms_[i]->identity(),
                                  displays_[i] ? displays_[i]->identity() : "no display", describe(bases_[i])));
    }
    return lines;
  }

 private:
  static std::string describe(const ArmBase& base) {
    if (base.offset_W.isZero(0) && base.turn == 0) return "";
    return fmt::format("; its base is off by {:.1f}, {:.1f}, {:.1f} mm and turned by {:.1f} degrees",
                       1e3 * base.offset_W.x(), 1e3 * base.offset_W.y(), 1e3 * base.offset_W.z(),
                       180 / std::numbers::pi * base.turn);
  }
  // A file counts over what the arm itself keeps.
  void calibrate(const std::string& path) {
    const DeviceCalibration calibration = readCalibration(path);
    const auto found = std::find_if(arms_.begin(), arms_.end(),
                                    [&](UsbArm* a) { return a->deviceIdentity().serial == calibration.serial; });
    if (found == arms_.end()) {
      throw InputError(fmt::format(
          "{}: it is of device {}, and no finger wears that arm. Give the files of the session's arms (found: {}).",
          path, calibration.serial, listOf(host_)));
    }
    bases_[static_cast<std::size_t>(found - arms_.begin())] = armBaseIn(calibration);
  }
  [[noreturn]] void refuse(const DeviceOptions& options) {
    const auto problems = host_.problems();
    std::string why = fmt::format("A session needs {} arms{} on USB; found: {}.", options.fingers,
                                  options.needs_displays ? " and as many displays" : "", listOf(host_));
    for (const std::string& problem : problems) why += "\n" + problem;
    if (problems.empty())
      why += " Plug them in and switch them on; see what is there: pincer devices list (docs/devices/setup.md)";
    throw DeviceError(why);
  }

  std::unique_ptr<UsbHost> own_ = startUsb();
  UsbHost& host_ = *own_;
  std::vector<UsbArm*> arms_;
  std::vector<UsbDisplay*> displays_;
  std::vector<ArmBase> bases_;
};

}  // namespace

std::unique_ptr<HandDevices> openUsbHand(const DeviceOptions& options) { return std::make_unique<UsbHand>(options); }

bool waitUntil(const std::function<bool()>& done, double timeout) {
  const auto until = std::chrono::steady_clock::now() + std::chrono::duration<double>(timeout);
  while (!done()) {
    if (std::chrono::steady_clock::now() > until) return false;
    std::this_thread::sleep_for(std::chrono::milliseconds(2));
  }
  return true;
}

DeviceCalibration keptCalibration(devices::usb::DeviceLink& device) {
  DeviceCalibration kept;
  kept.serial = device.deviceIdentity().serial;
  const auto whole = [&] {
    kept.values = device.calibration();
    return device.calibrationSize() > 0 && kept.values.size() == device.calibrationSize();
  };
  if (!waitUntil([&] { return whole() || device.calibrationSize() > 0; }, 1)) return kept;
  if (!waitUntil(whole, 3)) {
    throw DeviceError(fmt::format("{} tells only {} of its {} calibration values. Unplug it and plug it in again.",
                                  kept.serial, kept.values.size(), device.calibrationSize()));
  }
  for (const auto& [name, value] : kept.values) {
    if (calibrationIsSound(value)) continue;
    throw DeviceError(fmt::format(
        "{}: its calibration value {} = {} is out of range [-10, 10] (m or rad). Set it: pincer devices calibrate "
        "{} --set {}=VALUE",
        kept.serial, name, value, kept.serial, name));
  }
  return kept;
}

std::unique_ptr<UsbHost> startUsb() {
  return withDeviceErrors([] { return std::make_unique<UsbHost>(); });
}

}  // namespace pincer::tasks
