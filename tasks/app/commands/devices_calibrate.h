// devices_calibrate: what `pincer devices calibrate` shares between the kinds of devices.
#pragma once
#include <string>
#include <utility>
#include <vector>

namespace pincer::tasks {

struct CalibrateArguments {
  std::string serial, save, load;
  std::vector<std::string> set;
  std::string devices = "usb", service = "127.0.0.1:10001", grip, align, undrift;  // of haply but for the first
  std::vector<std::string> calibrations;                                           // of both arms, for `touch`
  bool here = false, touch = false;
};

using NamedValue = std::pair<std::string, double>;

// The changes of --load and --set, in this order; all of them checked before any is made.
std::vector<NamedValue> changesOf(const CalibrateArguments& arguments);

// An Inverse3 keeps nothing: its values are in the file alone.
int calibrateHaply(const CalibrateArguments& arguments);
// Finds where the second of two Inverse3 stands beside the first.
int calibrateByTouch(const CalibrateArguments& arguments);

}  // namespace pincer::tasks
