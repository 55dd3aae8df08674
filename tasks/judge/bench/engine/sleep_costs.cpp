// Cost of bodies at rest beside one that moves: boxes on a floor, and one that slides for ever where there is no
// friction. With islands that sleep and without, by turns: each runs the same ticks, to the bit.
#include <fmt/format.h>

#include "pincer/engine/step.h"
#include "pincer/tasks/judge/bench/engine/engine_bench.h"
#include "pincer/tasks/run/measure/timing.h"

namespace pincer::tasks {
namespace {

constexpr int kComingToRest = 200, kTimedTicks = 200;  // [ticks] before the clock runs, and timed; chosen

class RestingBoxes {
 public:
  RestingBoxes(int count, bool sleep)
      : model_(boxes(count, sleep)), state_(startOf(model_)), scratch_(engine::makeScratch(model_)) {
    run(kComingToRest);
  }
  void run(int ticks) {
    for (int i = 0; i < ticks; ++i) flagged_ += engine::step(model_, state_, *scratch_).status != engine::kStepOk;
  }
  std::uint64_t hash() const { return engine::hashOf(state_); }
  int flagged() const { return flagged_; }

 private:
  static engine::WorldModel boxes(int count, bool sleep) {
    engine::WorldOptions options;
    options.sleep = sleep;
    options.max_contacts = 4 * count + 64;
    engine::WorldBuilder builder(options);
    builder.addBody({"floor", contact::HalfSpace{}, false, 0, {}});
    for (int i = 0; i <= count; ++i)
      builder.addBody({fmt::format("box{}", i), contact::Box{Vec3::Constant(0.01)}, true, 0.1, {}});
    builder.setPairMaterial(0, count + 1, {0, 0});
    return builder.build();
  }
  static engine::WorldState startOf(const engine::WorldModel& model) {
    constexpr int kPerRow = 10;      // boxes of a row, kApart from each other
    constexpr double kApart = 0.05;  // [m]
    std::vector<engine::BodyStart> starts(1);
    for (int i = 0; i + 1 < static_cast<int>(model.bodies.size()); ++i)
      starts.push_back({{Quat::Identity(), Vec3(kApart * (i % kPerRow), -kApart * (i / kPerRow), 0.01)},
                        Vec3::Zero(),
                        Vec3::Zero()});
    starts.back().X_WB.p = Vec3(0, kApart, 0.01);
    starts.back().v_W.x() = 0.1;
    return engine::makeState(model, starts, {});
  }

  engine::WorldModel model_;
  engine::WorldState state_;
  engine::ScratchHandle scratch_;
  int flagged_ = 0;
};

std::vector<Record> sleepCosts(int rounds, MeasureContext& context) {
  std::vector<Record> records;
  for (const int count : {10, 100, 1000}) {
    RestingBoxes asleep(count, true), awake(count, false);
    double asleep_us = kInfinity, awake_us = kInfinity;
    for (int round = 0; round < rounds && !context.interrupted(); ++round) {
      const double start = threadCpuSeconds();
      asleep.run(kTimedTicks);
      const double middle = threadCpuSeconds();
      awake.run(kTimedTicks);
      asleep_us = std::min(asleep_us, 1e6 / kTimedTicks * (middle - start));
      awake_us = std::min(awake_us, 1e6 / kTimedTicks * (threadCpuSeconds() - middle));
    }
    const std::string name = fmt::format("a box that slides beside {} at rest", count);
    records.push_back(unbounded(name + ": tick", asleep_us, "us"));
    records.push_back(unbounded(name + ": tick without sleep", awake_us, "us"));
    records.push_back(atMost(name + ": of its cost without sleep", asleep_us / awake_us, "-", 0.3));
    records.push_back(exactly(name + ": ends otherwise than without sleep", asleep.hash() != awake.hash(), "-", 0));
    records.push_back(exactly(name + ": ticks flagged", asleep.flagged(), "-", 0));
  }
  return records;
}

}  // namespace

Measurement sleepMeasurement(int rounds) {
  return {"sleep/islands", [rounds](MeasureContext& context) { return sleepCosts(rounds, context); }};
}

}  // namespace pincer::tasks
