// device_calibration: the values that tell one arm or display from its siblings,
// in a file that a person can read and keep:
//
//   { "device": "A1", "values": { "base_x": -0.25, ... } }     [m] and [rad], each within +-10
#pragma once
#include <map>
#include <string>

#include "pincer/devices/math.h"

namespace pincer::tasks {

struct DeviceCalibration {
  std::string serial;
  std::map<std::string, double> values;  // by name, 1 .. 20 characters each
};

// Where an arm's base stands, off its place in the scene, as the arm itself keeps it or a file says: values base_x,
// base_y, base_z (in W, of its reset place) and base_turn (about W's z).
struct ArmBase {
  Vec3 offset_W = Vec3::Zero();  // [m]
  double turn = 0;               // [rad]
};
ArmBase armBaseIn(const DeviceCalibration& calibration);

// Throws InputError naming line, value, range and remedy.
DeviceCalibration readCalibration(const std::string& path);
void writeCalibration(const DeviceCalibration& calibration, const std::string& path);
bool calibrationIsSound(double value);  // in its range
// Throws InputError for a value out of range.
void checkCalibrationValue(const std::string& name, double value);

}  // namespace pincer::tasks
