#include "pincer/tasks/run/servo/haply_calibration.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "pincer/contact/error.h"

namespace pincer::tasks {
namespace {

using devices::haply::HaplyArmSettings;

double valueOf(const DeviceCalibration& calibration, const char* name, double otherwise) {
  const auto found = calibration.values.find(name);
  return found == calibration.values.end() ? otherwise : found->second;
}

double forceOf(const DeviceCalibration& calibration, const char* name, double otherwise) {
  const double force = valueOf(calibration, name, otherwise);
  if (force > 0 && force <= devices::haply::kMostPeak) return force;
  throw InputError(fmt::format(
      "calibration of {}: {} = {:g} is out of range (0, {:g}] N. Take it from the maker's data sheet, or leave it out.",
      calibration.serial, name, force, devices::haply::kMostPeak));
}

Quat alignmentOf(const DeviceCalibration& calibration, const std::string& grip) {
  if (grip.empty()) return Quat::Identity();
  if (!calibration.values.contains("align_w")) {
    throw InputError(
        fmt::format("calibration of {}: it has no align_w, _x, _y, _z, and VerseGrip {} is to tell the finger's turn. "
                    "Measure it: pincer "
                    "devices calibrate {} --devices haply --grip {} --align index (or thumb); or leave --grips out.",
                    calibration.serial, grip, calibration.serial, grip));
  }
  const Quat q(calibration.values.at("align_w"), valueOf(calibration, "align_x", 0), valueOf(calibration, "align_y", 0),
               valueOf(calibration, "align_z", 0));
  if (std::abs(q.norm() - 1) <= devices::haply::kOffUnit) return q.normalized();
  throw InputError(fmt::format(
      "calibration of {}: align_w, _x, _y, _z have the norm {:g}, and a turn has 1. Measure it again (--align).",
      calibration.serial, q.norm()));
}

}  // namespace

HaplyArmSettings haplyArmOf(const DeviceCalibration& calibration, const std::string& grip) {
  using namespace devices::haply;
  HaplyArmSettings arm;
  arm.id = calibration.serial;
  arm.grip = grip;
  const Vec3 centre = arm.frame.centre_H;
  arm.frame.centre_H = Vec3(valueOf(calibration, "centre_x", centre.x()), valueOf(calibration, "centre_y", centre.y()),
                            valueOf(calibration, "centre_z", centre.z()));
  arm.frame.mount_turn = valueOf(calibration, "mount_turn", 0);
  arm.frame.q_align = alignmentOf(calibration, grip);
  arm.frame.grip_yaw = valueOf(calibration, "grip_yaw", 0);
  const double idle_after = valueOf(calibration, "idle_after", -1);
  const bool soon = idle_after >= 0 && idle_after <= kSoonIdle;
  arm.peak_force = soon ? forceOf(calibration, "peak_force", kPeak) : kCarefulPeak;
  arm.continuous_force = std::min(forceOf(calibration, "continuous_force", kContinuous), arm.peak_force);
  return arm;
}

DeviceCalibration uncalibratedHaply(const std::string& id) {
  const devices::haply::HaplyFrame frame;
  return {id,
          {{"centre_x", frame.centre_H.x()},
           {"centre_y", frame.centre_H.y()},
           {"centre_z", frame.centre_H.z()},
           {"mount_turn", 0},
           {"base_x", 0},
           {"base_y", 0},
           {"base_z", 0},
           {"base_turn", 0}}};
}

}  // namespace pincer::tasks
