// Cost of solving the contacts of one tick, by how many they are: the stage "solve" of the tick, rows and memories with
// it, by the steady clock. Every round computes the same ticks to the bit. A tick's time is the least of its rounds:
// what is left of the tail then is the solver's, and what else the machine did is in the tail of a single round.
#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "pincer/engine/world/stage_clock.h"
#include "pincer/grasp/step.h"
#include "pincer/tasks/judge/bench/engine/engine_bench.h"
#include "pincer/tasks/run/measure/timing.h"

namespace pincer::tasks {
namespace {

// [ticks]: left out at the start; then 20 s, of which 20 ticks lie above 99.9 %.
constexpr int kWarmTicks = 500, kSolveTicks = 20000;
constexpr double kSolvedBall = 0.02, kSolvedTip = 8e-3;  // radii [m]

struct SolveTimes {
  std::vector<double> us;        // per tick, the least of the rounds
  std::vector<double> first_us;  // per tick, of the first round
  double residual = 0;           // the largest
  int contacts = 0;              // the most
  int flagged = 0;               // ticks
};

// One round.
SolveTimes timeSolves(grasp::GraspModel model, grasp::GraspState state, const std::vector<Vec3>& devices,
                      MeasureContext& context) {
  const Vec3 gravity_W = model.world.options.gravity_W;
  const grasp::ScratchHandle scratch = grasp::makeScratch(model);
  engine::StageClock clock;
  engine::timeStages(&clock, grasp::worldOf(*scratch));
  std::vector<grasp::FingerInput> inputs(devices.size());
  SolveTimes times;
  for (int k = 0; k < kWarmTicks + kSolveTicks && !context.interrupted(); ++k) {
    // Everything sways a little all the time, as in a hand that moves: no tick's answer is that of the last one.
    const double phase = 0.01 * k;
    for (std::size_t i = 0; i < devices.size(); ++i)
      inputs[i] = {devices[i] + 1e-3 * math::sin(phase) * Vec3::UnitZ(), 1e-2 * math::cos(phase) * Vec3::UnitZ()};
    if (devices.empty())
      model.world.options.gravity_W = gravity_W + 0.5 * Vec3(math::sin(phase), math::cos(1.7 * phase), 0);
    const engine::StepReport report = grasp::step(model, state, *scratch, inputs);
    if (k < kWarmTicks) continue;
    times.us.push_back(1e6 * clock.seconds[static_cast<std::size_t>(engine::Stage::kSolve)]);
    times.residual = std::max(times.residual, report.solve.residual);
    times.contacts = std::max(times.contacts, report.contacts);
    times.flagged += report.status != engine::kStepOk;
  }
  return times;
}

SolveTimes leastOf(int rounds, const grasp::GraspModel& model, const grasp::GraspState& state,
                   const std::vector<Vec3>& devices, MeasureContext& context) {
  SolveTimes least = timeSolves(model, state, devices, context);
  least.first_us = least.us;
  for (int round = 1; round < rounds && !context.interrupted(); ++round) {
    const SolveTimes again = timeSolves(model, state, devices, context);
    for (std::size_t k = 0; k < std::min(least.us.size(), again.us.size()); ++k)
      least.us[k] = std::min(least.us[k], again.us[k]);
  }
  return least;
}

engine::WorldOptions awake() {
  engine::WorldOptions options;
  options.sleep = false;
  return options;
}

SolveTimes graspedBall(int fingers, int rounds, MeasureContext& context) {
  engine::WorldBuilder builder(awake());
  builder.addBody({"ball", contact::Sphere{kSolvedBall}, true, 0.075, {0.6, 0.6, 0, 0}});
  std::vector<grasp::FingerModel> models;
  std::vector<Vec3> devices;
  for (int i = 0; i < fingers; ++i) {
    grasp::FingerModel& finger = models.emplace_back();
    finger.name = fmt::format("f{}", i);
    finger.radius = kSolvedTip;
    const double a = 2 * M_PI * i / fingers;
    devices.push_back((kSolvedBall + kSolvedTip - 2e-3) * Vec3(math::cos(a), math::sin(a), 0));
  }
  const grasp::GraspModel model = grasp::buildGrasp(builder, models);
  return leastOf(rounds, model, grasp::makeState(model, {engine::BodyStart{}}, devices), devices, context);
}

// Four contacts each.
SolveTimes stackedBoxes(int boxes, int rounds, MeasureContext& context) {
  engine::WorldBuilder builder(awake());
  builder.addBody({"floor", contact::HalfSpace{}, false, 0, {0.5, 0.5, 0, 0}});
  std::vector<engine::BodyStart> starts(1);
  for (int i = 0; i < boxes; ++i) {
    builder.addBody({fmt::format("box{}", i), contact::Box{Vec3::Constant(0.02)}, true, 0.2, {0.5, 0.5, 0, 0}});
    starts.push_back({{Quat::Identity(), Vec3(0, 0, 0.02 + 0.04 * i)}, Vec3::Zero(), Vec3::Zero()});
  }
  const grasp::GraspModel model = grasp::buildGrasp(builder, {});
  return leastOf(rounds, model, grasp::makeState(model, starts, {}), {}, context);
}

void addSolveRecords(const char* what, const SolveTimes& times, double median, double p999,
                     std::vector<Record>& records) {
  const std::string name = fmt::format("{} ({} contacts)", what, times.contacts);
  records.push_back(atMost(name + ": median", quantileOf(times.us, 0.5), "us", median));
  records.push_back(atMost(name + ": p99.9", quantileOf(times.us, 0.999), "us", p999));
  records.push_back(unbounded(name + ": p99.9 of one round", quantileOf(times.first_us, 0.999), "us"));
  records.push_back(atMost(name + ": largest residual", times.residual, "-", 1e-8));
  records.push_back(exactly(name + ": ticks flagged", times.flagged, "-", 0));
}

std::vector<Record> solveLatencies(int rounds, MeasureContext& context) {
  std::vector<Record> records;
  addSolveRecords("2 fingers on a ball", graspedBall(2, rounds, context), 1, 3, records);
  addSolveRecords("5 fingers on a ball", graspedBall(5, rounds, context), 5, 10, records);
  addSolveRecords("10 fingers on a ball", graspedBall(10, rounds, context), 13, 30, records);
  addSolveRecords("3 boxes in a stack", stackedBoxes(3, rounds, context), 25, 100, records);
  addSolveRecords("8 boxes in a stack", stackedBoxes(8, rounds, context), 130, 400, records);
  return records;
}

}  // namespace

Measurement solveLatencyMeasurement(int rounds) {
  return {"solve/latency", [rounds](MeasureContext& context) { return solveLatencies(rounds, context); }};
}

}  // namespace pincer::tasks
