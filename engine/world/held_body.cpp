#include "pincer/engine/world/held_body.h"

#include <cmath>

#include "pincer/contact/functions/invariants.h"
#include "pincer/engine/motion/free_motion.h"
#include "pincer/engine/motion/one_freedom.h"

namespace pincer::engine {
namespace {

bool isPivot(const WorldModel& model, const JointGroup& g) { return model.joints[g.first].kind == JointKind::kPivot; }

void findAxis(const WorldModel& model, const WorldState& state, const JointGroup& g, HeldScratch& held) {
  const JointModel& joint = model.joints[g.first];
  const Pose X_WJ = joint.b < 0 ? joint.X_BJ : state.bodies[joint.b].X_WI * joint.X_BJ;
  held.p_WJ = X_WJ.p;
  held.axis_W = X_WJ.q * Vec3::UnitZ();
  PINCER_ASSERT(isUnitIfFinite(held.axis_W));
}

double rateOf(const WorldModel& model, const JointGroup& g, const HeldScratch& held, const BodyState& s) {
  if (!isPivot(model, g)) return held.axis_W.dot(s.v_W);
  const Vec3 arm_W = s.X_WI.p - held.p_WJ;
  return held.axis_W.dot(s.L_W + model.bodies[g.bodies.front()].mass * arm_W.cross(s.v_W)) / g.inertia;
}

// A force that is the same all through the tick bends a pivot's course as a further gravity does.
OneFreedomLaw lawOf(const WorldModel& model, const JointGroup& g, const WorldScratch& scratch, const HeldScratch& held,
                    const BodyState& s) {
  const int body = g.bodies.front();
  const BodyForce* const force = forceOn(scratch, static_cast<std::size_t>(body));
  const Vec3 g_W = force ? Vec3(scratch.gravity_W + model.bodies[body].inverse_mass * force->f_W) : scratch.gravity_W,
             arm_W = s.X_WI.p - held.p_WJ;
  const double c = model.joints[g.first].damping / g.inertia;
  if (!isPivot(model, g)) return {held.axis_W.dot(g_W), 0, c, 0, false};
  const double k = model.bodies[body].mass / g.inertia;
  const double across = arm_W.dot(g_W) - arm_W.dot(held.axis_W) * g_W.dot(held.axis_W);
  return {k * held.axis_W.dot(arm_W.cross(g_W)), -k * across, c, force ? held.axis_W.dot(force->tau_W) / g.inertia : 0,
          true};
}

// The inertial frame once the coordinate has grown by `way`; an axis that has
// left the joint's by round-off is put back.
Pose placeAt(const WorldModel& model, const JointGroup& g, const HeldScratch& held, const Pose& X_WI, double way) {
  if (way == 0) return X_WI;
  if (!isPivot(model, g)) return {X_WI.q, X_WI.p + way * held.axis_W};
  const Quat q = quatFromRotationVector(way * held.axis_W) * X_WI.q;
  const Vec3 axis_W = q * g.axis_A, miss_W = axis_W.cross(held.axis_W);
  const Quat back(1 + axis_W.dot(held.axis_W), miss_W.x(), miss_W.y(), miss_W.z());
  const Quat q_WI = (back * q).normalized();
  return {q_WI, held.p_WJ - q_WI * model.joints[g.first].X_AJ.p};
}

Motion motionAt(const WorldModel& model, const JointGroup& g, const HeldScratch& held, const Pose& X_WI, double rate) {
  if (!isPivot(model, g)) return {rate * held.axis_W, Vec3::Zero()};
  return {rate * held.axis_W.cross(X_WI.p - held.p_WJ), rate * held.axis_W};
}

Vec3 angularMomentum(const BodyModel& body, const Quat& q_WI, const Vec3& w_W) {
  return q_WI * body.moments.cwiseProduct(q_WI.conjugate() * w_W);
}

BodyState stateAt(const WorldModel& model, const JointGroup& g, const HeldScratch& held, const Pose& X_WI,
                  double rate) {
  const Motion motion = motionAt(model, g, held, X_WI, rate);
  return {X_WI, motion.v_W, angularMomentum(model.bodies[g.bodies.front()], X_WI.q, motion.w_W)};
}

// F's only column: what a unit of the coordinate's rate is to the body in the middle
// of the tick, over the root of its inertia.
void fillFactor(const WorldModel& model, const JointGroup& g, const Pose& X_WI_mid, JointGroupScratch& group) {
  const Motion unit = motionAt(model, g, group.held, X_WI_mid, std::sqrt(group.held.inverse_inertia));
  for (int k = 0; k < 3; ++k) {
    group.factor[k] = unit.v_W[k];
    group.factor[3 + k] = unit.w_W[k];
  }
}

}  // namespace

void predictHeldBody(const WorldModel& model, const WorldState& state, const JointGroup& g, WorldScratch& scratch,
                     JointGroupScratch& group) {
  const int i = g.bodies.front();
  const BodyState& s = state.bodies[i];
  BodyScratch& out = scratch.bodies[i];
  HeldScratch& held = group.held;
  findAxis(model, state, g, held);
  held.gained_rate = 0;
  held.start_rate = rateOf(model, g, held, s);
  const OneFreedomLaw law = lawOf(model, g, scratch, held, s);
  const OneFreedomCourse end = followFreedom(law, held.start_rate, scratch.h);
  held.free_way = end.way;
  held.free_rate = end.rate;
  // As of free bodies without the force of this part of the tick: what rests must be found where it is.
  out.X_WI_mid = placeAt(model, g, held, s.X_WI, 0.5 * scratch.h * held.start_rate);
  out.start = motionAt(model, g, held, s.X_WI, held.start_rate);
  if (!g.may_touch) return;
  out.free = motionAt(model, g, held, placeAt(model, g, held, s.X_WI, end.way), end.rate);
  out.end = out.free;
  held.inverse_inertia = dampedShare(law.c, scratch.h) / g.inertia;
  PINCER_ASSERT(held.inverse_inertia > 0);
  held.gained_way = scratch.h * dampedWay(law.c, scratch.h);
  fillFactor(model, g, out.X_WI_mid, group);
}

void gatherHeldBody(const WorldModel& model, const JointGroup& g, WorldScratch& scratch, JointGroupScratch& group) {
  BodyScratch& out = scratch.bodies[g.bodies.front()];
  const BodyModel& body = model.bodies[g.bodies.front()];
  HeldScratch& held = group.held;
  held.gained_rate = 0;
  if (!out.touched) return;
  const Motion unit = motionAt(model, g, held, out.X_WI_mid, 1);
  held.gained_rate = held.inverse_inertia * (unit.v_W.dot(out.impulse_W) + unit.w_W.dot(out.angular_impulse_W));
  out.inverse_inertia_W = inverseInertia(body.rotation, out.X_WI_mid.q);
  out.impulse_W = body.mass * held.gained_rate * unit.v_W;
  out.angular_impulse_W = angularMomentum(body, out.X_WI_mid.q, held.gained_rate * unit.w_W);
}

void advanceHeldBody(const WorldModel& model, const JointGroup& g, const JointGroupScratch& group, double h,
                     BodyScratch& scratch, BodyState& s) {
  s = heldBodyAt(model, g, group, scratch, s, h, h);
  if (scratch.touched)
    scratch.end = motionAt(model, g, group.held, s.X_WI, group.held.free_rate + group.held.gained_rate);
}

BodyState heldBodyAt(const WorldModel& model, const JointGroup& g, const JointGroupScratch& group,
                     const BodyScratch& scratch, const BodyState& s, double h, double t) {
  PINCER_ASSERT(h > 0 && t >= 0);
  const HeldScratch& held = group.held;
  const double share = t / h, end_rate = held.free_rate + held.gained_rate;
  if (scratch.closing) return stateAt(model, g, held, placeAt(model, g, held, s.X_WI, t * end_rate), end_rate);
  // The part of the free course beyond the mean of its rates goes with the square of the time, as that does.
  const double gained = held.gained_way * held.gained_rate, bent = held.free_way - h * held.start_rate + gained;
  const double way = t == h ? held.free_way + gained : t * held.start_rate + share * share * bent;
  return stateAt(model, g, held, placeAt(model, g, held, s.X_WI, way),
                 held.start_rate + share * (end_rate - held.start_rate));
}

}  // namespace pincer::engine
