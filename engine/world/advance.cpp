// From impulses to momenta, from momenta to poses.
#include <algorithm>
#include <span>

#include "pincer/engine/motion/driven_motion.h"
#include "pincer/engine/motion/free_motion.h"
#include "pincer/engine/world/contact_rows.h"
#include "pincer/engine/world/held_body.h"
#include "pincer/engine/world/impact.h"
#include "pincer/engine/world/island_sleep.h"
#include "pincer/engine/world/joint_rows.h"
#include "pincer/engine/world/joints.h"
#include "pincer/engine/world/rest.h"
#include "pincer/engine/world/rocking.h"
#include "pincer/engine/world/stages.h"
#include "pincer/engine/world/tree_motion.h"

namespace pincer::engine {
namespace {

// About p_W, of torsion and rolling friction.
Vec3 momentOf(const Contact& c, int rows) {
  Vec3 moment_W = Vec3::Zero();
  for (int k = kTorsionRow; k < rows; ++k) moment_W += (radiusOf(c, k) * c.r[k]) * axisOf(c, k);
  return moment_W;
}

// Adds the moment of `f` at arm, and of the contact's own.
void addMoment(const Contact& c, double sign, const Vec3& arm, const double (&f)[3], double (&sum)[3]) {
  double moment[3];
  for (int i = 0; i < 3; ++i) {
    const int j = (i + 1) % 3, k = (i + 2) % 3;
    moment[i] = arm[j] * f[k] - arm[k] * f[j];
  }
  if (const int rows = rowsOf(c.material); rows > kTorsionRow) {
    const Vec3 own_W = sign * momentOf(c, rows);
    for (int i = 0; i < 3; ++i) moment[i] += own_W[i];
  }
  for (int i = 0; i < 3; ++i) sum[i] += moment[i];
}

// The pushes of contacts of the same two on one of them, in their order and number by number: four corners of a pad
// would each wait for the sum that the one before has just stored.
//   turn_W  moment about the mover's centre; not read of what doesn't turn by it
template <bool turns>
void gatherPushes(std::span<const Contact> contacts, bool is_a, Vec3* turn_W, MoverScratch& mover) {
  const double sign = is_a ? 1 : -1;
  double sum[3], turn[3];
  for (int i = 0; i < 3; ++i) sum[i] = mover.impulse_W[i];
  for (int i = 0; turns && i < 3; ++i) turn[i] = (*turn_W)[i];
  for (const Contact& c : contacts) {
    if (!c.active()) continue;
    mover.rest_speed = mover.touched ? std::min(mover.rest_speed, c.rest_speed) : c.rest_speed;
    mover.touched = true;
    mover.closing = mover.closing || c.closing;
    const double f[3] = {sign * c.impulse_W[0], sign * c.impulse_W[1], sign * c.impulse_W[2]};
    for (int i = 0; i < 3; ++i) sum[i] += f[i];
    if constexpr (turns) addMoment(c, sign, is_a ? c.arm_a_W : c.arm_b_W, f, turn);
  }
  for (int i = 0; i < 3; ++i) mover.impulse_W[i] = sum[i];
  for (int i = 0; turns && i < 3; ++i) (*turn_W)[i] = turn[i];
}

void gatherTwist(std::span<const Contact> contacts, bool is_a, PointScratch& point) {
  for (const Contact& c : contacts) {
    const int rows = rowsOf(c.material);
    if (c.active() && rows > kTorsionRow) point.twist_impulse += (is_a ? 1 : -1) * momentOf(c, rows).dot(c.n_W());
  }
}

void gatherPushes(std::span<const Contact> contacts, bool is_a, WorldScratch& scratch) {
  const Side& side = is_a ? contacts.front().a : contacts.front().b;
  if (side.kind == SideKind::kBody) {
    BodyScratch& body = scratch.bodies[side.index];
    return gatherPushes<true>(contacts, is_a, &body.angular_impulse_W, body);
  }
  if (side.kind == SideKind::kJoint)
    return gatherPushes<false>(contacts, is_a, nullptr, scratch.joint_rows[side.index]);
  PointScratch& point = scratch.points[side.index];
  gatherTwist(contacts, is_a, point);
  if (point.inverse_turn > 0) return gatherPushes<true>(contacts, is_a, &point.turn_impulse_W, point);
  gatherPushes<false>(contacts, is_a, nullptr, point);
}

void rest(MoverScratch& mover) {
  mover.impulse_W.setZero();
  mover.touched = mover.closing = false;
  mover.rest_speed = 0;
}

constexpr double kLargestMismatch = 1e-6;  // between the ways of two bodies that touch [m]
constexpr int kMostSpreads = 40;           // along the contacts, to and fro

// How far apart the mean of its velocities and the one at the end take a free
// body along n_W in this part of the tick [m].
double mismatchOf(const WorldModel& model, const WorldScratch& scratch, const Side& side, const Vec3& n_W) {
  if (side.kind != SideKind::kBody || !model.bodies[side.index].dynamic || isJoined(model.bodies[side.index])) return 0;
  const Vec3 jump_W = endVelocity(model, scratch, side.index) - scratch.bodies[side.index].start.v_W;
  return 0.5 * scratch.h * std::abs(n_W.dot(jump_W));
}

bool spreadClosing(const WorldModel& model, const Contact& c, WorldScratch& scratch) {
  if (!c.active() || c.mover_a->closing == c.mover_b->closing) return false;
  const Side& side = c.mover_a->closing ? c.b : c.a;
  if (!(mismatchOf(model, scratch, side, c.n_W()) > kLargestMismatch)) return false;
  return scratch.bodies[side.index].closing = true;
}

// A landing body goes by its velocity at the end, and so must one that it stops in turn, or they would end in each
// other by half of the way that was stopped.
void spreadClosing(const WorldModel& model, WorldScratch& scratch) {
  std::vector<Contact>& contacts = scratch.contacts;
  bool spreads =
      std::any_of(contacts.begin(), contacts.end(), [](const Contact& c) { return c.active() && c.closing; });
  for (int n = 0; spreads && n < kMostSpreads; ++n) {
    spreads = false;
    for (std::size_t k = 0; k < contacts.size(); ++k)
      spreads = spreadClosing(model, contacts[n % 2 == 0 ? k : contacts.size() - 1 - k], scratch) || spreads;
  }
}

void advanceDriven(BodyScratch& scratch, BodyState& s, Vec3& w_W) {
  const BodyState end{scratch.X_WB_end, scratch.free.v_W, Vec3::Zero()};
  scratch.still = s.v_W.isZero(0) && w_W.isZero(0) && scratch.free.w_W.isZero(0) && same(end, s);
  s = end;
  w_W = scratch.free.w_W;
}

}  // namespace

void gatherImpulses(const WorldModel& model, WorldScratch& scratch) {
  const bool something_sleeps = isSomethingAsleep(scratch);
  for (std::size_t i = 0; i < model.bodies.size(); ++i) {
    if (something_sleeps && model.bodies[i].dynamic && scratch.sleep.idle[i]) continue;
    BodyScratch& body = scratch.bodies[i];
    rest(body);
    // Impulses of joints and contacts on bodies in joints are gathered first.
    body.angular_impulse_W = model.bodies[i].joint_group < 0 ? body.free_angular_impulse_W : Vec3(Vec3::Zero());
  }
  for (JointRowScratch& row : scratch.joint_rows) rest(row);
  for (PointScratch& point : scratch.points) {
    rest(point);
    point.twist_impulse = 0;
    if (point.inverse_turn > 0) point.turn_impulse_W.setZero();
  }
  const std::span<const Contact> contacts = scratch.contacts;
  for (std::size_t first = 0, end = 0; first < contacts.size(); first = end) {
    for (end = first + 1; end < contacts.size() && isOfSameTwo(contacts[first], contacts[end]);) ++end;
    gatherPushes(contacts.subspan(first, end - first), true, scratch);
    gatherPushes(contacts.subspan(first, end - first), false, scratch);
  }
  if (model.has_hollows) resistRocking(scratch);
  if (scratch.h > 0) spreadClosing(model, scratch);
  if (!model.joint_groups.empty()) gatherJointImpulses(model, scratch);
  if (!model.trees.empty()) gatherTrees(model, scratch);
}

namespace {

bool isSlow(double limit, const Vec3& v, double arm = 1) { return arm * arm * v.squaredNorm() <= limit * limit; }

// Rest, see rest.h.
bool comesToRest(const BodyModel& body, const BodyScratch& scratch, const BodyState& s) {
  const double limit = scratch.rest_speed;
  if (limit == 0 || body.joint_group >= 0) return false;
  if (!isSlow(limit, s.v_W) || !isSlow(limit, scratch.start.v_W)) return false;
  return isSlow(limit, scratch.start.w_W, body.bounding_radius) &&
         isSlow(limit, angularVelocity(body.rotation, s.X_WI.q, s.L_W), body.bounding_radius);
}

void advanceBody(const BodyModel& body, double h, BodyScratch& scratch, BodyState& s) {
  const Vec3 v_old = s.v_W, L_old = s.L_W;
  s.v_W = scratch.free.v_W + body.inverse_mass * scratch.impulse_W;
  s.L_W += scratch.angular_impulse_W;
  scratch.still = false;
  if (comesToRest(body, scratch, s)) {
    s.v_W.setZero();
    s.L_W.setZero();
    scratch.end = {s.v_W, s.L_W};
    scratch.still = v_old.isZero(0) && L_old.isZero(0) && scratch.flung == 0;
    return;
  }
  s.X_WI.p += scratch.closing ? Vec3(h * s.v_W) : Vec3((0.5 * h) * (v_old + s.v_W));
  const Vec3 L_mean = scratch.closing ? s.L_W : Vec3(0.5 * (L_old + s.L_W));
  if (!L_mean.isZero(0)) rotateFreely(body.rotation, L_mean, h, s.X_WI.q);
  scratch.end = scratch.touched ? Motion{s.v_W, angularVelocity(body.rotation, s.X_WI.q, s.L_W)} : scratch.free;
}

// Way in a tick with the velocities `old` and `now` at its ends, of `now` that share; what lands goes by `now` alone.
double wayOf(const PointScratch& scratch, double share_of_end, double h, double old, double now) {
  const double theta = scratch.closing ? 1 : share_of_end;
  return h * ((1 - theta) * old + theta * now);
}

// Past what the device turns.
void advanceTwist(double h, PointScratch& scratch, PointState& s) {
  scratch.end.w_W = scratch.free.w_W;
  if (scratch.inverse_twist <= 0) return;
  const double old = s.twist_rate;
  s.twist_rate = scratch.twist_rate + scratch.inverse_twist * scratch.twist_impulse;
  scratch.end.w_W += scratch.inverse_twist * scratch.twist_impulse * scratch.R_WA.col(2);
  s.twist += wayOf(scratch, scratch.twist_share_of_end, h, old, s.twist_rate);
}

void advanceTurn(double h, PointScratch& scratch, PointState& s) {
  if (scratch.inverse_turn <= 0) return;
  const Vec3 gained_W = scratch.inverse_turn * scratch.turn_impulse_W, old_W = s.turn_rate_W;
  s.turn_rate_W = scratch.turn_rate_W + gained_W;
  scratch.end.w_W += gained_W;
  Vec3 way_W;
  for (int i = 0; i < 3; ++i) way_W[i] = wayOf(scratch, scratch.turn_share_of_end, h, old_W[i], s.turn_rate_W[i]);
  if (scratch.told_w_W.isZero(0) && s.turn_W.isZero(0)) {
    s.turn_W = way_W;
    return;
  }
  const Vec3 told_W = h * scratch.told_w_W;
  s.turn_W = rotationVectorOf(quatFromRotationVector(told_W + way_W) * quatFromRotationVector(s.turn_W) *
                              quatFromRotationVector(-told_W));
}

// In axes of the coupling that aren't the world's; none of them is locked.
void advanceTurned(double h, const Vec3& v_old, const PointScratch& scratch, PointState& s) {
  const Vec3 old_A = scratch.R_WA.transpose() * v_old, new_A = scratch.R_WA.transpose() * s.v_W;
  Vec3 way_A;
  for (int i = 0; i < 3; ++i) way_A[i] = wayOf(scratch, scratch.share_of_end[i], h, old_A[i], new_A[i]);
  s.p_W += scratch.R_WA * way_A;
}

void advancePoint(const std::array<AxisForm, 3>& forms, double h, PointScratch& scratch, PointState& s) {
  const Vec3 v_old = s.v_W;
  s.v_W = scratch.free.v_W + scratch.response(scratch.impulse_W);
  if (scratch.rest_speed > 0 && isSlow(scratch.rest_speed, s.v_W) && isSlow(scratch.rest_speed, v_old)) s.v_W.setZero();
  scratch.end.v_W = s.v_W;
  advanceTwist(h, scratch, s);
  advanceTurn(h, scratch, s);
  if (scratch.turned) advanceTurned(h, v_old, scratch, s);
  for (int i = 0; i < 3 && !scratch.turned; ++i) {
    if (forms[i] == AxisForm::kLocked) {
      s.p_W[i] = scratch.p_target_W[i];
    } else {
      s.p_W[i] += wayOf(scratch, scratch.share_of_end[i], h, v_old[i], s.v_W[i]);
    }
  }
  s.p_target_W = scratch.p_target_W;
  s.v_target_W = scratch.v_target_W;
  // A body that moved by its end velocity alone begins the next tick so too: half of each, for
  // a tip without mass nor damping, diverges.
  s.touching = scratch.touched && !scratch.closing;
}

}  // namespace

void advance(const WorldModel& model, WorldState& state, WorldScratch& scratch) {
  const double h = scratch.h;
  scratch.still_bodies = 0;
  for (std::size_t i = 0; i < model.bodies.size(); ++i) {
    const BodyModel& body = model.bodies[i];
    if (isHeldBody(model, body)) {
      const int n = body.joint_group;
      advanceHeldBody(model, model.joint_groups[n], scratch.joint_groups[n], h, scratch.bodies[i], state.bodies[i]);
    } else if (body.dynamic && body.tree < 0 && !isIdle(scratch, static_cast<int>(i))) {
      advanceBody(body, h, scratch.bodies[i], state.bodies[i]);
      scratch.still_bodies += scratch.bodies[i].still;
    }
    if (body.driven)
      advanceDriven(scratch.bodies[i], state.bodies[i], state.driven_w_W[static_cast<std::size_t>(body.motion)]);
  }
  for (std::size_t i = 0; i < model.points.size(); ++i) {
    advancePoint(model.point_forms[i], h, scratch.points[i], state.points[i]);
    scratch.points[i].tick_impulse_W += scratch.points[i].impulse_W;
  }
  if (!model.joint_groups.empty()) settleJoints(model, state, scratch);
  if (!model.trees.empty()) advanceTrees(model, state, scratch);
  if (!model.trees.empty()) rememberJointRows(model, state, scratch);
  rememberContacts(model, scratch, state);
  state.h_last = h;
}

}  // namespace pincer::engine
