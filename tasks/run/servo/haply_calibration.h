// haply_calibration: what a calibration file (device_calibration.h) says of an Inverse3, besides where its base stands:
//
//   centre_x, centre_y, centre_z   middle of the workspace in the service's space [m]
//   mount_turn                     of the mount about the vertical [rad]
//   align_w, _x, _y, _z            from the grip's axes to the finger's, a unit quaternion; needed where a grip is used
//   grip_yaw                       how far the grip's yaw has drifted since it was aligned [rad]
//   idle_after                     so soon does the arm go idle by itself, measured by `devices test --silence` [s]
//   peak_force, continuous_force   from the maker's data sheet [N], (0, 8.5]
#pragma once
#include "pincer/devices/haply/haply_arm.h"
#include "pincer/tasks/run/servo/device_calibration.h"

namespace pincer::tasks {

// Throws InputError naming value, range and remedy.
devices::haply::HaplyArmSettings haplyArmOf(const DeviceCalibration& calibration, const std::string& grip);

// The values of an arm that nobody calibrated yet.
DeviceCalibration uncalibratedHaply(const std::string& id);

}  // namespace pincer::tasks
