// Ours and published ways to render a finger, on the same scenes (grasp/baseline.h): what each gets wrong.
#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>

#include "pincer/contact/generated_meshes.h"
#include "pincer/contact/smooth_mesh.h"
#include "pincer/tasks/judge/bench/finger_path.h"
#include "pincer/tasks/judge/bench/grasp/bench_grasp.h"
#include "pincer/tasks/judge/bench/grasp/grasp_bench.h"

namespace pincer::tasks {
namespace {

using grasp::FingerMethod;

// All methods of a finger, pincer's own first.
constexpr std::array<FingerMethod, 5> kMethods = {FingerMethod::kProxy, FingerMethod::kFrictionCone,
                                                  FingerMethod::kForceShading, FingerMethod::kGodObject,
                                                  FingerMethod::kPenalty};

std::string_view nameOfMethod(FingerMethod method) {
  return grasp::kFingerMethodNames[static_cast<std::size_t>(method)];
}

// How each method feels a mesh, as published.
contact::SurfaceVariant methodVariant(FingerMethod method) {
  if (method == FingerMethod::kProxy) return contact::SurfaceVariant::smooth;
  return method == FingerMethod::kForceShading ? contact::SurfaceVariant::force : contact::SurfaceVariant::facet;
}

contact::Mesh meshBall(FingerMethod method, double radius, int n) {
  contact::SurfaceOptions options;
  options.variant = methodVariant(method);
  return {contact::SmoothMesh::build(contact::geodesicSphere(radius, n), options)};
}

// Ours is promised, the others shown.
Record promised(FingerMethod method, const std::string& metric, double value, const char* unit, double bound) {
  const std::string text = fmt::format("{}: {}", nameOfMethod(method), metric);
  return method == FingerMethod::kProxy ? atMost(text, value, unit, bound) : unbounded(text, value, unit);
}

// Two fingers pinch a ball of 75 g (a mesh of 980 triangles) on a floor, lift it
// by 50 mm within 1 s, and hold it for 3 s.
std::vector<Record> pickUp(FingerMethod method, MeasureContext& context) {
  constexpr double kRadius = 0.02, kLift = 0.05, kSqueeze = 3e-3;  // [m]
  engine::WorldBuilder builder(benchWorld(true));
  builder.addBody({"ball", meshBall(method, kRadius, 7), true, 0.075, {0.6, 0.6, 0, 3.3e-3}});
  builder.addBody({"floor", contact::HalfSpace{}, false, 0, {0.6, 0.6, 0, 0}});
  const auto devices = [&](double squeeze, double z) {
    return std::vector<Vec3>{Vec3(-(kRadius + kBenchTip - squeeze), 0, z), Vec3(kRadius + kBenchTip - squeeze, 0, z)};
  };
  BenchGrasp grasp(std::move(builder),
                   {engine::BodyStart{{Quat::Identity(), Vec3(0, 0, kRadius)}}, engine::BodyStart{}},
                   {benchFinger("left"), benchFinger("right")}, devices(-1e-3, kRadius), {method, method});
  grasp.leadAll(devices(kSqueeze, kRadius), 200);
  grasp.leadAll(devices(kSqueeze, kRadius), 200);
  // of the ball's middle under the proxies' (here: devices' sag counted by the mean of what carries)
  const auto below = [&] {
    return 0.5 * (grasp.state.world.points[0].p_W + grasp.state.world.points[1].p_W) - grasp.body(0).p;
  };
  const Vec3 before = method == FingerMethod::kProxy
                          ? below()
                          : Vec3(0.5 * (grasp.inputs[0].p_WF + grasp.inputs[1].p_WF) - grasp.body(0).p);
  const Quat q_before = grasp.body(0).q;
  for (int k = 1; k <= 1000 && !context.interrupted(); ++k) {
    const double s = k / 1000.0, rise = kLift * s * s * s * (10 - 15 * s + 6 * s * s);
    for (int i = 0; i < 2; ++i) grasp.leadFinger(i, devices(kSqueeze, kRadius + rise)[static_cast<std::size_t>(i)]);
    grasp.tick();
  }
  double bounce = 0;
  for (int k = 0; k < 3000 && !context.interrupted(); ++k) {
    for (int i = 0; i < 2; ++i) grasp.leadFinger(i, grasp.inputs[static_cast<std::size_t>(i)].p_WF);
    grasp.tick();
    if (k >= 2000) bounce = std::max(bounce, grasp.state.world.bodies[0].v_W.norm());
  }
  const Vec3 after = method == FingerMethod::kProxy
                         ? below()
                         : Vec3(0.5 * (grasp.inputs[0].p_WF + grasp.inputs[1].p_WF) - grasp.body(0).p);
  const bool dropped = grasp.body(0).p.z() < kRadius + 0.5 * kLift;
  return {promised(method, "75 g pinched and lifted: dropped", dropped, "-", 0),
          promised(method, "slip until the end of the hold", 1e6 * (after - before).norm(), "um", 1e-3),
          promised(method, "rotation", angleBetween(q_before, grasp.body(0).q) / kDegree, "deg", 1e-6),
          promised(method, "speed in the last second of the hold", 1e3 * bounce, "mm/s", 1e-6)};
}

// A finger on a fixed plate, pressed 2 mm and dragged.
std::vector<Record> drag(FingerMethod method, MeasureContext&) {
  double worst = 0;
  for (const double speed : {0.001, 0.01, 0.1, 0.5}) {
    engine::WorldBuilder builder(benchWorld(false));
    builder.addBody({"plate", contact::HalfSpace{}, false, 0, {0.5, 0.5, 0, 0}});
    BenchGrasp grasp(std::move(builder), {engine::BodyStart{}}, {benchFinger("finger")}, {Vec3(0, 0, kBenchTip)},
                     {method});
    grasp.leadAll({Vec3(0, 0, kBenchTip - 2e-3)}, 50);
    Vec3 p(0, 0, kBenchTip - 2e-3);
    const int ticks = static_cast<int>(std::max(100.0, 4e-3 / (speed * kGraspTick)));
    for (int k = 0; k < ticks; ++k) {
      p.x() += speed * kGraspTick;
      grasp.leadFinger(0, p);
      grasp.tick();
    }
    worst = std::max(worst, std::abs(grasp.felt(0).tangential_force / grasp.felt(0).normal_force - 0.5));
  }
  // A load of 0.9 of the limit, and then rest.
  engine::WorldBuilder builder(benchWorld(false));
  builder.addBody({"plate", contact::HalfSpace{}, false, 0, {0.5, 0.5, 0, 0}});
  BenchGrasp grasp(std::move(builder), {engine::BodyStart{}}, {benchFinger("finger")}, {Vec3(0, 0, kBenchTip)},
                   {method});
  grasp.leadAll({Vec3(0, 0, kBenchTip - 2e-3)}, 50);
  grasp.leadAll({Vec3(0.9e-3, 0, kBenchTip - 2e-3)}, 300);
  grasp.leadAll({Vec3(0.9e-3, 0, kBenchTip - 2e-3)}, 500);
  const double held = grasp.felt(0).tangential_force / grasp.felt(0).normal_force;
  return {promised(method, "friction over normal force at 1 .. 500 mm/s, off .5 by", worst, "-", 5e-4),
          promised(method, "at rest under 0.9 of its limit: off what friction should carry", std::abs(held - 0.45), "-",
                   1e-9)};
}

// Round a ball of 9680 triangles at 100 mm/s, pressed 2 mm: the force turns by 0.12 degrees per tick.
std::vector<Record> facets(FingerMethod method, MeasureContext&) {
  engine::WorldBuilder builder(benchWorld(false));
  builder.addBody({"ball", meshBall(method, 0.04, 22), false, 0, {0, 0, 0, 0}});
  const double R = 0.04 + kBenchTip - 2e-3, step = 0.1 * kGraspTick / R;
  const Mat3 plane = frameFromNormal(Vec3(0.3, -0.2, 1).normalized());
  const auto at = [&](double a, double r) {
    return Vec3(r * (math::cos(a) * plane.col(0) + math::sin(a) * plane.col(1)));
  };
  BenchGrasp grasp(std::move(builder), {engine::BodyStart{}}, {benchFinger("finger")}, {at(0, R + 2.1e-3)}, {method});
  grasp.leadAll({at(0, R)}, 100);
  double largest = 0;
  Vec3 last = Vec3::Zero();
  for (int k = 1; k * step < 2 * M_PI; ++k) {
    grasp.leadFinger(0, at(k * step, R));
    grasp.tick();
    const Vec3 f = grasp.felt(0).f_user_W;
    if (k > 100) largest = std::max(largest, angleBetween(last, f));
    last = f;
  }
  return {promised(method, "force turns per tick on 9680 facets (true: 0.12)", largest / kDegree, "deg", 0.13)};
}

// A ball between two fingers that press 3 mm each, pushed off its middle by 1 mm: how its energy goes,
// and what of it is momentum from nowhere.
std::vector<Record> ringing(FingerMethod method, MeasureContext&) {
  constexpr double kMass = 0.02;  // [kg]
  engine::WorldBuilder builder(benchWorld(false));
  builder.addBody({"ball", contact::Sphere{0.02}, true, kMass, {0.6, 0.6, 0, 3.3e-3}});
  const auto devices = [](double squeeze) {
    return std::vector<Vec3>{Vec3(-(0.028 - squeeze), 0, 0), Vec3(0.028 - squeeze, 0, 0)};
  };
  BenchGrasp grasp(std::move(builder), {engine::BodyStart{}}, {benchFinger("left"), benchFinger("right")}, devices(0),
                   {method, method});
  grasp.leadAll(devices(3e-3), 50);
  grasp.state.world.bodies[0].v_W = Vec3(0.05, 0, 0);
  double early = 0, late = 0, momentum = 0;
  for (int k = 0; k < 5000; ++k) {
    for (int i = 0; i < 2; ++i) grasp.leadFinger(i, devices(3e-3)[static_cast<std::size_t>(i)]);
    const Vec3 before = grasp.state.world.bodies[0].v_W;
    grasp.tick();
    const Vec3 change = kMass * (grasp.state.world.bodies[0].v_W - before) / kGraspTick;
    momentum = std::max(momentum, (change + grasp.felt(0).f_contact_W + grasp.felt(1).f_contact_W).norm());
    const double speed = grasp.state.world.bodies[0].v_W.norm();
    if (k < 100) early = std::max(early, speed);
    if (k >= 4900) late = std::max(late, speed);
  }
  return {promised(method, "pushed while held: speed after 5 s over that at first (a damped spring: 0)", late / early,
                   "-", 1e-6),
          promised(method, "change of momentum less the fingers' forces", momentum, "N", 1e-9)};
}

using MethodScene = std::vector<Record> (*)(FingerMethod, MeasureContext&);

Measurement overMethods(const char* name, MethodScene scene) {
  return {name, [scene](MeasureContext& context) {
            std::vector<Record> all;
            for (const FingerMethod method : kMethods) {
              for (Record& record : scene(method, context)) all.push_back(std::move(record));
            }
            return all;
          }};
}

}  // namespace

std::vector<Measurement> baselineMeasurements() {
  return {overMethods("methods/pick-up", pickUp), overMethods("methods/friction", drag),
          overMethods("methods/facets", facets), overMethods("methods/energy-and-momentum", ringing)};
}

}  // namespace pincer::tasks
