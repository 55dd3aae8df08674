#include "pincer/tasks/run/servo/servo_text.h"

#include <fmt/format.h>

#include <algorithm>

#include "pincer/tasks/run/measure/timing.h"

namespace pincer::tasks {
namespace {

double inMicroseconds(double seconds) { return 1e6 * seconds; }

std::string percentiles(const char* what, const Histogram& times) {
  return fmt::format("  {:<14}median {:.1f}, 99.9 % <= {:.1f}, largest {:.1f} us", what,
                     inMicroseconds(times.quantile(0.5)), inMicroseconds(times.quantile(0.999)),
                     inMicroseconds(times.largest()));
}

}  // namespace

std::string servoText(const ServoReport& report, double period) {
  const auto due = static_cast<double>(std::max<std::int64_t>(1, report.ticks + report.missed));
  std::string text =
      fmt::format("Real time: {} ticks of {:g} us in {:.1f} s; {} missed ({:.3g} %)\n", report.ticks,
                  inMicroseconds(period), report.wall, report.missed, 100 * static_cast<double>(report.missed) / due);
  text += percentiles("began late by", report.lateness) + "\n" + percentiles("took", report.duration);
  for (const StageTimes& stage : report.stages) text += "\n" + percentiles(("  " + stage.name).c_str(), stage.times);
  if (report.watchdog_tripped)
    text +=
        "\nThe watchdog cut the forces: the loop stalled for longer than it allows. Close other programs, permit "
        "real-time priority "
        "(docs/devices/setup.md), or allow longer stalls with --watchdog.";
  if (!report.note.empty()) text += "\n" + report.note;
  return text;
}

std::string throughputText(double simulated) {
  const double used = processCpuSeconds();
  return fmt::format("Simulated {:.0f} s in {:.1f} s of processor time: {:.0f} times real time", simulated, used,
                     simulated / used);
}

}  // namespace pincer::tasks
