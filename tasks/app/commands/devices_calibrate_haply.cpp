#include <fmt/format.h>

#include <CLI/CLI.hpp>
#include <algorithm>
#include <memory>

#include "pincer/contact/error.h"
#include "pincer/contact/math.h"
#include "pincer/devices/haply/haply_host.h"
#include "pincer/tasks/app/app.h"
#include "pincer/tasks/app/commands/devices_calibrate.h"
#include "pincer/tasks/app/print.h"
#include "pincer/tasks/app/usage.h"
#include "pincer/tasks/lab/experiments/pickup_object.h"
#include "pincer/tasks/lab/experiments/pickup_scene.h"
#include "pincer/tasks/run/servo/hand_devices_parts.h"
#include "pincer/tasks/run/servo/haply_calibration.h"

namespace pincer::tasks {
namespace {

using devices::haply::HaplyArmSettings;
using devices::haply::HaplyHost;

constexpr int kLooks = 500;  // at the arm, a millisecond apart

struct Stance {
  Vec3 p_DF = Vec3::Zero();
  Quat q_DF = Quat::Identity();
};

// Where the arm is, seen through `settings`: the mean of half a second in which nobody moves it.
Stance stanceOf(const CalibrateArguments& arguments, const HaplyArmSettings& settings) {
  const auto place = devices::haply::servicePlaceOf(arguments.service);
  if (!place)
    refuseUsage(
        fmt::format("--service {}: it isn't HOST:PORT or HOST:PORT:EVENTS on this computer", arguments.service));
  return withDeviceErrors([&] {
    HaplyHost host({.service = *place, .arms = {settings}});
    host.waitReady(10);
    Stance stance;
    double farthest = 0;
    for (int i = 0; i < kLooks; ++i) {
      const devices::ArmSample sample = host.arm(0).sample();
      if (!sample.valid) throw DeviceError(fmt::format("Inverse3 {}: {}", settings.id, host.complaint()));
      stance.p_DF += sample.p_DF / kLooks;
      farthest = std::max(farthest, (sample.p_DF - stance.p_DF * kLooks / (i + 1.0)).norm());
      if (sample.q_DF) stance.q_DF = *sample.q_DF;
      waitUntil([] { return false; }, 1e-3);
    }
    constexpr double kStill = 2e-3;  // [m]
    if (farthest > kStill)
      throw DeviceError(
          fmt::format("Inverse3 {} moved by {:.1f} mm meanwhile. Hold it still.", settings.id, 1e3 * farthest));
    return stance;
  });
}

// The middle of the workspace becomes where the arm is now.
void putHere(const CalibrateArguments& arguments, DeviceCalibration& calibration) {
  const HaplyArmSettings settings = haplyArmOf(calibration, "");
  const Vec3 centre_H =
      settings.frame.centre_H + devices::haply::HaplyMap(settings.frame).force(stanceOf(arguments, settings).p_DF);
  calibration.values["centre_x"] = centre_H.x();
  calibration.values["centre_y"] = centre_H.y();
  calibration.values["centre_z"] = centre_H.z();
}

// Of the finger in the scene: pad towards the other finger, pointing away from the operator.
Quat turnOf(const std::string& finger) {
  const SpherePickupOptions options;
  const HandScene scene = makePickupScene(options, makePickupObject(options), PickupTrialSpec{});
  return scene.q_DF[finger == "index" ? 0 : 1];
}

// The grip's turn of now becomes the finger's in the scene.
void align(const CalibrateArguments& arguments, DeviceCalibration& calibration) {
  HaplyArmSettings settings = haplyArmOf(calibration, "");
  settings.grip = arguments.grip;
  settings.frame.q_align = Quat::Identity();
  settings.frame.grip_yaw = calibration.values["grip_yaw"] = 0;
  const Quat q = (stanceOf(arguments, settings).q_DF.conjugate() * turnOf(arguments.align)).normalized();
  calibration.values["align_w"] = q.w();
  calibration.values["align_x"] = q.x();
  calibration.values["align_y"] = q.y();
  calibration.values["align_z"] = q.z();
}

// The drift of an aligned grip's yaw is what its turn of now is off about the vertical.
void takeOutDrift(const CalibrateArguments& arguments, DeviceCalibration& calibration) {
  constexpr double kMostTilt = 0.2;  // of a hand that holds it as in the scene [rad]
  HaplyArmSettings settings = haplyArmOf(calibration, arguments.grip);
  settings.frame.grip_yaw = 0;
  const auto [yaw, tilt] = devices::haply::gripDrift(stanceOf(arguments, settings).q_DF, turnOf(arguments.undrift));
  if (tilt > kMostTilt)
    throw DeviceError(
        fmt::format("VerseGrip {} is tilted by {:.0f} degrees besides its yaw, which no drift explains. Hold the "
                    "finger as in the scene, "
                    "level; if the grip sits in its handle otherwise than before: --align.",
                    arguments.grip, tilt / kDegree));
  calibration.values["grip_yaw"] = yaw;
}

}  // namespace

int calibrateHaply(const CalibrateArguments& arguments) {
  if (!devices::haply::Label::of(arguments.serial))
    refuseUsage(fmt::format("\"{}\" isn't the id of an Inverse3, as 049D", arguments.serial));
  DeviceCalibration calibration = uncalibratedHaply(arguments.serial);
  for (const auto& [name, value] : changesOf(arguments)) calibration.values[name] = value;
  haplyArmOf(calibration, "");  // names what is out of range
  if (arguments.here) putHere(arguments, calibration);
  if (arguments.grip.empty() && !(arguments.align + arguments.undrift).empty())
    refuseUsage("--align and --undrift need the VerseGrip that is the arm's handle: --grip 1605");
  if (!arguments.align.empty()) align(arguments, calibration);
  if (!arguments.undrift.empty()) takeOutDrift(arguments, calibration);
  for (const auto& [name, value] : calibration.values) print("{:<20} {}\n", name, value);
  if (!arguments.save.empty()) writeCalibration(calibration, arguments.save);
  return kExitOk;
}

}  // namespace pincer::tasks
