#include "pincer/tasks/run/servo/device_calibration.h"

#include <fmt/format.h>

#include <array>
#include <cmath>

#include "pincer/contact/io/atomic_file.h"
#include "pincer/tasks/run/files/file_limits.h"
#include "pincer/tasks/run/files/strict_json.h"

namespace pincer::tasks {
namespace {

// [m, rad]: wider than any desk and than a full turn; chosen.
constexpr NumberRule kCalibrationRule = {.min = -10, .max = 10, .remedy = "Lengths are in metres, angles in radians."};

}  // namespace

ArmBase armBaseIn(const DeviceCalibration& calibration) {
  const auto value = [&](const char* name) {
    const auto found = calibration.values.find(name);
    return found == calibration.values.end() ? 0.0 : found->second;
  };
  return {Vec3(value("base_x"), value("base_y"), value("base_z")), value("base_turn")};
}

DeviceCalibration readCalibration(const std::string& path) {
  const JsonValue json = readJson(path, kCalibrationFile);
  constexpr std::array<std::string_view, 2> kKeys{"device", "values"};  // of a calibration's file
  json.allowOnly(kKeys);
  DeviceCalibration calibration;
  calibration.serial = json.at("device", "The serial number: pincer devices list").text();
  const JsonValue& values = json.at("values", "By name.");
  constexpr std::size_t kMostValues = 64;  // an arm has some 20
  if (values.keys().size() > kMostValues)
    values.reject(fmt::format("has {} values; no device has more than {}.", values.keys().size(), kMostValues));
  for (const std::string& name : values.keys()) {
    if (name.empty() || name.size() > 20) values.at(name).reject("has a name that isn't 1 to 20 characters long.");
    calibration.values[name] = values.at(name).number(kCalibrationRule);
  }
  return calibration;
}

void writeCalibration(const DeviceCalibration& calibration, const std::string& path) {
  std::string text = fmt::format("{{\n  \"device\": \"{}\",\n  \"values\": {{", calibration.serial);
  const char* separator = "\n";
  for (const auto& [name, value] : calibration.values) {
    text += fmt::format("{}    \"{}\": {}", separator, name, value);
    separator = ",\n";
  }
  writeAtomically(path, text + "\n  }\n}\n");
}

bool calibrationIsSound(double value) { return std::abs(value) <= 10; }  // false for NaN

void checkCalibrationValue(const std::string& name, double value) {
  if (calibrationIsSound(value)) return;
  throw InputError(fmt::format(
      "calibration: {} = {} is out of range [-10, 10]. Lengths are in metres, angles in radians.", name, value));
}

}  // namespace pincer::tasks
