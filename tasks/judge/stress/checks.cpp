#include "pincer/tasks/judge/stress/checks.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "pincer/engine/world/scratch.h"

namespace pincer::tasks {
namespace {

double inverseMass(const engine::WorldModel& model, const engine::WorldScratch& scratch, const engine::Side& side) {
  if (side.kind == engine::SideKind::kJoint) return scratch.joint_rows[static_cast<std::size_t>(side.index)].mobility;
  if (side.kind == engine::SideKind::kBody) return model.bodies[static_cast<std::size_t>(side.index)].inverse_mass;
  return 0;  // a compliant point's response is the spring's: the body's mass sets the scale
}

// Projection onto the cone |r_T| <= mu r_n, in the order (t1, t2, n).
Vec3 ontoCone(const Vec3& r, double mu) {
  const double rT = r.head<2>().norm();
  if (mu * rT <= -r.z()) return Vec3::Zero();
  if (rT <= mu * r.z()) return r;
  const double n = (r.z() + mu * rT) / (1 + mu * mu);
  return {mu * n * r.x() / rT, mu * n * r.y() / rT, n};
}

}  // namespace

std::string faultOfState(const engine::WorldModel& model, const engine::WorldState& state) {
  for (std::size_t i = 0; i < state.bodies.size(); ++i) {
    const engine::BodyState& body = state.bodies[i];
    if (!body.X_WI.p.allFinite() || !body.X_WI.q.coeffs().allFinite() || !body.v_W.allFinite() || !body.L_W.allFinite())
      return fmt::format("{} isn't finite", model.bodies[i].name);
    constexpr double kSunk = 1e-5;  // a sheet of 20 um may be pressed into the floor by half its thickness [m]
    if (model.bodies[i].dynamic && body.X_WI.p.z() < -kSunk)
      return fmt::format("{} is {:.3g} m below the floor", model.bodies[i].name, -body.X_WI.p.z());
  }
  for (const engine::PointState& point : state.points) {
    if (!point.p_W.allFinite() || !point.v_W.allFinite()) return "a finger isn't finite";
  }
  return {};
}

std::string faultOfCones(const engine::WorldScratch& scratch) {
  constexpr double kTolerance = 1e-9;    // relative; the projection rounds to 1e-15
  constexpr double kUnderflow = 1e-150;  // squares of less aren't normal numbers any more [N s]
  std::string fault;
  engine::forEachContact(scratch, [&](const engine::Contact& c) {
    const double friction = std::sqrt(c.r.head<2>().squaredNorm() + c.r.tail<3>().squaredNorm());
    if (!(c.r[2] >= 0)) fault = fmt::format("a contact pulls with {:.3g} N s", -c.r[2]);
    if (!(friction <= c.mu * c.r[2] * (1 + kTolerance) + kUnderflow))
      fault = fmt::format("friction {:.17g} over mu r_n = {:.17g} N s", friction, c.mu * c.r[2]);
  });
  return fault;
}

// Contacts with torsion or rolling have more rows, which u_C doesn't hold; they are left to the solver's own tests.
std::string faultOfLaw(const engine::WorldModel& model, const engine::WorldScratch& scratch) {
  constexpr double kTolerance = 1e-6;  // relative
  // [m/s] twice what the solver is content with (few_contacts.cpp), for w is another here
  constexpr double kContent = 2e-8;
  constexpr int kFew = 60;  // contacts; of more an error is allowed (docs/engine.md, "enough")
  constexpr double kOfSlip = 6e-4, kMostAccuracies = 200;  // again twice
  double speed = 1e-6, worst = 0, slip = 0;
  int contacts = 0;
  engine::forEachContact(scratch, [&](const engine::Contact& c) {
    ++contacts;
    if (c.r[2] > 0) slip = std::max(slip, c.u_C.head<2>().norm());
    engine::ContactVector u_free_C = engine::ContactVector::Zero();
    engine::relativeVelocity(c, engine::mover(scratch, c.a).free, engine::mover(scratch, c.b).free,
                             engine::rowsOf(c.material), u_free_C.data());
    speed = std::max({speed, c.u_C.norm(), u_free_C.norm()});
  });
  engine::forEachContact(scratch, [&](const engine::Contact& c) {
    if (engine::rowsOf(c.material) > 3) return;
    const double w = inverseMass(model, scratch, c.a) + inverseMass(model, scratch, c.b);
    const Vec3 u = c.u_C + Vec3(0, 0, c.mu * c.u_C.head<2>().norm());
    speed = std::max(speed, w * c.r.head<3>().norm());
    worst = std::max(worst, w * (c.r.head<3>() - ontoCone(c.r.head<3>() - u / w, c.mu)).norm());
  });
  const double allowed =
      contacts <= kFew ? kContent : std::max(kMostAccuracies * model.options.solver.accuracy, kOfSlip * slip);
  return worst <= kTolerance * speed + allowed
             ? std::string()
             : fmt::format("contact law missed by {:.3g} of {:.3g} m/s", worst, speed);
}

double totalEnergy(const engine::WorldModel& model, const engine::WorldState& state) {
  return engine::kineticEnergy(model, state) + engine::potentialEnergy(model, state);
}

}  // namespace pincer::tasks
