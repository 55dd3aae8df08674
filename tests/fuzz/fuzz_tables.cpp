#include "pincer/tasks/lab/sweep/variation.h"
#include "pincer/tasks/run/servo/device_calibration.h"
#include "pincer/tasks/run/servo/hand_devices.h"
#include "pincer/tasks/run/trajectory.h"
#include "pincer/tests/fuzz/demand.h"
#include "pincer/tests/fuzz/input_on_disk.h"
#include "pincer/tests/fuzz/targets.h"

namespace pincer::fuzz {

using namespace tasks;

void trajectory(Bytes input) {
  static const InputOnDisk file("trajectory.csv");
  file.write(textOf(input));
  readsOrRefuses([&] {
    const Trajectory read = readTrajectoryCsv(file.path());
    for (int i = -1; i <= 5; ++i)
      demand(read.at(0.25 * i * read.end()).p_W.allFinite(), "places on the way are finite");
  });
}

void calibration(Bytes input) {
  static const InputOnDisk file("calibration.json");
  file.write(textOf(input));
  readsOrRefuses([&] {
    const DeviceCalibration read = readCalibration(file.path());
    for (const auto& [name, value] : read.values)
      demand(calibrationIsSound(value) && !name.empty() && name.size() <= 20, "values have a name and are in range");
    armBaseIn(read);
  });
}

void recording(Bytes input) {
  static const InputOnDisk file("recording.csv");
  file.write(textOf(input));
  readsOrRefuses([&] {
    DeviceOptions options;
    options.choice = DeviceChoice::kReplay;
    options.recording = file.path();
    const auto hand = openHandDevices(options);
    for (int i = 0; i <= 4; ++i) {
      hand->advanceTo(0.3 * i);
      for (int finger = 0; finger < options.fingers; ++finger)
        demand(hand->arm(finger).sample().p_DF.allFinite(), "a recorded finger is somewhere");
    }
  });
}

void sweep_cases(Bytes input) {
  static const InputOnDisk file("cases.csv");
  constexpr std::size_t kMost = 1000;
  file.write(textOf(input));
  readsOrRefuses([&] {
    const SweepGrid grid = readCases(file.path(), kMost);
    demand(grid.points.size() <= kMost, "no more cases than are allowed");
    for (const auto& point : grid.points)
      demand(point.size() == grid.paths.size(), "a case has a value for every path");
  });
  readsOrRefuses([&] { crossed({parseVariation(std::string(textOf(input)))}, kMost); });
}

}  // namespace pincer::fuzz
