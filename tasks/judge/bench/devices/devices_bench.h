// devices_bench: `pincer bench devices`: the simulated devices measured from outside against the published
// figures, the gate against an adversary, and USB with emulated devices under the real libusb (the program
// devices_bench beside this one, built with the tests).
#pragma once
#include <string>
#include <vector>

#include "pincer/tasks/run/measure/measurement.h"

namespace pincer::tasks {

struct DevicesBenchOptions {
  double seconds = 60;  // of two hands at 1 kHz
  int cycles = 1000;    // of pulling out and plugging in
  std::string usb;      // the program that measures USB; empty: devices_bench beside this program
};

std::vector<Measurement> deviceMeasurements(const DevicesBenchOptions& options);

// Its parts, one source file each.
std::vector<Measurement> displayMeasurements();  // the two simulated displays, and what their users notice
std::vector<Measurement> armMeasurements();      // the simulated arm
std::vector<Measurement> gateMeasurements();     // the limiter
std::vector<Measurement> haplyMeasurements(const DevicesBenchOptions& options);  // Inverse3 over the emulated service
std::vector<Measurement> weartMeasurements();  // TouchDIVER over the emulated Middleware
std::vector<Measurement> usbMeasurements(const DevicesBenchOptions& options);

}  // namespace pincer::tasks
