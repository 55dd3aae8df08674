// Cost of each feature: the same ticks with it and without it, by turns, as a ratio of their processor times. What a
// scene doesn't use it shouldn't pay for; what it does use has its price here.
#include <fmt/format.h>

#include <cmath>
#include <memory>

#include "pincer/contact/generated_meshes.h"
#include "pincer/contact/smooth_mesh.h"
#include "pincer/grasp/energy_ledger.h"
#include "pincer/grasp/passivity.h"
#include "pincer/tasks/judge/bench/grasp/bench_grasp.h"
#include "pincer/tasks/judge/bench/grasp/grasp_bench.h"
#include "pincer/tasks/run/measure/timing.h"

namespace pincer::tasks {
namespace {

constexpr double kFeatureBall = 0.02, kFeatureHeight = 0.1, kFeatureSqueeze = 2e-3;  // [m]
constexpr int kFeatureTicks = 400;                                                   // of a batch

// Of a ball that two fingers hold over a floor and sway up and down, so that no tick is that before.
struct Features {
  engine::Material material{0.6, 0.6, 0, 0};
  engine::WorldOptions options = benchWorld(true);
  grasp::FingerModel finger = benchFinger("finger");
  contact::Shape ball = contact::Sphere{kFeatureBall};
  bool passive = false;
};

class FeatureHand {
 public:
  explicit FeatureHand(const Features& features) : features_(features) {
    engine::WorldBuilder builder(features.options);
    builder.addBody({"ball", features.ball, true, 0.075, features.material});
    builder.addBody({"floor", contact::HalfSpace{}, false, 0, features.material});
    std::vector<grasp::FingerModel> fingers(2, features.finger);
    fingers[1].name = "thumb";
    model_ = grasp::buildGrasp(std::move(builder), fingers);
    state_ = grasp::makeState(model_,
                              {engine::BodyStart{{Quat::Identity(), Vec3(0, 0, kFeatureHeight)}}, engine::BodyStart{}},
                              {device(0), device(1)});
    scratch_ = grasp::makeScratch(model_);
    passivity_.on = features.passive;
    run(2000);
  }

  void run(int ticks) {
    for (int k = 0; k < ticks; ++k) tick();
  }

 private:
  Vec3 device(int finger) const {
    const double phase = 0.01 * static_cast<double>(tick_), side = finger == 0 ? -1 : 1;
    return {side * (kFeatureBall + kBenchTip - kFeatureSqueeze), 0, kFeatureHeight + 1e-3 * math::sin(phase)};
  }

  void tick() {
    ++tick_;
    for (int i = 0; i < 2; ++i) {
      grasp::FingerInput& input = inputs_[static_cast<std::size_t>(i)];
      const Vec3 p = device(i);
      input.v_WF = tick_ > 1 ? Vec3((p - input.p_WF) / kGraspTick) : Vec3::Zero();
      input.p_WF = p;
    }
    grasp::step(model_, state_, *scratch_, inputs_);
    if (features_.passive) passTo(ports_);
  }

  void passTo(grasp::PassivityState& ports) {
    std::vector<Vec3>&p = places_, &f = forces_;
    for (std::size_t i = 0; i < 2; ++i) {
      p[i] = inputs_[i].p_WF;
      f[i] = grasp::fingersOf(*scratch_)[i].f_user_W;
    }
    grasp::observePorts(passivity_, p, grasp::storedEnergy(model_, state_), kGraspTick, ports);
    grasp::controlPorts(passivity_, kGraspTick, ports, f);
    grasp::holdPorts(f, ports);
  }

  Features features_;
  grasp::GraspModel model_;
  grasp::GraspState state_;
  grasp::ScratchHandle scratch_;
  std::vector<grasp::FingerInput> inputs_ = std::vector<grasp::FingerInput>(2);
  std::vector<Vec3> places_ = std::vector<Vec3>(2), forces_ = std::vector<Vec3>(2);
  grasp::PassivityOptions passivity_;
  grasp::PassivityState ports_{2};
  std::int64_t tick_ = 0;
};

// `marbles` that lie apart on a floor, pushed about by a gravity that turns.
class FeatureMarbles {
 public:
  explicit FeatureMarbles(int marbles) {
    engine::WorldBuilder builder(benchWorld(true));
    builder.addBody({"floor", contact::HalfSpace{}, false, 0, {}});
    std::vector<engine::BodyStart> starts(1);
    for (int i = 0; i < marbles; ++i) {
      builder.addBody({fmt::format("marble{}", i), contact::Sphere{0.01}, true, 0.01, {}});
      starts.push_back({{Quat::Identity(), Vec3(0.1 * i, 0, 0.01)}, Vec3::Zero(), Vec3::Zero()});
    }
    model_ = builder.build();
    state_ = engine::makeState(model_, starts, {});
    scratch_ = engine::makeScratch(model_);
  }

