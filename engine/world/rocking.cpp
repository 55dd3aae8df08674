#include "pincer/engine/world/rocking.h"

#include <algorithm>

#include "pincer/contact/functions/invariants.h"
#include "pincer/engine/world/contact_sides.h"
#include "pincer/engine/world/joints.h"

namespace pincer::engine {
namespace {

constexpr double kSlow = 1;      // trace of T, up to which a tick follows: a sixth of a swing
constexpr double kShare = 0.75;  // Gamma over T where T is large: the eigenvalues are 0 and -1/3 then

bool isFree(const BodyModel& body) { return body.dynamic && !isJoined(body); }

Mat3 rootOf(const WorldModel& model, const BodyScratch& body, int index) {
  return rootOfInertia(model.bodies[static_cast<std::size_t>(index)].rotation, body.X_WI_mid.q);
}

// The load of a point's contact with what it wanders on, over h [N s].
double loadOn(const WorldScratch& scratch, int point) {
  const std::uint64_t id = scratch.points[static_cast<std::size_t>(point)].wander_id;
  for (const Contact& c : scratch.contacts) {
    if (c.id == id) return c.memory && c.memory->active ? c.memory->r[kNormalRow] : 0;
  }
  return 0;
}

// Notes what a point's contact adds to h^2 f W of its body.
void gatherWander(const WorldModel& model, double load, const PointScratch& point, BodyScratch& body) {
  if (!isFree(model.bodies[static_cast<std::size_t>(point.wanders_on)]) || point.inverse_turn > 0) return;
  Rocking& rocking = body.rocking;
  if (!body.rocks) rocking.wander_W.setZero();
  body.rocks = true;
  rocking.wander_W += load * point.wander_W;
  rocking.w_W = point.free.w_W;
}

void steady(const Mat3& F, BodyScratch& body) {
  Rocking& rocking = body.rocking;
  const Mat3 T = F.transpose() * rocking.wander_W * F;
  body.rocks = T.trace() > kSlow;
  if (!body.rocks) return;
  const Mat3 unit = Mat3::Identity(), gamma = kShare * T * T * (unit + T).inverse(), F_inverse = F.inverse();
  const Mat3 symmetric = 0.5 * (gamma + gamma.transpose());
  rocking.g_W = F_inverse.transpose() * symmetric * F_inverse;
  const Mat3 L = (unit + symmetric).llt().matrixL();
  rocking.root_W = F * L.transpose().inverse();
  body.free.w_W = rocking.w_W + rocking.root_W * (L.inverse() * (F_inverse * (body.free.w_W - rocking.w_W)));
}

}  // namespace

void steadyRocking(const WorldModel& model, const WorldState& state, WorldScratch& scratch) {
  if (!(scratch.h > 0 && state.h_last > 0)) return;
  bool may_rock = false;
  const double from_last = scratch.h * scratch.h / state.h_last;
  for (std::size_t p = 0; p < scratch.points.size(); ++p) {
    const PointScratch& point = scratch.points[p];
    if (point.wanders_on < 0) continue;
    may_rock = true;
    gatherWander(model, from_last * loadOn(scratch, static_cast<int>(p)), point,
                 scratch.bodies[static_cast<std::size_t>(point.wanders_on)]);
  }
  for (std::size_t i = 0; may_rock && i < scratch.bodies.size(); ++i) {
    BodyScratch& body = scratch.bodies[i];
    if (body.rocks) steady(rootOf(model, body, static_cast<int>(i)), body);
  }
}

void resistRocking(WorldScratch& scratch) {
  for (BodyScratch& body : scratch.bodies) {
    if (!body.rocks) continue;
    const Rocking& rocking = body.rocking;
    const Vec3 gained_W = body.angular_impulse_W - body.free_angular_impulse_W;
    const Vec3 w_W = body.free.w_W + rocking.root_W * (rocking.root_W.transpose() * gained_W);
    body.angular_impulse_W -= rocking.g_W * (w_W - rocking.w_W);
  }
}

}  // namespace pincer::engine
