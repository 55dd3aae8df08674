// What the contacts of one tick cost to solve, by how many they are: the stage "solve" of the tick, rows and memories with it, by the steady clock.
#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "grasp/step.h"
#include "tasks/bench/engine/engine_bench.h"
#include "tasks/measure/timing.h"

namespace pincer::tasks {
namespace {

constexpr int kWarmTicks = 500, kSolveTicks = 20000;
constexpr double kSolvedBall = 0.02, kSolvedTip = 8e-3;  // radii [m]

struct SolveTimes {
  std::vector<double> us;
  double residual = 0;  // the largest
  int contacts = 0;     // the most
  int flagged = 0;      // ticks
};

SolveTimes timeSolves(grasp::GraspModel model, grasp::GraspState state, const std::vector<Vec3>& devices, MeasureContext& context) {
  const Vec3 gravity_W = model.world.options.gravity_W;
  grasp::GraspScratch scratch(model);
  engine::StageClock clock;
  scratch.world.clock = &clock;
  std::vector<grasp::FingerInput> inputs(devices.size());
  SolveTimes times;
  for (int k = 0; k < kWarmTicks + kSolveTicks && !context.interrupted(); ++k) {
    // Everything sways a little all the time, as in a hand that moves: no tick's answer is that of the last one.
    const double phase = 0.01 * k;
    for (std::size_t i = 0; i < devices.size(); ++i)
      inputs[i] = {devices[i] + 1e-3 * std::sin(phase) * Vec3::UnitZ(), 1e-2 * std::cos(phase) * Vec3::UnitZ()};
    if (devices.empty()) model.world.options.gravity_W = gravity_W + 0.5 * Vec3(std::sin(phase), std::cos(1.7 * phase), 0);
    const engine::StepReport report = grasp::step(model, state, scratch, inputs);
    if (k < kWarmTicks) continue;
    times.us.push_back(1e6 * clock.seconds[static_cast<std::size_t>(engine::Stage::kSolve)]);
    times.residual = std::max(times.residual, report.solve.residual);
    times.contacts = std::max(times.contacts, report.contacts);
    times.flagged += report.status != engine::kStepOk;
  }
  return times;
}

engine::WorldOptions awake() {
  engine::WorldOptions options;
  options.sleep = false;
  return options;
}

SolveTimes graspedBall(int fingers, MeasureContext& context) {
  engine::WorldBuilder builder(awake());
  builder.addBody({"ball", contact::Sphere{kSolvedBall}, true, 0.075, {0.6, 0.6, 0, 0}});
  std::vector<grasp::FingerModel> models;
  std::vector<Vec3> devices;
  for (int i = 0; i < fingers; ++i) {
    grasp::FingerModel& finger = models.emplace_back();
    finger.name = fmt::format("f{}", i);
    finger.radius = kSolvedTip;
    const double a = 2 * M_PI * i / fingers;
    devices.push_back((kSolvedBall + kSolvedTip - 2e-3) * Vec3(std::cos(a), std::sin(a), 0));
  }
  grasp::GraspModel model = grasp::buildGrasp(builder, models);
  grasp::GraspState state = grasp::makeState(model, {engine::BodyStart{}}, devices);
  return timeSolves(std::move(model), std::move(state), devices, context);
}

// Four contacts each.
SolveTimes stackedBoxes(int boxes, MeasureContext& context) {
  engine::WorldBuilder builder(awake());
  builder.addBody({"floor", contact::HalfSpace{}, false, 0, {0.5, 0.5, 0, 0}});
  std::vector<engine::BodyStart> starts(1);
  for (int i = 0; i < boxes; ++i) {
    builder.addBody({fmt::format("box{}", i), contact::Box{Vec3::Constant(0.02)}, true, 0.2, {0.5, 0.5, 0, 0}});
    starts.push_back({{Quat::Identity(), Vec3(0, 0, 0.02 + 0.04 * i)}, Vec3::Zero(), Vec3::Zero()});
  }
  grasp::GraspModel model = grasp::buildGrasp(builder, {});
  grasp::GraspState state = grasp::makeState(model, starts, {});
  return timeSolves(std::move(model), std::move(state), {}, context);
}

void addSolveRecords(const char* what, const SolveTimes& times, double median, double p999, std::vector<Record>& records) {
  const std::string name = fmt::format("{} ({} contacts)", what, times.contacts);
  records.push_back(atMost(name + ": median", quantileOf(times.us, 0.5), "us", median));
  records.push_back(atMost(name + ": p99.9", quantileOf(times.us, 0.999), "us", p999));
  records.push_back(atMost(name + ": largest residual", times.residual, "-", 1e-8));
  records.push_back(exactly(name + ": ticks flagged", times.flagged, "-", 0));
}

std::vector<Record> solveLatencies(MeasureContext& context) {
  std::vector<Record> records;
  addSolveRecords("2 fingers on a ball", graspedBall(2, context), 1, 3, records);
  addSolveRecords("5 fingers on a ball", graspedBall(5, context), 5, 10, records);
  addSolveRecords("10 fingers on a ball", graspedBall(10, context), 13, 30, records);
  addSolveRecords("3 boxes in a stack", stackedBoxes(3, context), 25, 100, records);
  addSolveRecords("8 boxes in a stack", stackedBoxes(8, context), 130, 400, records);
  return records;
}

}  // namespace

Measurement solveLatencyMeasurement() { return {"solve/latency", solveLatencies}; }

}  // namespace pincer::tasks
