// Cost of fingers per tick: two on a body, each further one, other tips, other methods, passivity.
#include <fmt/format.h>

#include <cmath>

#include "pincer/contact/generated_meshes.h"
#include "pincer/contact/polytope.h"
#include "pincer/contact/smooth_mesh.h"
#include "pincer/grasp/baseline.h"
#include "pincer/grasp/energy_ledger.h"
#include "pincer/grasp/passivity.h"
#include "pincer/tasks/judge/bench/grasp/bench_grasp.h"
#include "pincer/tasks/judge/bench/grasp/grasp_bench.h"
#include "pincer/tasks/run/measure/timing.h"

namespace pincer::tasks {
namespace {

constexpr double kCostBall = 0.02;  // [m]

struct HeldBall {
  grasp::GraspModel model;
  grasp::GraspState state;
  std::vector<grasp::FingerInput> inputs;
  std::vector<Vec3> around;
  std::vector<grasp::FingerMethod> methods;
};

// `fingers` tips spread around a ball of 75 g over a floor, all moving a little all the
// time, so that no tick repeats the last one.
HeldBall heldBall(int fingers, const contact::Shape& shape, grasp::FingerMethod method = grasp::FingerMethod::kProxy,
                  const std::optional<contact::FingerShape>& tip = {}) {
  engine::WorldBuilder builder(benchWorld(true));
  builder.addBody({"ball", shape, true, 0.075, {0.6, 0.6, 0, 0}});
  builder.addBody({"floor", contact::HalfSpace{}, false, 0, {0.6, 0.6, 0, 0}});
  HeldBall held;
  std::vector<grasp::FingerModel> models;
  std::vector<Vec3> devices;
  for (int i = 0; i < fingers; ++i) {
    const double a = 2 * M_PI * i / fingers;
    held.around.push_back(Vec3(-math::cos(a), -math::sin(a), 0));
    grasp::FingerModel finger = benchFinger("finger");
    finger.name = fmt::format("f{}", i);
    finger.shape = tip;
    models.push_back(finger);
    devices.push_back(Vec3(0, 0, 0.1) + (kCostBall + kBenchTip - 2e-3) * held.around.back());
  }
  held.model = grasp::buildGrasp(std::move(builder), models);
  held.state = grasp::makeState(held.model,
                                {engine::BodyStart{{Quat::Identity(), Vec3(0, 0, 0.1)}}, engine::BodyStart{}}, devices);
  held.inputs.resize(models.size());
  held.methods.resize(models.size(), method);
  return held;
}

// Up and down by 1 mm, 1.6 times a second. Worked out beforehand: sines aren't part of a tick.
constexpr std::size_t kSwayTicks = 628;

std::vector<std::vector<grasp::FingerInput>> swayOf(const HeldBall& held) {
  std::vector<std::vector<grasp::FingerInput>> sway(kSwayTicks, held.inputs);
  for (std::size_t k = 0; k < kSwayTicks; ++k) {
    const double rate = 2 * M_PI / (kSwayTicks * kGraspTick), phase = rate * kGraspTick * static_cast<double>(k);
    for (std::size_t i = 0; i < held.inputs.size(); ++i) {
      sway[k][i].p_WF = Vec3(0, 0, 0.1 + 1e-3 * math::sin(phase)) + (kCostBall + kBenchTip - 2e-3) * held.around[i];
      sway[k][i].v_WF = Vec3(0, 0, 1e-3 * rate * math::cos(phase));
    }
  }
  return sway;
}

double medianTick(HeldBall held) {
  const grasp::ScratchHandle scratch = grasp::makeScratch(held.model);
  grasp::BaselineFingers baselines(held.methods);
  const bool is_ours = held.methods.front() == grasp::FingerMethod::kProxy;
  const std::vector<std::vector<grasp::FingerInput>> sway = swayOf(held);
  const auto lead = [&](std::int64_t k) {
    const std::vector<grasp::FingerInput>& inputs = sway[static_cast<std::size_t>(k) % kSwayTicks];
    if (is_ours) {
      grasp::step(held.model, held.state, *scratch, inputs);
    } else {
      baselines.step(held.model, held.state, *scratch, inputs);
    }
  };
  return costOfCalls(lead, {.warm_up = 2000, .batches = 31, .calls_per_batch = 500, .single_calls = 0}).median / 1000;
}

std::vector<Record> fingersCost(MeasureContext&) {
  const contact::Shape mesh = contact::Mesh{contact::SmoothMesh::build(contact::geodesicSphere(kCostBall, 32))};
  std::vector<Record> records = {
      atMost("two fingers on a sphere over a half-space, median", medianTick(heldBall(2, contact::Sphere{kCostBall})),
             "us", 0.9),
      atMost("two fingers on a shaded mesh of 20,480 triangles, median", medianTick(heldBall(2, mesh)), "us", 1.5)};
  double before = 0;
  for (const int n : {2, 3, 4, 6, 8, 10}) {
    const double cost = medianTick(heldBall(n, contact::Sphere{kCostBall}));
    records.push_back(unbounded(fmt::format("{} fingers on a sphere, median", n), cost, "us"));
    if (n == 2) before = cost;
    if (n == 10) records.push_back(unbounded("each further finger, from 2 to 10", (cost - before) / 8, "us"));
  }
  return records;
}

std::vector<Record> methodsCost(MeasureContext&) {
  std::vector<Record> records;
  const contact::TriangleMesh triangles = contact::geodesicSphere(kCostBall, 32);
  for (std::size_t m = 0; m < grasp::kFingerMethodNames.size(); ++m) {
    contact::SurfaceOptions options;
    if (m > 0) options.variant = m == 2 ? contact::SurfaceVariant::force : contact::SurfaceVariant::facet;
    const contact::Shape mesh = contact::Mesh{contact::SmoothMesh::build(triangles, options)};
    records.push_back(
        unbounded(fmt::format("{}: two fingers on 20,480 triangles, median", grasp::kFingerMethodNames[m]),
                  medianTick(heldBall(2, mesh, static_cast<grasp::FingerMethod>(m))), "us"));
  }
  return records;
}

std::vector<Record> tipsCost(MeasureContext&) {
  const contact::Shape ball = contact::Sphere{kCostBall};
  const auto cost = [&](const contact::FingerShape& tip) {
    return medianTick(heldBall(2, ball, grasp::FingerMethod::kProxy, tip));
  };
  return {unbounded("two spheres as general tips, median", cost(contact::Sphere{kBenchTip}), "us"),
          unbounded("two capsules, median", cost(contact::CapsuleTip{kBenchTip, Vec3(0, 0, 5e-3)}), "us"),
          unbounded("two ellipsoids, median", cost(contact::EllipsoidTip{Vec3(8e-3, 7e-3, 6e-3)}), "us")};
}

// Flat against flat: four points each, where spheres have one.
std::vector<Record> padsCost(MeasureContext&) {
  const contact::Shape box = contact::Box{Vec3(kCostBall, kCostBall, kCostBall)};
  constexpr double kRounding = 5e-4, kHalf = 9.5e-3;  // [m]
  std::vector<Vec3> corners;
  for (int i = 0; i < 8; ++i) {
    const double x = kBenchTip - kRounding;
    corners.push_back({i & 1 ? x : -x, i & 2 ? kHalf : -kHalf, i & 4 ? kHalf : -kHalf});
  }
  const contact::PadTip pad{contact::Polytope::hullOf(corners, "pad"), kRounding};
  const double spheres = medianTick(heldBall(2, box)),
               pads = medianTick(heldBall(2, box, grasp::FingerMethod::kProxy, pad));
  return {unbounded("two spheres on a box, median", spheres, "us"),
          unbounded("two flat pads on it, median", pads, "us"), atMost("pads over spheres", pads / spheres, "-", 2.5)};
}

// `n` balls 200 mm apart in rows of 32, each between two spheres; all sway, so that none sleeps.
double costPerPinch(int n) {
  constexpr double kApart = 0.2;  // [m]
  constexpr int kPerRow = 32;     // pinches of a row, kApart from each other
  engine::WorldOptions options = benchWorld(true);
  options.max_contacts = 16384;
  engine::WorldBuilder builder(options);
  std::vector<grasp::FingerModel> models;
  std::vector<engine::BodyStart> starts;
  std::vector<Vec3> devices;
  for (int i = 0; i < n; ++i) {
    const Vec3 p(kApart * (i % kPerRow), kApart * (i / kPerRow), 0.1);
    builder.addBody({fmt::format("ball{}", i), contact::Sphere{kCostBall}, true, 0.075, {0.6, 0.6, 0, 0}});
    starts.push_back({{Quat::Identity(), p}, Vec3::Zero(), Vec3::Zero()});
    for (const double side : {-1.0, 1.0}) {
      models.push_back(benchFinger("finger"));
      models.back().name = fmt::format("f{}", models.size());
      devices.push_back(p + Vec3(side * (kCostBall + kBenchTip - 2e-3), 0, 0));
    }
  }
  const grasp::GraspModel model = grasp::buildGrasp(std::move(builder), models);
  grasp::GraspState state = grasp::makeState(model, starts, devices);
  const grasp::ScratchHandle scratch = grasp::makeScratch(model);
  std::vector<grasp::FingerInput> inputs(models.size());
  const auto lead = [&](std::int64_t k) {
    const double up = 1e-3 * math::sin(0.01 * static_cast<double>(k));
    for (std::size_t i = 0; i < inputs.size(); ++i) inputs[i].p_WF = devices[i] + Vec3(0, 0, up);
    grasp::step(model, state, *scratch, inputs);
  };
  const int calls = std::max(1, 300 / n);
  return costOfCalls(lead, {.warm_up = 200, .batches = 31, .calls_per_batch = calls, .single_calls = 0}).median /
         (1000.0 * n);
}

std::vector<Record> pinchesCost(MeasureContext&) {
  std::vector<Record> records;
  double one = 0, most = 0;
  for (const int n : {1, 10, 100, 1000}) {
    most = costPerPinch(n);
    if (n == 1) one = most;
    records.push_back(unbounded(fmt::format("{} pinches in one world, per pinch, median", n), most, "us"));
  }
  records.push_back(atMost("per pinch of 1000, over one alone", most / one, "-", 1.5));
  return records;
}

std::vector<Record> passivityCost(MeasureContext&) {
  HeldBall held = heldBall(2, contact::Sphere{kCostBall});
  grasp::PassivityState ports(2);
  grasp::PassivityOptions options;
  options.on = true;
  std::vector<Vec3> p(2, Vec3::Zero()), f(2);
  const CallCost cost = costOfCalls([&](std::int64_t k) {
    p[0].x() = 1e-3 * math::sin(0.01 * static_cast<double>(k));
    f[0] = f[1] = Vec3(1, 0, 0);
    grasp::observePorts(options, p, grasp::storedEnergy(held.model, held.state), kGraspTick, ports);
    grasp::controlPorts(options, kGraspTick, ports, f);
    grasp::holdPorts(f, ports);
  });
  return {unbounded("passivity of two fingers, median", cost.median / 1000, "us")};
}

}  // namespace

std::vector<Measurement> graspCostMeasurements() {
  return {{"cost/fingers", fingersCost}, {"cost/methods", methodsCost}, {"cost/tips", tipsCost},
          {"cost/pads", padsCost},       {"cost/pinches", pinchesCost}, {"cost/passivity", passivityCost}};
}

}  // namespace pincer::tasks
