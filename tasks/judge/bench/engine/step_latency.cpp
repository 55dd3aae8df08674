// S9: what single steps of a held ball cost, tail and all, in processor time of this thread: what
// else the machine does isn't the engine's.
#include <algorithm>
#include <cmath>

#include "pincer/contact/error.h"
#include "pincer/tasks/judge/bench/engine/engine_bench.h"
#include "pincer/tasks/run/measure/timing.h"

namespace pincer::tasks {
namespace {

constexpr int kTimedBlocks = 20, kBlockSteps = 1000, kFirstSteps = 500;  // 20,000 steps, after the first 500

struct TimedEngine {
  std::string name;
  std::unique_ptr<BenchEngine> engine;
  std::vector<double> us;

  void run(int steps, double reading) {
    for (int i = 0; i < steps; ++i) {
      const double start = threadCpuSeconds();
      engine->step();
      us.push_back(1e6 * (threadCpuSeconds() - start - reading));
    }
  }
};

double medianReading() {
  std::vector<double> pauses;
  for (int i = 0; i < 1001; ++i) {
    const double start = threadCpuSeconds();
    pauses.push_back(threadCpuSeconds() - start);
  }
  return quantileOf(std::move(pauses), 0.5);
}

std::vector<Record> stepLatencies(const BenchScene& scene, const std::vector<Contestant>& contestants,
                                  MeasureContext& context) {
  std::vector<TimedEngine> engines;
  for (const Contestant& c : contestants) {
    if (!c.ladder.empty() || !c.lacks(scene.world).empty()) continue;  // pincer's tolerance isn't for 1 kHz
    if (c.meant && !c.meant(scene.world)) continue;
    engines.push_back({c.name(), c.make(scene.world, {.h = 1e-3}), {}});
    for (int i = 0; i < kFirstSteps; ++i) engines.back().engine->step();
  }
  const double reading = medianReading();
  for (int block = 0; block < kTimedBlocks && !context.interrupted(); ++block) {  // by turns
    for (TimedEngine& e : engines) e.run(kBlockSteps, reading);
    context.progress(static_cast<double>(block + 1) / kTimedBlocks);
  }
  std::vector<Record> records;
  for (const TimedEngine& e : engines) {
    const bool own = e.name == "pincer";
    records.push_back(atMost(e.name + ": step, median", quantileOf(e.us, 0.5), "us", own ? 0.9 : kInfinity));
    records.push_back(unbounded(e.name + ": step, p99.9", quantileOf(e.us, 0.999), "us"));
  }
  return records;
}

}  // namespace

Measurement stepLatencyMeasurement(std::vector<Contestant> contestants) {
  std::vector<BenchScene> scenes = benchPinchScenes(false);
  const auto hold = std::find_if(scenes.begin(), scenes.end(), [](const BenchScene& s) { return s.name == "s4/hold"; });
  if (hold == scenes.end()) throw InputError("bench engine: the scene s4/hold is missing");
  const auto run = [scene = *hold, contestants = std::move(contestants)](MeasureContext& context) {
    return stepLatencies(scene, contestants, context);
  };
  return {"s9/latency", run};
}

}  // namespace pincer::tasks
