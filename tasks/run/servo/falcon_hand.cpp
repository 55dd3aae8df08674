#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>

#include "pincer/contact/error.h"
#include "pincer/devices/falcon/falcon_arm.h"
#include "pincer/tasks/run/files/file_limits.h"
#include "pincer/tasks/run/servo/hand_devices_parts.h"

namespace pincer::tasks {
namespace {

using devices::falcon::FalconArm;
using devices::falcon::FalconPlace;

std::vector<std::uint8_t> imageIn(const std::string& path) {
  if (path.empty()) return {};
  const std::string image = readInputFile(path, kFirmwareFile);
  return {image.begin(), image.end()};
}

std::string nameOf(const FalconPlace& place) {
  return place.serial.empty() ? place.port : fmt::format("{} (serial {})", place.port, place.serial);
}

std::string listOf(const std::vector<FalconPlace>& places) {
  std::vector<std::string> names;
  for (const FalconPlace& place : places) names.push_back(nameOf(place));
  return names.empty() ? "none" : fmt::format("{}", fmt::join(names, ", "));
}

// Of each finger's Falcon: those asked for by port or serial number, or the first ones.
std::vector<FalconPlace> chosenFalcons(const DeviceOptions& options) {
  const std::vector<FalconPlace> places = devices::falcon::listFalcons();
  const auto fingers = static_cast<std::size_t>(options.fingers);
  if (places.size() < fingers) {
    throw DeviceError(fmt::format(
        "A session with {} fingers needs {} Novint Falcons; found: {}. Plug them in, and check their power supplies.",
        fingers, fingers, listOf(places)));
  }
  std::vector<FalconPlace> chosen;
  for (std::size_t i = 0; i < fingers; ++i) {
    const auto found = std::find_if(places.begin(), places.end(), [&](const FalconPlace& place) {
      if (i < options.arms.size())
        return place.port == options.arms[i] || (!place.serial.empty() && place.serial == options.arms[i]);
      return std::none_of(chosen.begin(), chosen.end(), [&](const FalconPlace& c) { return c.port == place.port; });
    });
    if (found == places.end()) {
      throw DeviceError(fmt::format("No Falcon is at the port, or has the serial number, \"{}\"; found: {}.",
                                    options.arms[i], listOf(places)));
    }
    chosen.push_back(*found);
    if (std::count_if(chosen.begin(), chosen.end(), [&](const FalconPlace& c) { return c.port == found->port; }) > 1)
      throw DeviceError(fmt::format("--arms: two fingers can't wear the same Falcon, {}. Found: {}.", nameOf(*found),
                                    listOf(places)));
  }
  return chosen;
}

class FalconHand final : public HandDevices {
 public:
  explicit FalconHand(const DeviceOptions& options) : places_(chosenFalcons(options)), bases_(places_.size()) {
    const auto image = imageIn(options.firmware);
    for (const FalconPlace& place : places_)
      arms_.push_back(std::make_unique<FalconArm>(devices::falcon::openFalconPort(place.port), image));
    for (const std::string& path : options.calibrations) calibrate(path);
  }
  devices::Arm& arm(int finger) override { return *arms_[static_cast<std::size_t>(finger)]; }
  devices::TactileDisplay* display(int) override { return nullptr; }
  ArmBase base(int finger) const override { return bases_[static_cast<std::size_t>(finger)]; }
  void setEpoch(std::int64_t ns) override {
    for (const auto& arm : arms_) arm->setEpoch(ns);
  }
  std::vector<std::string> describe() override {
    std::vector<std::string> lines;
    for (std::size_t i = 0; i < arms_.size(); ++i)
      lines.push_back(fmt::format("finger {}: Novint Falcon at {}", i, nameOf(places_[i])));
    lines.push_back("Push each grip all the way in and out once, so that its encoders find their zero.");
    return lines;
  }

 private:
  void calibrate(const std::string& path) {
    const DeviceCalibration calibration = readCalibration(path);
    const auto found = std::find_if(places_.begin(), places_.end(), [&](const FalconPlace& place) {
      return place.port == calibration.serial || place.serial == calibration.serial;
    });
    if (found == places_.end()) {
      throw InputError(fmt::format(
          "{}: it is of device {}, and no finger wears that Falcon. Give the files of the session's (worn: {}).", path,
          calibration.serial, listOf(places_)));
    }
    bases_[static_cast<std::size_t>(found - places_.begin())] = armBaseIn(calibration);
  }

  std::vector<FalconPlace> places_;
  std::vector<ArmBase> bases_;
  std::vector<std::unique_ptr<FalconArm>> arms_;
};

}  // namespace

std::unique_ptr<HandDevices> openFalconHand(const DeviceOptions& options) {
  return withDeviceErrors([&] { return std::make_unique<FalconHand>(options); });
}

}  // namespace pincer::tasks
