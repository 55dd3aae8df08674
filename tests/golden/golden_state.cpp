// golden_state: runs a world that uses every routine of contact/, engine/ and grasp/ for
// 20,000 ticks and prints the hash of its state.
#include <cmath>
#include <cstdio>

#include "pincer/grasp/step.h"

namespace {

using namespace pincer;

engine::WorldOptions options() {
  engine::WorldOptions o;
  o.contact_margin = 5e-4;
  return o;
}

struct World {
  grasp::GraspModel model;
  std::vector<engine::BodyStart> starts;
};

engine::BodyStart at(double x, double y, double z, const Vec3& w_W = Vec3::Zero()) {
  return {{Quat::Identity(), Vec3(x, y, z)}, Vec3::Zero(), w_W};
}

// Two fingers squeeze, lift and shake a sphere over a dish, while a box, a capsule and a
// cylinder with a flat tumble on the table.
World makeWorld() {
  World w;
  engine::WorldBuilder builder(options());
  const engine::Material skin{0.6, 0.5, 0, 3.3e-3}, wood{0.4, 0.35, 0.3, 0};
  const int dish = builder.addBody({"dish", contact::Dish{0.15}, false, 0, skin});
  const int table = builder.addBody({"table", contact::HalfSpace{}, false, 0, wood});
  const int ball = builder.addBody({"ball", contact::Sphere{0.02}, true, 0.075, skin});
  const int box = builder.addBody({"box", contact::Box{Vec3(0.01, 0.02, 0.015)}, true, 0.08, wood});
  const int capsule = builder.addBody({"capsule", contact::Capsule{0.008, 0.02}, true, 0.03, wood});
  const int cylinder = builder.addBody({"cylinder", contact::CylinderWithFlat{0.02, 0.02, 0.014}, true, 0.1, wood});
  w.starts = {at(0, 0, 0),
              at(0, 0, -0.01),
              at(0, 0, 0.0201),
              at(0.2, 0, 0.05, Vec3(3, 8, 1)),
              at(-0.2, 0, 0.04, Vec3(0, 5, 2)),
              at(0, 0.2, 0.05, Vec3(4, 1, 0))};
  for (int a : {box, capsule, cylinder}) {
    builder.excludePair(dish, a);
    for (int b : {box, capsule, cylinder}) builder.excludePair(a, b);
  }
  builder.excludePair(table, ball);
  std::vector<grasp::FingerModel> fingers(2);
  fingers[0].name = "thumb";
  fingers[1].name = "index";
  fingers[1].coupling.mass = 0.01;
  w.model = grasp::buildGrasp(builder, fingers);
  return w;
}

double smoothStep(double t) { return t <= 0 ? 0 : t >= 1 ? 1 : t * t * (3 - 2 * t); }

// Fingertip places over time: close from +-40 mm to 2 mm inside, lift, shake ever more.
Vec3 fingerPlace(double t, double side) {
  const double x = 0.04 - 0.014 * smoothStep(t);
  const double lift = 0.06 * smoothStep((t - 1.5) / 2);
  const double shake = 0.004 * std::fmax(0, t - 5) / 15 * math::sin(12 * t);
  return Vec3(side * x, shake, 0.021 + lift + 0.5 * shake * side);
}

}  // namespace

int main() {
  const World w = makeWorld();
  grasp::GraspState state = grasp::makeState(w.model, w.starts, {fingerPlace(0, -1), fingerPlace(0, 1)});
  const grasp::ScratchHandle scratch = grasp::makeScratch(w.model);
  std::vector<grasp::FingerInput> inputs(2);
  std::uint32_t status = 0;
  for (int tick = 1; tick <= 20000; ++tick) {
    for (int i = 0; i < 2; ++i) {
      const Vec3 p_WF = fingerPlace(1e-3 * tick, i == 0 ? -1 : 1);
      inputs[i].v_WF = (p_WF - inputs[i].p_WF) / 1e-3 * (tick > 1);
      inputs[i].p_WF = p_WF;
    }
    status |= grasp::step(w.model, state, *scratch, inputs).status;
  }
  std::printf("%016llx status %u ball %.3f mm\n", static_cast<unsigned long long>(engine::hashOf(state.world)), status,
              1e3 * state.world.bodies[2].X_WI.p.z());
  return 0;
}
