// worlds: small worlds that several tests share.
#pragma once
#include <cmath>
#include <vector>

#include "pincer/engine/world/budget.h"
#include "pincer/grasp/step.h"

namespace pincer::tests {

inline engine::BodyStart startAt(const Vec3& p_WB, const Vec3& v_W = Vec3::Zero(), const Vec3& w_W = Vec3::Zero()) {
  return {{Quat::Identity(), p_WB}, v_W, w_W};
}

struct EngineWorld {
  engine::WorldModel model;
  engine::WorldState state;

  double energy() const { return engine::energyOf(model, state, model.options.gravity_W); }
};

// Two needles of 20 g, 0.2 m long, one over the other, that spin by about `rate` [rad/s] and come down
// on a floor: the n-th of many such pairs.
inline EngineWorld spinningNeedles(int n, double half_width, double mu, double rate,
                                   const engine::WorldOptions& options) {
  engine::WorldBuilder builder{options};
  builder.addBody({"floor", contact::HalfSpace{}, false, 0, {mu, mu}});
  std::vector<engine::BodyStart> starts{startAt(Vec3::Zero())};
  for (int k = 0; k < 2; ++k) {
    builder.addBody({"needle", contact::Box{Vec3(0.1, half_width * (1 + 0.1 * n), half_width)}, true, 0.02, {mu, mu}});
    const Quat q = quatFromRotationVector(Vec3(0.1 * n, 1 + 0.3 * n + k, 0.2 * n));
    const Vec3 axis = k == 0 ? Vec3(std::sin(n), std::cos(n), 0.3) : Vec3(std::cos(n), std::sin(n), 0.3);
    starts.push_back({{q, Vec3(0, 0, 0.11 + 0.21 * k)}, Vec3(0, 0, -1), rate * axis});
  }
  EngineWorld w{builder.build(), {}};
  w.state = engine::makeState(w.model, starts, {});
  return w;
}

// A finger whose proxy is a massless tip behind `stiffness` and `damping`.
inline grasp::FingerModel softFinger(const char* name, double stiffness = 1000, double damping = 5) {
  grasp::FingerModel finger;
  finger.name = name;
  finger.coupling.stiffness = Vec3::Constant(stiffness);
  finger.coupling.damping = Vec3::Constant(damping);
  return finger;
}

struct GraspWorld {
  grasp::GraspModel model;
  grasp::GraspState state;
};

// A ball of 20 mm radius, its centre 0.1 m up, and two soft fingers of 8 mm that just touch it at -x and +x.
inline GraspWorld pinchedBall(double mass, double mu, double stiffness = 1000, double torsion_radius = 0) {
  engine::WorldBuilder builder{engine::WorldOptions{}};
  builder.addBody({"ball", contact::Sphere{0.02}, true, mass, {mu, mu, 0, torsion_radius}});
  GraspWorld w{grasp::buildGrasp(builder, {softFinger("left", stiffness), softFinger("right", stiffness)}), {}};
  w.state = grasp::makeState(w.model, {startAt(Vec3(0, 0, 0.1))}, {Vec3(-0.028, 0, 0.1), Vec3(0.028, 0, 0.1)});
  return w;
}

// Devices held still, each `squeeze` further in than the ball's surface allows and `lift` above its centre [m].
inline std::vector<grasp::FingerInput> squeezing(double squeeze, double lift = 0) {
  std::vector<grasp::FingerInput> inputs(2);
  inputs[0].p_WF = Vec3(-0.028 + squeeze, 0, 0.1 + lift);
  inputs[1].p_WF = Vec3(0.028 - squeeze, 0, 0.1 + lift);
  return inputs;
}

}  // namespace pincer::tests
