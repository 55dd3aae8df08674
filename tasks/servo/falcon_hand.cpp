#include <fmt/format.h>

#include <fstream>
#include <iterator>

#include "contact/error.h"
#include "devices/falcon/falcon_arm.h"
#include "tasks/servo/hand_devices_parts.h"

namespace pincer::tasks {
namespace {

std::vector<std::uint8_t> imageIn(const std::string& path) {
  if (path.empty()) return {};
  std::ifstream file(path, std::ios::binary);
  if (!file) throw InputError(path + ": there is no such file. --firmware is the Falcon's image, out of its maker's driver.");
  return {std::istreambuf_iterator<char>(file), std::istreambuf_iterator<char>()};
}

class FalconHand final : public HandDevices {
 public:
  explicit FalconHand(const DeviceOptions& options) : arm_(devices::falcon::openFalconPort(), imageIn(options.firmware)) {}
  devices::Arm& arm(int) override { return arm_; }
  devices::TactileDisplay* display(int) override { return nullptr; }
  void setEpoch(std::int64_t ns) override { arm_.setEpoch(ns); }
  std::vector<std::string> describe() override {
    return {"Novint Falcon: push the grip all the way in and out once, so that it finds its zero."};
  }

 private:
  devices::falcon::FalconArm arm_;
};

}  // namespace

std::unique_ptr<HandDevices> openFalconHand(const DeviceOptions& options) {
  if (options.fingers != 1) {
    throw DeviceError(
        fmt::format("A session with {} fingers needs as many arms, and a Falcon is one. Take --devices usb.", options.fingers));
  }
  try {
    return std::make_unique<FalconHand>(options);
  } catch (const InputError&) {
    throw;
  } catch (const std::runtime_error& error) {
    throw DeviceError(error.what());
  }
}

}  // namespace pincer::tasks
