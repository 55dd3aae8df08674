#include "pincer/engine/world/push_out.h"

#include <algorithm>
#include <cmath>
#include <limits>

#include "pincer/contact/functions/invariants.h"
#include "pincer/engine/motion/free_motion.h"
#include "pincer/engine/world/contact_rows.h"

namespace pincer::engine {
namespace {

constexpr int kPushSweeps = 10;  // over all overlaps in a tick; the rest is for the next ones

bool isFree(const WorldModel& model, const Side& side) {
  if (side.kind != SideKind::kBody) return false;
  const BodyModel& body = model.bodies[side.index];
  return body.dynamic && !isJoined(body);
}

double deepGap(const WorldModel& model) { return -(kDeepSpeed / kNormalCorrection) * model.options.h; }

// Points are no body: they are as thick as can be.
double thicknessOf(const WorldModel& model, const Side& side) {
  return side.kind == SideKind::kBody ? model.bodies[side.index].inner_radius : std::numeric_limits<double>::infinity();
}
double thinner(const WorldModel& model, const Contact& c) {
  return std::min(thicknessOf(model, c.a), thicknessOf(model, c.b));
}

// Between walls that close on it nothing is to be gained: it would end as deep in one as in both.
bool isDeep(const WorldModel& model, const Contact& c, double gap) {
  return gap < deepGap(model) && !c.yields && isPushedOut(model, c);
}

// Where the point of a body that touches, at an arm in the middle of this part of the tick, is at its end.
Vec3 pointAfter(const WorldState& state, const WorldScratch& scratch, const Side& side, const Vec3& arm_W) {
  const Pose &end = state.bodies[side.index].X_WI, &mid = scratch.bodies[side.index].X_WI_mid;
  return end.p + end.q * (mid.q.conjugate() * arm_W);
}

// Along the normal of the middle, between the two points that touch there: in the predicted middle
// what lands seems to overlap, and doesn't.
double gapAfter(const WorldState& state, const WorldScratch& scratch, const Contact& c) {
  if (c.a.kind != SideKind::kBody || c.b.kind != SideKind::kBody) return c.phi;
  const Vec3 half_W = 0.5 * c.phi * c.n_W();
  return c.n_W().dot(pointAfter(state, scratch, c.a, c.arm_a_W + half_W) -
                     pointAfter(state, scratch, c.b, c.arm_b_W - half_W));
}

// The contact's normal row on one of its bodies, and that body's mobility.
struct PushSide {
  Motion* push = nullptr;  // null for what doesn't move
  double inverse_mass = 0;
  Vec3 n_W, turn_W;  // what a unit impulse does to the angular velocity
  Vec3 arm_x_n_W;

