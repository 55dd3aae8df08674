#include "pincer/engine/world/budget.h"

#include <algorithm>
#include <cmath>
#include <span>

#include "pincer/engine/world/contact_rows.h"
#include "pincer/engine/world/impact.h"

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

bool touches(const Contact& c, int body) {
  return (c.a.kind == SideKind::kBody && c.a.index == body) || (c.b.kind == SideKind::kBody && c.b.index == body);
}

bool isDriven(const WorldModel& model, const Side& side) {
  return side.kind == SideKind::kBody && model.bodies[side.index].driven;
}

// g of one contact.
double speedAgainst(const Contact& c, int body) {
  const bool is_a = c.a.kind == SideKind::kBody && c.a.index == body;
  const Motion& other = (is_a ? c.mover_b : c.mover_a)->free;
  const Vec3 v_W = other.v_W + other.w_W.cross(is_a ? c.arm_b_W : c.arm_a_W);
  return v_W.norm() + std::clamp(-c.bias_C[kNormalRow], 0.0, kLargestCorrection);
}

std::span<const int> contactsOf(const WorldScratch& scratch, const Island& island) {
  return {scratch.islands.order.data() + island.place, static_cast<std::size_t>(island.contacts)};
}

// R of a body that turns by `w_W`: its reach from that axis, at most twice its radius of gyration about it (a thin
// rod's is 3^1/2 times that). A rod that spins about itself reaches no further than it is thick. [m]
double reachOf(const BodyModel& body, const BodyScratch& s, const Vec3& w_W) {
  const double moment = w_W.dot(s.inverse_inertia_W.inverse() * w_W) / w_W.squaredNorm();
  return std::min(body.bounding_radius, 2 * std::sqrt(moment * body.inverse_mass));
}

// Share of the island's impulses with which this body of it doesn't turn too fast.
double shareOfTurn(const WorldModel& model, const WorldScratch& scratch, const Island& island, int body) {
  constexpr double kFewTimes = 10, kSlow = 0.02;  // [-, rad in a tick]
  const Vec3 w_end_W = endAngularVelocity(model, scratch, body);
  const double start = scratch.bodies[body].start.w_W.norm(), h = model.options.h, end = w_end_W.norm();
  if (!(end > start) || end * h < kSlow) return 1;
  double fastest = 0;
  for (const int i : contactsOf(scratch, island)) {
    if (touches(scratch.contacts[i], body)) fastest = std::max(fastest, speedAgainst(scratch.contacts[i], body));
  }
  const double reach = reachOf(model.bodies[body], scratch.bodies[body], w_end_W);
  const double most = std::max({start, std::sqrt(2 * fastest / (h * reach)), kFewTimes * fastest / reach});
  if (end <= most) return 1;
  const double free = scratch.bodies[body].free.w_W.norm();
  return free < most ? (most - free) / (end + free) : 0;
}

double shareOfTurns(const WorldModel& model, const WorldScratch& scratch, const Island& island) {
  double share = 1;
  for (const int i : contactsOf(scratch, island)) {
    const Contact& c = scratch.contacts[i];
    if (isDriven(model, c.a) == isDriven(model, c.b) || !c.active()) continue;
    const Side& side = isDriven(model, c.a) ? c.b : c.a;
    if (side.kind == SideKind::kBody && model.bodies[side.index].dynamic && model.bodies[side.index].tree < 0)
      share = std::min(share, shareOfTurn(model, scratch, island, side.index));
  }
  return share;
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

bool limitTurns(const WorldModel& model, WorldScratch& scratch) {
  if (model.driven_count == 0 || scratch.contacts.empty()) return false;
  bool limits = false;
  for (const Island& island : scratch.islands.islands) {
    const double share = shareOfTurns(model, scratch, island);
    if (share == 1) continue;
    for (const int i : contactsOf(scratch, island)) {
      scratch.contacts[i].r *= share;
      scratch.contacts[i].impulse_W *= share;
    }
    limits = true;
  }
  if (limits) gatherImpulses(model, scratch);
  return limits;
}

}  // namespace pincer::engine