  void run(int ticks) {
    for (int k = 0; k < ticks; ++k) {
      const double phase = 0.01 * static_cast<double>(++tick_);
      model_.options.gravity_W = Vec3(0.5 * math::sin(phase), 0.5 * math::cos(phase), -9.81);
      engine::step(model_, state_, *scratch_);
    }
  }

 private:
  engine::WorldModel model_;
  engine::WorldState state_;
  engine::ScratchHandle scratch_;
  std::int64_t tick_ = 0;
};

double ratioOfTicks(const Features& with, const Features& without) {
  FeatureHand a(with), b(without);
  return ratioOfCosts([&] { a.run(kFeatureTicks); }, [&] { b.run(kFeatureTicks); });
}

// One change to the plain ball.
template <class Change>
Record featureRecord(const char* what, const Change& change, const Features& without = {}) {
  Features with = without;
  change(with);
  return unbounded(fmt::format("{}: a tick with it over one without", what), ratioOfTicks(with, without), "-");
}

Features softHand() {
  Features soft;
  soft.material.torsion_radius = 3.3e-3;
  return soft;
}

Features shadedHand(contact::SurfaceVariant variant) {
  contact::SurfaceOptions options;
  options.variant = variant;
  Features hand;
  hand.ball = contact::Mesh{contact::SmoothMesh::build(contact::geodesicSphere(kFeatureBall, 32), options)};
  return hand;
}

Record treeRecord() {
  // marbles; with the floor 16 bodies are the most of which all pairs are looked at
  constexpr int kAllPairs = 15, kTree = 17;
  FeatureMarbles tree(kTree), pairs(kAllPairs);
  const double ratio = ratioOfCosts([&] { tree.run(kFeatureTicks); }, [&] { pairs.run(kFeatureTicks); });
  return unbounded("tree of boxes, 17 marbles: a marble's share of a tick over that of 15 without it",
                   ratio * kAllPairs / kTree, "-");
}

std::vector<Record> featureCosts(MeasureContext&) {
  return {
      featureRecord("torsion", [](Features& f) { f.material.torsion_radius = 3.3e-3; }),
      featureRecord("torsion and rolling resistance",
                    [](Features& f) {
                      f.material.torsion_radius = 3.3e-3;
                      f.material.rolling_radius = 1e-3;
                    }),
      featureRecord(
          "twist spring of soft pads", [](Features& f) { f.finger.coupling.twist_stiffness = 0.3; }, softHand()),
      featureRecord(
          "patch that grows with the load", [](Features& f) { f.finger.pad.modulus = 1e5; }, softHand()),
      featureRecord("coupling along the contact's normal", [](Features& f) { f.finger.along_normal = true; }),
      featureRecord("fingertip with mass", [](Features& f) { f.finger.coupling.mass = 0.01; }),
      featureRecord("restitution", [](Features& f) { f.material.restitution = 0.5; }),
      featureRecord("ticks cut to 1 nm", [](Features& f) { f.options.position_tolerance = 1e-9; }),
      featureRecord("passivity and its ledger", [](Features& f) { f.passive = true; }),
      featureRecord(
          "shading, 20,480 triangles", [](Features& f) { f = shadedHand(contact::SurfaceVariant::smooth); },
          shadedHand(contact::SurfaceVariant::facet)),
      featureRecord("20,480 shaded triangles for a sphere",
                    [](Features& f) { f = shadedHand(contact::SurfaceVariant::smooth); }),
      treeRecord(),
  };
}

}  // namespace

std::vector<Measurement> featureCostMeasurements() { return {{"cost/features", featureCosts}}; }

}  // namespace pincer::tasks
