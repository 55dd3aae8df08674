// sim_settings: what the simulated devices share in checking their settings and counting time.
#pragma once
#include <stdexcept>
#include <string>

namespace pincer::devices {

constexpr double kTimeRounding = 1e-9;  // of sums of time steps [s]

// Throws std::invalid_argument, naming device, field, value and range, unless `ok`.
inline void requireSetting(const char* device, bool ok, const char* field, double value, const char* range) {
  if (ok) return;
  throw std::invalid_argument(std::string(device) + ": " + field + " = " + std::to_string(value) + " is out of range " +
                              range + ". Leave it out for the default.");
}

}  // namespace pincer::devices