  PushSide(const WorldModel& model, WorldScratch& scratch, const Side& side, const Vec3& arm_W, const Vec3& normal_W)
      : n_W(normal_W) {
    if (!isFree(model, side)) return;
    BodyScratch& body = scratch.bodies[side.index];
    push = &body.push;
    inverse_mass = model.bodies[side.index].inverse_mass;
    arm_x_n_W = arm_W.cross(n_W);
    turn_W = body.inverse_inertia_W * arm_x_n_W;
  }
  double mobility() const { return push ? inverse_mass + arm_x_n_W.dot(turn_W) : 0; }
  double way() const { return push ? n_W.dot(push->v_W) + arm_x_n_W.dot(push->w_W) : 0; }
  void add(double lambda) const {
    if (!push) return;
    push->v_W += lambda * inverse_mass * n_W;
    push->w_W += lambda * turn_W;
  }
};

void markBodies(const Contact& c, WorldScratch& scratch) {
  for (const Side& side : {c.a, c.b}) {
    if (side.kind == SideKind::kBody) scratch.pushed[static_cast<std::size_t>(side.index)] = true;
  }
}

double wantedWay(const WorldModel& model, const WorldScratch& scratch, const Contact& c, double phi) {
  PINCER_ASSERT(thinner(model, c) > 0);
  if (!isDeep(model, c, phi)) return -std::max(phi - deepGap(model), 0.0);
  const double share = scratch.h / model.options.h;  // of the tick
  const double buried = -phi - thinner(model, c);
  const double largest = kLargestCorrection * model.options.h * std::max(share, -phi / thinner(model, c));
  return std::min(std::max(-kNormalCorrection * share * phi, buried), largest);
}

// True if it pushes otherwise than before.
bool relax(const WorldModel& model, WorldScratch& scratch, const Contact& c, PushedContact& pushed) {
  const PushSide a(model, scratch, c.a, c.arm_a_W, c.n_W()), b(model, scratch, c.b, c.arm_b_W, -c.n_W());
  const double mobility = a.mobility() + b.mobility();
  if (!(mobility > 0)) return false;
  const double want = wantedWay(model, scratch, c, pushed.gap);
  double& lambda = pushed.way;
  const double before = lambda;
  lambda = std::max(0.0, lambda + (want - a.way() - b.way()) / mobility);
  if (lambda == before) return false;
  a.add(lambda - before);
  b.add(lambda - before);
  return true;
}

// Half a sweep, over the contacts of bodies that are deep or were pushed, few in most
// heaps: those are marked in scratch.pushed.
//   standing  those with what stands, or those between two bodies that can be moved
void sweepPushes(const WorldModel& model, bool standing, WorldScratch& scratch) {
  for (std::size_t i = 0; i < scratch.contacts.size(); ++i) {
    const ContactEnds& ends = scratch.islands.ends[i];
    const auto isMarked = [&](int mover) {
      return mover >= 0 && mover < static_cast<int>(scratch.pushed.size()) &&
             scratch.pushed[static_cast<std::size_t>(mover)];
    };
    const Contact& c = scratch.contacts[i];
    if ((isMarked(ends.a) || isMarked(ends.b)) && (isFree(model, c.a) != isFree(model, c.b)) == standing) {
      if (relax(model, scratch, c, scratch.pushed_contacts[i])) markBodies(c, scratch);
    }
  }
}

// The middle of this part of the tick doesn't show how deep a corner goes that turns so far in it: what lifts the body
// then is taken from its own motion, or spin would become height.
void payForLift(const WorldModel& model, const WorldScratch& scratch, std::size_t i, BodyState& body) {
  const double lift = -model.bodies[i].mass * scratch.gravity_W.dot(scratch.bodies[i].push.v_W);
  const Vec3 w_W = angularVelocity(model.bodies[i].rotation, body.X_WI.q, body.L_W);
  if (!(lift > 0) || !(scratch.h * w_W.norm() > kFastTurn)) return;
  const double kinetic = 0.5 * (model.bodies[i].mass * body.v_W.squaredNorm() + body.L_W.dot(w_W));
  const double left = kinetic > lift ? std::sqrt(1 - lift / kinetic) : 0;
  body.v_W *= left;
  body.L_W *= left;
}

}  // namespace

bool isPushedOut(const WorldModel& model, const Contact& c) {
  if (c.a.kind != SideKind::kBody || c.b.kind != SideKind::kBody) return false;
  return !isJoined(model.bodies[c.a.index]) && !isJoined(model.bodies[c.b.index]);
}

void pushOut(const WorldModel& model, WorldState& state, WorldScratch& scratch) {
  const auto staysDeep = [&](const Contact& c) {
    return isDeep(model, c, c.phi) && isDeep(model, c, gapAfter(state, scratch, c));
  };
  if (std::none_of(scratch.contacts.begin(), scratch.contacts.end(), staysDeep)) return;
  for (std::size_t i = 0; i < model.bodies.size(); ++i) {
    scratch.bodies[i].push = {Vec3::Zero(), Vec3::Zero()};
    if (model.bodies[i].dynamic)
      scratch.bodies[i].inverse_inertia_W = inverseInertia(model.bodies[i].rotation, scratch.bodies[i].X_WI_mid.q);
  }
  std::fill(scratch.pushed.begin(), scratch.pushed.end(), false);
  for (std::size_t i = 0; i < scratch.contacts.size(); ++i) {
    const Contact& c = scratch.contacts[i];
    scratch.pushed_contacts[i] = {gapAfter(state, scratch, c), 0};
    if (isDeep(model, c, scratch.pushed_contacts[i].gap)) markBodies(c, scratch);
  }
  // A standing body comes last: between it and something heavier a light body must not end deeper in it than it was.
  for (int sweep = 0; sweep < kPushSweeps; ++sweep) {
    for (const bool standing : {false, true}) sweepPushes(model, standing, scratch);
  }
  for (std::size_t i = 0; i < model.bodies.size(); ++i) {
    const Motion& push = scratch.bodies[i].push;
    if (!model.bodies[i].dynamic || (push.v_W.isZero(0) && push.w_W.isZero(0))) continue;
    const Quat turn = quatFromRotationVector(push.w_W);
    state.bodies[i].X_WI.p += push.v_W;
    state.bodies[i].X_WI.q = (turn * state.bodies[i].X_WI.q).normalized();
    // or a needle that spins would gain energy, turned against its spin
    state.bodies[i].L_W = turn * state.bodies[i].L_W;
    payForLift(model, scratch, i, state.bodies[i]);
  }
}

}  // namespace pincer::engine
