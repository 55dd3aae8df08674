// WEART's TouchDIVER over the emulated Middleware, in this process.
#include <algorithm>
#include <array>
#include <chrono>
#include <limits>
#include <thread>

#include "pincer/devices/emulate/weart_middleware.h"
#include "pincer/devices/usb/usb_bus.h"
#include "pincer/devices/weart/weart_host.h"
#include "pincer/tasks/judge/bench/devices/devices_bench.h"

namespace pincer::tasks {
namespace {

using devices::emulate::WeartMiddleware;
using devices::weart::WeartHost;

constexpr int kPresses = 21;                   // odd for their median; chosen
constexpr const char* kIndex = "RIGHT:INDEX";  // the middleware's name of the right hand's index finger

// From a new force to its level, and from the last force to zero: medians of kPresses [ms].
std::vector<Record> pressures(MeasureContext& context) {
  WeartMiddleware middleware;
  WeartHost host({.port = middleware.port()});
  std::array<double, kPresses> to_level{}, to_zero{};
  const auto pause = [] { std::this_thread::sleep_for(std::chrono::milliseconds(1)); };
  const auto since = [&](std::int64_t begin) { return 1e-6 * static_cast<double>(middleware.since(kIndex) - begin); };
  for (std::size_t k = 0; k < kPresses && !context.interrupted(); ++k) {
    context.progress(static_cast<double>(k) / kPresses);
    const std::int64_t begin = devices::usb::monotonicNs();
    std::int64_t last = begin;
    for (int i = 0; i < 5000 && middleware.level(kIndex) == 0; ++i) {
      last = devices::usb::monotonicNs();
      host.display(0).press(1);
      pause();
    }
    to_level[k] = since(begin);
    for (int i = 0; i < 5000 && middleware.level(kIndex) != 0; ++i) pause();
    to_zero[k] = middleware.level(kIndex) == 0 ? since(last) : std::numeric_limits<double>::infinity();
  }
  std::sort(to_level.begin(), to_level.end());
  std::sort(to_zero.begin(), to_zero.end());
  return {atMost("from a force to its level, median", to_level[kPresses / 2], "ms", 20),
          atMost("from the last force of a loop that stands still to zero, median", to_zero[kPresses / 2], "ms", 120)};
}

}  // namespace

std::vector<Measurement> weartMeasurements() { return {{"weart/pressure", pressures}}; }

}  // namespace pincer::tasks
