// devices_calibrate: what `pincer devices calibrate` shares between the kinds of devices.
#pragma once
#include <string>
#include <utility>
#include <vector>

namespace pincer::tasks {

struct CalibrateArguments {
  std::string serial, save, load;
  std::vector<std::string> set;
  std::string devices = "usb", service = "127.0.0.1:10001", grip, align;  // of haply but for the first
  bool here = false;
};

using NamedValue = std::pair<std::string, double>;

// What --load and --set change, in this order; all of it checked before anything is.
std::vector<NamedValue> changesOf(const CalibrateArguments& arguments);

// An Inverse3 keeps nothing: its values are in the file alone.
int calibrateHaply(const CalibrateArguments& arguments);

}  // namespace pincer::tasks
