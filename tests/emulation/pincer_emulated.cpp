// pincer_emulated: the program pincer with two emulated arms and two emulated displays on its USB
// ports, worn by a simulated participant who picks up the sphere. All in one process, under the real
// libusb, so that a session keeps its millisecond.
#include <fmt/format.h>

#include "pincer/tasks/app/app.h"
#include "pincer/tasks/app/process.h"
#include "pincer/tests/emulation/emulated_bus.h"
#include "pincer/tests/emulation/emulated_hand.h"

namespace pincer::emulation {
namespace {

int run(int argc, char** argv) {
  if (const std::string obstacle = EmulatedBus::obstacle(); !obstacle.empty()) {
    fmt::print(stderr, "pincer_emulated: {}\n", obstacle);
    return tasks::kExitDevice;
  }
  EmulatedBus bus;
  std::vector<std::shared_ptr<ArmFirmware>> arms;
  std::vector<std::shared_ptr<DisplayFirmware>> displays;
  for (const char* serial : {"ARM1", "ARM2"}) bus.add(arms.emplace_back(std::make_shared<ArmFirmware>(serial)));
  for (const char* serial : {"CLD1", "CLD2"}) bus.add(displays.emplace_back(std::make_shared<DisplayFirmware>(serial)));
  EmulatedHand hand(arms, displays);
  bus.runInRealTime([&] {
    const auto locked = [&](int device, const auto& inner) { bus.device(device).with(inner); };
    locked(0, [&] { locked(1, [&] { locked(2, [&] { locked(3, [&] { hand.act(); }); }); }); });
  });
  const int exit_code = tasks::runApp(argc, argv);
  bus.stopRealTime();
  return exit_code;
}

}  // namespace
}  // namespace pincer::emulation

int main(int argc, char** argv) {
  pincer::tasks::prepareProcess();
  return pincer::emulation::run(argc, argv);
}
