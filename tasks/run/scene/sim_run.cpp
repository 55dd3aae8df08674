#include "pincer/tasks/run/scene/sim_run.h"

#include <fmt/format.h>

#include <memory>

#include "pincer/contact/error.h"
#include "pincer/contact/io/atomic_file.h"
#include "pincer/tasks/run/csv.h"

namespace pincer::tasks {
namespace {

// The recorded quantities as CSV: time, then one column each, unit in the heading. Without a file it does nothing.
class CsvRecorder {
 public:
  CsvRecorder(const std::string& path, const Recording& record) : record_(record) {
    if (path.empty()) return;
    file_ = std::make_unique<AtomicFile>(path);
    table_.add("time [s]");
    for (const Quantity& quantity : record.quantities)
      table_.add(fmt::format("{} [{}]", quantity.name, quantity.kind->unit));
    table_.endRow();
  }

  void observe(std::int64_t tick, double time, const Moment& moment) {
    if (!file_ || tick % record_.every != 0) return;
    table_.add(time);
    for (const Quantity& quantity : record_.quantities) table_.add(quantity.measure(moment));
    table_.endRow();
    constexpr std::size_t kBlock = 1 << 16;  // [bytes] that are written at once; chosen
    if (table_.text().size() <= kBlock) return;
    file_->write(table_.text());
    table_ = {};
  }

  void finish() {
    if (!file_) return;
    file_->write(table_.take());
    file_->commit();
  }

 private:
  const Recording& record_;
  std::unique_ptr<AtomicFile> file_;
  CsvTable table_;
};

std::int64_t ticksOf(const char* option, double seconds, double tick) {
  const std::int64_t ticks = wholeTicks(seconds, tick);
  if (ticks >= 1) return ticks;
  throw InputError(fmt::format("{} = {} isn't a positive whole number of ticks of {} s, which this scene has.", option,
                               seconds, tick));
}

}  // namespace

void applyOptions(const SimOptions& options, Scene& scene) {
  if (options.awake) scene.options.sleep = false;
  if (options.every) scene.record.every = ticksOf("--every", *options.every, scene.options.h);
  if (options.duration) {
    ticksOf("--duration", *options.duration, scene.options.h);
    scene.duration = *options.duration;
  }
  if (!options.csv.empty() && scene.record.quantities.empty()) {
    throw InputError(fmt::format(
        "{}: there is nothing to write to --out: the scene has no \"record\" with quantities (docs/scenes.md).",
        scene.file));
  }
}

SimResult runScene(Simulation& simulation, const SimOptions& options, const std::atomic<bool>& interrupted,
                   const std::function<void(std::int64_t)>& progress) {
  const Scene& scene = simulation.scene();
  SimResult result{ExpectationLog(scene.expectations), TickTimes(scene.ticks()), {}, scene.ticks(), false, {}, false};
  result.overlaps = overlapsAtStart(simulation.model().world, simulation.state().world);
  CsvRecorder csv(options.csv, scene.record);
  const auto observe = [&] {
    result.log.observe(simulation.ticks(), simulation.time(), simulation.moment());
    csv.observe(simulation.ticks(), simulation.time(), simulation.moment());
  };
  observe();
  while (simulation.ticks() < result.ticks_wanted && !result.interrupted && !result.broke) {
    engine::StepReport report;
    result.times.time([&] { report = simulation.tick(); });
    result.statuses.add(report.status);
    observe();
    progress(simulation.ticks());
    result.broke = (report.status & engine::kStateNotFinite) != 0;
    result.interrupted = interrupted.load(std::memory_order_relaxed);
  }
  csv.finish();
  return result;
}

}  // namespace pincer::tasks
