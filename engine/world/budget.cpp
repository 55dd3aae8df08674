#include "pincer/engine/world/budget.h"

#include <algorithm>
#include <cmath>

namespace pincer::engine {
namespace {

bool isDriven(const WorldModel& model, const WorldScratch& scratch) {
  if (!model.drives.empty()) return true;
  for (std::size_t i = 0; i < model.bodies.size(); ++i) {
    if (model.bodies[i].driven && scratch.bodies[i].touched) return true;
  }
  return !scratch.forces.empty() || std::any_of(scratch.points.begin(), scratch.points.end(),
                                                [](const PointScratch& point) { return point.touched; });
}

bool isPushed(const WorldModel& model, const WorldScratch& scratch, std::size_t body) {
  if (!model.bodies[body].dynamic) return false;
  if (model.bodies[body].tree >= 0) return false;  // its coordinates say how it moves
  const int group = model.bodies[body].joint_group;
  if (group < 0) return scratch.bodies[body].touched;
  const auto& joined = model.joint_groups[group].bodies;
  return std::any_of(joined.begin(), joined.end(), [&](int other) { return scratch.bodies[other].touched; });
}

double kineticEnergyOf(const WorldModel& model, const WorldState& state, std::size_t i) {
  const BodyState& s = state.bodies[i];
  return 0.5 * (model.bodies[i].mass * s.v_W.squaredNorm() +
                s.L_W.dot(bodyAngularVelocity(model, state, static_cast<int>(i))));
}

}  // namespace

void chargeQuery(const ColliderModel& a, const ColliderModel& b, WorldScratch& scratch) {
  constexpr std::int64_t kOfSphere = 200, kOfSolids = 5000;  // multiplications of a query
  const bool has_sphere =
      std::holds_alternative<contact::Sphere>(a.shape) || std::holds_alternative<contact::Sphere>(b.shape);
  charge(has_sphere ? kOfSphere : kOfSolids, scratch);
}

double energyOf(const WorldModel& model, const WorldState& state, const Vec3& gravity_W) {
  return kineticEnergy(model, state) + potentialEnergy(model, state, gravity_W);
}

void limitEnergy(const WorldModel& model, const WorldScratch& scratch, double most, WorldState& state) {
  const double gained = energyOf(model, state, scratch.gravity_W) - most;
  if (!(gained > 0) || isDriven(model, scratch)) return;
  double kinetic = 0;
  for (std::size_t i = 0; i < model.bodies.size(); ++i) {
    if (isPushed(model, scratch, i)) kinetic += kineticEnergyOf(model, state, i);
  }
  if (!(kinetic > 0)) return;
  const double factor = std::sqrt(std::max(0.0, 1 - gained / kinetic));
  for (std::size_t i = 0; i < model.bodies.size(); ++i) {
    if (!isPushed(model, scratch, i)) continue;
    state.bodies[i].v_W *= factor;
    state.bodies[i].L_W *= factor;
  }
}

}  // namespace pincer::engine
