// Promises of a grasp: the cone, action and reaction, the slip's onset, a hold without drift, handing over.
#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "pincer/contact/generated_meshes.h"
#include "pincer/contact/smooth_mesh.h"
#include "pincer/engine/world/scratch.h"
#include "pincer/tasks/judge/bench/finger_path.h"
#include "pincer/tasks/judge/bench/grasp/bench_grasp.h"
#include "pincer/tasks/judge/bench/grasp/grasp_bench.h"
#include "pincer/tasks/run/scene/builtin_scenes.h"
#include "pincer/tasks/run/simulation.h"

namespace pincer::tasks {
namespace {

constexpr double kBall = 0.02;  // radius [m]

// A ball of 75 g in the air between `fingers` tips spread evenly around it at the height of its
// centre, each `squeeze` under its surface.
struct RingGrasp {
  std::vector<Vec3> around;  // unit directions to the fingers
  BenchGrasp grasp;

  static std::vector<Vec3> directions(int fingers) {
    std::vector<Vec3> all;
    for (int i = 0; i < fingers; ++i) {
      const double a = 2 * M_PI * i / fingers;
      all.push_back(Vec3(-math::cos(a), -math::sin(a), 0));
    }
    return all;
  }
  static std::vector<Vec3> devices(const std::vector<Vec3>& around, double squeeze) {
    std::vector<Vec3> all;
    for (const Vec3& d : around) all.push_back((kBall + kBenchTip - squeeze) * d);
    return all;
  }
  static BenchGrasp make(const std::vector<Vec3>& around, const contact::Shape& shape, double mu, double torsion_radius,
                         double twist_stiffness) {
    engine::WorldBuilder builder(benchWorld(true));
    builder.addBody({"ball", shape, true, 0.075, {mu, mu, 0, torsion_radius}});
    std::vector<grasp::FingerModel> fingers;
    for (std::size_t i = 0; i < around.size(); ++i) {
      fingers.push_back(benchFinger(fmt::format("f{}", i).c_str()));
      fingers.back().coupling.twist_stiffness = twist_stiffness;
      if (twist_stiffness > 0) fingers.back().coupling.twist_damping = 1e-3;
    }
    return {std::move(builder), {engine::BodyStart{}}, fingers, devices(around, 2e-3)};
  }
  RingGrasp(int fingers, const contact::Shape& shape, double mu, double torsion_radius = 0, double twist_stiffness = 0)
      : around(directions(fingers)), grasp(make(around, shape, mu, torsion_radius, twist_stiffness)) {}
};

// Squeezed, shaken, turned and let slip; ticks of every kind.
std::vector<Record> coneAndReaction(MeasureContext& context) {
  std::vector<Record> records;
  const contact::Shape mesh = contact::Mesh{contact::SmoothMesh::build(contact::icosphere(kBall, 3))};
  for (const bool shaded : {false, true}) {
    for (const int fingers : {2, 3, 4, 6, 8, 10}) {
      RingGrasp ring(fingers, shaded ? mesh : contact::Shape(contact::Sphere{kBall}), 0.5);
      Random random(7);
      for (int k = 0; k < 2000 && !context.interrupted(); ++k) {
        for (int i = 0; i < fingers; ++i) {
          const Vec3 wiggle =
              2e-3 * Vec3(math::sin(0.031 * k + i), math::sin(0.047 * k + 2 * i), math::sin(0.023 * k + 3 * i));
          ring.grasp.leadFinger(i, (kBall + kBenchTip - 2e-3) * ring.around[static_cast<std::size_t>(i)] + wiggle +
                                       1e-5 * randomDirection(random));
        }
        ring.grasp.tick();
      }
      const char* what = shaded ? "mesh" : "sphere";
      records.push_back(atMost(fmt::format("{} fingers on a {}: |f_t| / (mu f_n) - 1, largest", fingers, what),
                               ring.grasp.coneExcess(), "-", 1e-12));
      records.push_back(exactly(fmt::format("{} fingers on a {}: ticks in which action isn't reaction", fingers, what),
                                ring.grasp.reactionErrors(), "-", 0));
    }
  }
  return records;
}

// One finger in a groove of a block that is free to move: two contacts on one body, each counted once.
std::vector<Record> twoContactsOnOneBody(MeasureContext&) {
  constexpr double kMass = 0.1;  // [kg]
  engine::WorldBuilder builder(benchWorld(false));
  builder.addBody({"block",
                   contact::Mesh{contact::SmoothMesh::build(contact::grooveBlock(M_PI / 4, 0.015, 0.03, 0.03))},
                   true,
                   kMass,
                   {0.5, 0.5, 0, 0}});
  BenchGrasp grasp(std::move(builder), {engine::BodyStart{}}, {benchFinger("finger")}, {Vec3(0, 0, 0.03)});
  double momentum = 0;
  int both = 0;
  for (int k = 0; k < 600; ++k) {
    grasp.leadFinger(0, Vec3(1e-3 * math::sin(0.05 * k), 0, 0.03 - 1e-4 * k));
    const Vec3 before = grasp.state.world.bodies[0].v_W;
    grasp.tick();
    const auto& contacts = grasp::worldOf(*grasp.scratch).contacts;
    both += std::count_if(contacts.begin(), contacts.end(), [](const auto& c) { return c.active(); }) > 1;
    const Vec3 change = kMass * (grasp.state.world.bodies[0].v_W - before) / kGraspTick;
    momentum = std::max(momentum, (change + grasp.felt(0).f_contact_W).norm());
  }
  return {atLeast("ticks with two contacts or more", both, "-", 10),
          atMost("change of momentum less the finger's force", momentum, "N", 1e-9),
          exactly("ticks in which action isn't reaction", grasp.reactionErrors(), "-", 0)};
}

// The tangential force at which a finger pressed with 2 N begins to slip, found by bisection, over mu f_n.
double slipOnset(const contact::Shape& shape, const Vec3& from_W) {
  constexpr double kMu = 0.5;  // [-]
  engine::WorldBuilder builder(benchWorld(false));
  builder.addBody({"object", shape, false, 0, {kMu, kMu, 0, 0}});
  BenchGrasp grasp(std::move(builder), {engine::BodyStart{}}, {benchFinger("finger")}, {from_W});
  const Vec3 n0 = from_W.normalized();
  for (int k = 0; k < 400; ++k) {  // to 2 N and still
    grasp.leadFinger(0, grasp.inputs[0].p_WF - (k < 202 ? 1e-5 : 0.0) * n0);
    grasp.tick();
  }
  const grasp::GraspState pressed = grasp.state;
  const Vec3 n = grasp.felt(0).n_W, t = frameFromNormal(n).col(0);
  const double f_n = grasp.felt(0).normal_force;
  const Vec3 standing = grasp.felt(0).f_contact_W - f_n * n;  // what friction carries already
  const auto slips = [&](double ratio) {
    grasp.state = pressed;
    bool slid = false;
    for (int k = 1; k <= 60; ++k) {
      grasp.inputs[0].f_W = standing - std::min(1.0, k / 40.0) * ratio * kMu * f_n * t;
      grasp.tick();
      slid = slid || grasp.felt(0).sliding;
    }
    grasp.inputs[0].f_W.setZero();
    return slid;
  };
  double low = 0.9, high = 1.1;
  for (int i = 0; i < 30; ++i) {
    const double middle = 0.5 * (low + high);
    (slips(middle) ? high : low) = middle;
  }
  return 0.5 * (low + high);
}

std::vector<Record> slipOnsets(MeasureContext&) {
  const auto mesh = contact::SmoothMesh::build(contact::icosphere(kBall, 3));
  const double start = kBall + kBenchTip + 1e-5;
  const auto record = [&](const char* what, const contact::Shape& shape, const Vec3& from) {
    return atMost(fmt::format("{}: force at which it slips, over mu f_n, less 1", what),
                  std::abs(slipOnset(shape, from) - 1), "-", 1e-6);
  };
  return {record("flat", contact::HalfSpace{}, Vec3(0, 0, kBenchTip + 1e-5)),
          record("sphere", contact::Sphere{kBall}, start * Vec3(0.3, -0.5, 1).normalized()),
          record("cylinder", contact::Cylinder{kBall, 0.03}, start * Vec3(0.6, 0.8, 0)),
          record("shaded mesh of a sphere", contact::Mesh{mesh}, start * Vec3(0.31, -0.52, 1.07).normalized())};
}

std::vector<Record> holdsStill(MeasureContext& context) {
  Scene scene = readBuiltinScene("s4_pinch");
  scene.options.sleep = false;
  Simulation sim(std::move(scene));
  const Pose start = sim.bodyPose(0);
  double drift = 0;
  while (sim.ticks() < 60000 && !context.interrupted()) {
    sim.tick();
    drift = std::max(drift, (sim.bodyPose(0).p - start.p).norm());
    if (sim.ticks() % 1000 == 0) context.progress(static_cast<double>(sim.ticks()) / 60000);
  }
  return {atMost("drift in 60 s", 1e6 * drift, "um", 1e-6)};
}

// Devices with 10 um of noise, the same every second: whatever differs between the first second's mean place and a
// later one's is drift. Soft pads: about the line between two points nothing would hold a body.
struct NoisyHold {
  double drift = 0;  // [m]
  double slip = 0;   // largest offset of an anchor in any tick: the integral of a contact's slip since it stuck [m]
  int slides = 0;    // ticks in which a contact slid, and forgot its anchor
};

NoisyHold holdInNoise(const contact::Shape& shape, double twist_stiffness, MeasureContext& context) {
  constexpr int kSecond = 1000, kSeconds = 60;  // [ticks]: the noise repeats each second; [s]: a minute
  RingGrasp ring(2, shape, 0.5, 3.3e-3, twist_stiffness);
  const std::vector<Vec3> places = RingGrasp::devices(ring.around, 2e-3);
  Random random(11);
  std::vector<std::array<Vec3, 2>> noise(kSecond);
  for (auto& tick : noise) {
    for (Vec3& n : tick) n = 1e-5 * randomDirection(random);
  }
  Vec3 first = Vec3::Zero();
  NoisyHold hold;
  for (int s = 0; s <= kSeconds && !context.interrupted(); ++s) {
    Vec3 mean = Vec3::Zero();
    for (int k = 0; k < kSecond; ++k) {
      for (std::size_t i = 0; i < 2; ++i)
        ring.grasp.leadFinger(static_cast<int>(i), places[i] + noise[static_cast<std::size_t>(k)][i]);
      ring.grasp.tick();
      mean += ring.grasp.body(0).p / kSecond;
      if (s == 0) continue;  // it settles
      bool slides = false;
      for (const engine::Contact& c : grasp::worldOf(*ring.grasp.scratch).contacts) {
        hold.slip = std::max(hold.slip, c.offset_C.head<2>().norm());
        slides = slides || c.sliding;
      }
      hold.slides += slides;
    }
    if (s == 1) first = mean;
    if (s > 1) hold.drift = std::max(hold.drift, (mean - first).norm());
    context.progress(static_cast<double>(s) / kSeconds);
  }
  return hold;
}

// Pads that can't twist must slip about their normals: a ball that trembles turns, two normals are never
// quite opposite, and no turn leaves both without spin. Where torsion is at its limit, so is the cone that
// friction shares with it, and the weight creeps down: v / w = e^2 f_t / tau. The least compliance in
// torsion, as any fingertip has, ends that.
std::vector<Record> holdsInNoise(MeasureContext& context) {
  constexpr double kPadTwist = 0.3;  // [N m/rad]
  std::vector<Record> records;
  const std::string noise = " with 10 um of noise on both devices: ";
  const auto add = [&](const std::string& what, const contact::Shape& shape) {
    const NoisyHold hold = holdInNoise(shape, kPadTwist, context);
    records.push_back(atMost(what + noise + "drift in 59 s", 1e6 * hold.drift, "um", 1));
    records.push_back(atMost(what + noise + "largest slip of an anchor", 1e6 * hold.slip, "um", 1));
    records.push_back(exactly(what + noise + "ticks in which a contact slides", hold.slides, "-", 0));
  };
  add("a cube", contact::Box{Vec3::Constant(kBall)});
  add("a ball", contact::Sphere{kBall});
  const NoisyHold rigid = holdInNoise(contact::Sphere{kBall}, 0, context);
  records.push_back(unbounded("a ball, pads that can't twist," + noise + "drift in 59 s", 1e6 * rigid.drift, "um"));
  records.push_back(
      unbounded("a ball, pads that can't twist," + noise + "ticks in which a contact slides", rigid.slides, "-"));
  return records;
}

std::vector<Record> handsOver(MeasureContext& context) {
  Simulation sim(readBuiltinScene("handover"));
  Pose start;
  double moved = 0;
  while (sim.ticks() < sim.scene().ticks() && !context.interrupted()) {
    sim.tick();
    if (sim.ticks() == 300) start = sim.bodyPose(0);  // the fingers begin 2 mm deep in the box
    if (sim.ticks() > 300) moved = std::max(moved, (sim.bodyPose(0).p - start.p).norm());
  }
  return {atMost("the box moves while it goes from 2 fingers to 4 to 2", 1e6 * moved, "um", 1)};
}

}  // namespace

std::vector<Measurement> holdingMeasurements() {
  return {{"hold/cone", coneAndReaction},  {"hold/two-contacts", twoContactsOnOneBody},
          {"hold/slip-onset", slipOnsets}, {"hold/drift", holdsStill},
          {"hold/noise", holdsInNoise},    {"hold/handover", handsOver}};
}

}  // namespace pincer::tasks
