// Where everything would be in the middle of the tick, and how fast at its end, if nothing touched.
#include "pincer/contact/functions/invariants.h"
#include "pincer/engine/motion/driven_motion.h"
#include "pincer/engine/motion/free_motion.h"
#include "pincer/engine/world/held_body.h"
#include "pincer/engine/world/island_sleep.h"
#include "pincer/engine/world/joints.h"
#include "pincer/engine/world/stages.h"
#include "pincer/engine/world/tree_motion.h"
#include "pincer/engine/world/unchanged_pairs.h"

namespace pincer::engine {
namespace {

// Angular velocities, and the orientation in the middle; a body without angular momentum needs no thought.
void predictRotation(const FreeRotation& rotation, const BodyState& s, double h, BodyScratch& out) {
  out.X_WI_mid.q = s.X_WI.q;
  out.start.w_W.setZero();
  out.free.w_W.setZero();
  if (s.L_W.isZero(0)) return;
  rotateFreely(rotation, s.L_W, 0.5 * h, out.X_WI_mid.q);
  out.start.w_W = out.free.w_W = angularVelocity(rotation, s.X_WI.q, s.L_W);
  if (rotation.kind == FreeRotation::Kind::kSpherical) return;
  Quat q_end = out.X_WI_mid.q;
  rotateFreely(rotation, s.L_W, 0.5 * h, q_end);
  out.free.w_W = angularVelocity(rotation, q_end, s.L_W);
}

void place(const BodyModel& body, BodyScratch& out) {
  out.X_WB_mid = body.body_is_inertial ? out.X_WI_mid : out.X_WI_mid * body.X_IB;
  out.R_WB_mid = out.X_WB_mid.q.toRotationMatrix();
}

void predictBody(const BodyModel& body, const BodyState& s, const Vec3& dv_gravity_W, const BodyForce* force, double h,
                 BodyScratch& out) {
  PINCER_ASSERT(isUnitIfFinite(s.X_WI.q));
  out.rocks = false;
  out.start.v_W = s.v_W;
  out.free.v_W = s.v_W + dv_gravity_W;
  out.free_angular_impulse_W.setZero();
  if (force) {
    out.free.v_W += h * body.inverse_mass * force->f_W;
    out.free_angular_impulse_W = h * force->tau_W;
  }
  if (!body.may_touch) return;  // moves alone: advance needs nothing more
  out.X_WI_mid.p = s.X_WI.p + (0.5 * h) * s.v_W;
  predictRotation(body.rotation, s, h, out);
  if (force) out.free.w_W += angularVelocity(body.rotation, out.X_WI_mid.q, out.free_angular_impulse_W);
  place(body, out);
  if (body.joint_group >= 0) out.inverse_inertia_W = inverseInertia(body.rotation, out.X_WI_mid.q);
}

void predictHeld(const WorldModel& model, const WorldState& state, int i, WorldScratch& scratch) {
  const BodyModel& body = model.bodies[i];
  predictHeldBody(model, state, model.joint_groups[body.joint_group], scratch, scratch.joint_groups[body.joint_group]);
  if (model.joint_groups[body.joint_group].may_touch) place(body, scratch.bodies[i]);
}

void predictDriven(const BodyState& s, const Vec3& w_W, const MotionInput& in, double h, BodyScratch& out) {
  PINCER_ASSERT(h > 0);
  out.X_WB_end = in.X_WB;
  out.start = {s.v_W, w_W};
  out.free = in.motion;
  // Predicted as that of a dynamic body: what rests on it has its acceleration,
  // and the gap between them must not show it.
  out.X_WI_mid = {quatFromRotationVector(0.5 * h * w_W) * s.X_WI.q, s.X_WI.p + 0.5 * h * s.v_W};
  // A body that slides on it is measured against the way that it goes, not against the mean of two velocities.
  out.end.v_W = 2 / h * (in.X_WB.p - s.X_WI.p) - s.v_W;
  out.end.w_W = 2 / h * rotationVectorOf(in.X_WB.q * s.X_WI.q.conjugate()) - w_W;
}

// One axis of a driven point: (effective mass) v+ = momentum + contact impulse, with the
// spring-damper's impulse over the tick inside. The axis at the start: error e = p - target, velocity
// v, the target's motion over the tick, the force f.
struct AxisInput {
  double m, k, d, e, v, v_target, v_target_end, target_step, f, h;
};

// Spring impulse -k [h (e + e+)/2 - h^2/6 (e'+ - e')], damper impulse -d (change of e), kinematics p+ = p + h (v +
// v+)/2. With the 1/6 the scheme is Numerov's (Fox and Goodwin, Proc. Camb. Phil. Soc. 45 (1949) 373-388): the
// error of frequency is 4th order, not 2nd.
double fourthOrderMass(const AxisInput& a) { return a.m + a.k * a.h * a.h / 12 + 0.5 * a.d * a.h; }
double fourthOrderMomentum(const AxisInput& a) {
  const double spring =
      a.k * a.h * (a.e + a.h * (5.0 / 12 * a.v + (a.v_target_end - a.v_target) / 6) - 0.5 * a.target_step);
  const double damper = a.d * (0.5 * a.h * a.v - a.target_step);
  return a.m * a.v + a.h * a.f - spring - damper;
}

// Force at the end of the tick: k and d act on the end values, which are implicit in v+. `theta`: share
// of v+ in the displacement, PointScratch.
double implicitMass(const AxisInput& a, double theta) { return a.m + a.h * a.d + a.h * a.h * a.k * theta; }
double implicitMomentum(const AxisInput& a, double theta) {
  const double spring = a.h * a.k * (a.e + (1 - theta) * a.h * a.v - a.target_step);
  return a.m * a.v + a.h * (a.f + a.d * a.v_target_end) - spring;
}

// theta: second order where that leaves no more than a third of what the velocity was off by to the next tick, with the
// sign turned. Of a tip without mass nor damping all of it is left at one half, for ever, and in a hollow it grows:
// where there are hollows such a tip is first order (decision 17).
//   (m - h^2 k (1 - theta)) / (m + h d + h^2 k theta) >= -1/3
double shareOfEnd(const AxisInput& a, bool touching, bool has_hollows) {
  const double stiff = a.h * a.h * a.k;
  if (!touching || !has_hollows || !(stiff > 0)) return touching ? 0.5 : 1.0;
  return std::max(0.5, 0.75 - (a.m + 0.25 * a.h * a.d) / stiff);
}

// How it turns: as the device does, and about the contact normal past that, against a spring without inertia.
void predictTwist(const DrivenPointModel& point, const PointState& s, const PointInput& in, double h,
                  PointScratch& out) {
  out.start.w_W = out.free.w_W = out.input_ok ? in.w_W : Vec3::Zero();
  out.inverse_twist = 0;
  if (!(point.twist_stiffness + point.twist_damping > 0)) return;
  const AxisInput a{0, point.twist_stiffness, point.twist_damping, s.twist, s.twist_rate, 0, 0, 0, 0, h};
  const double theta = out.twist_share_of_end = s.touching ? 0.5 : 1.0;
  out.inverse_twist = 1 / implicitMass(a, theta);
  out.twist_rate = out.inverse_twist * implicitMomentum(a, theta);
  PINCER_ASSERT(!out.input_ok || isUnit(in.n_W));
  if (out.input_ok) out.R_WA.col(2) = in.n_W;
  out.start.w_W += s.twist_rate * out.R_WA.col(2);
  out.free.w_W += out.twist_rate * out.R_WA.col(2);
}

// The same about every axis.
void predictTurn(const DrivenPointModel& point, const PointState& s, double h, PointScratch& out) {
  out.inverse_turn = 0;
  if (!(point.turn_stiffness + point.turn_damping > 0)) return;
  out.told_w_W = out.start.w_W;
  const AxisInput axis{0, point.turn_stiffness, point.turn_damping, 0, 0, 0, 0, 0, 0, h};
  const double theta = out.turn_share_of_end = shareOfEnd(axis, s.touching, true);
  out.inverse_turn = 1 / implicitMass(axis, theta);
  out.turn_rate_W = -h * point.turn_stiffness * out.inverse_turn * (s.turn_W + (1 - theta) * h * s.turn_rate_W);
  out.start.w_W += s.turn_rate_W;
  out.free.w_W += out.turn_rate_W;
}

// A driven point's error, velocities, the target's motion over the tick and the force, all in one frame.
struct PointMotion {
  Vec3 e, v, v_target, v_target_end, target_step, f;

  PointMotion in(const Mat3& R) const {
    return {R.transpose() * e,           R.transpose() * v, R.transpose() * v_target, R.transpose() * v_target_end,
            R.transpose() * target_step, R.transpose() * f};
  }
};

// The same from tick to tick, as long as the point touches, or doesn't, in parts of the same length.
void findMobility(const DrivenPointModel& point, const std::array<AxisForm, 3>& forms, bool touching, double h,
                  PointScratch& out) {
  if (out.mobility_h == h && out.mobility_touching == touching) return;
  out.mobility_h = h;
  out.mobility_touching = touching;
  for (int i = 0; i < 3; ++i) {
    const AxisInput a{point.mass, point.stiffness[i], point.damping[i], 0, 0, 0, 0, 0, 0, h};
    out.share_of_end[i] = forms[i] == AxisForm::kFourthOrder ? 0.5 : shareOfEnd(a, touching, out.has_hollows);
    if (forms[i] == AxisForm::kLocked) out.inverse_mass[i] = 0;
    if (forms[i] == AxisForm::kFourthOrder) out.inverse_mass[i] = 1 / fourthOrderMass(a);
    if (forms[i] == AxisForm::kImplicit) out.inverse_mass[i] = 1 / implicitMass(a, out.share_of_end[i]);
  }
  PINCER_ASSERT(out.inverse_mass.allFinite() && out.inverse_mass.minCoeff() >= 0);
  out.root_inverse_mass = out.inverse_mass.cwiseSqrt();
}

void predictAxes(const DrivenPointModel& point, const std::array<AxisForm, 3>& forms, const PointMotion& m,
                 bool touching, double h, PointScratch& out) {
  findMobility(point, forms, touching, h, out);
  for (int i = 0; i < 3; ++i) {
    const AxisInput a{point.mass,    point.stiffness[i], point.damping[i], m.e[i], m.v[i],
                      m.v_target[i], m.v_target_end[i],  m.target_step[i], m.f[i], h};
    double v_free = m.v_target_end[i];
    if (forms[i] == AxisForm::kFourthOrder) v_free = out.inverse_mass[i] * fourthOrderMomentum(a);
    if (forms[i] == AxisForm::kImplicit) v_free = out.inverse_mass[i] * implicitMomentum(a, out.share_of_end[i]);
    out.free.v_W[i] = v_free;
  }
}

[[gnu::always_inline]] inline void predictPoint(const DrivenPointModel& point, const std::array<AxisForm, 3>& forms,
                                                const PointState& s, const PointInput& in, double h,
                                                PointScratch& out) {
  out.p_target_W = out.input_ok ? in.p_target_W : s.p_target_W;
  out.v_target_W = out.input_ok ? in.v_target_W : Vec3::Zero();
  out.start.v_W = s.v_W;
  out.turned = in.turned && out.input_ok;
  out.wanders_on = -1;
  const PointMotion motion_W{s.p_W - s.p_target_W,
                             s.v_W,
                             s.v_target_W,
                             out.v_target_W,
                             out.p_target_W - s.p_target_W,
                             out.input_ok ? in.f_W : Vec3::Zero()};
  if (out.turned) {
    PINCER_ASSERT(isUnit(in.n_W));
    out.R_WA = frameFromNormal(in.n_W);
    predictAxes(point, forms, motion_W.in(out.R_WA), s.touching, h, out);
    out.free.v_W = out.R_WA * out.free.v_W.eval();
  } else {
    predictAxes(point, forms, motion_W, s.touching, h, out);
  }
  for (int i = 0; i < 3; ++i)
    out.p_mid_W[i] =
        forms[i] == AxisForm::kLocked ? 0.5 * (s.p_W[i] + out.p_target_W[i]) : s.p_W[i] + 0.5 * h * s.v_W[i];
  predictTwist(point, s, in, h, out);
  predictTurn(point, s, h, out);
}

void predictBodies(const WorldModel& model, const WorldState& state, WorldScratch& scratch) {
  const double h = scratch.h;
  const Vec3 dv_gravity_W = h * scratch.gravity_W;
  for (std::size_t i = 0; i < model.bodies.size(); ++i) {
    if (isHeldBody(model, model.bodies[i])) {
      predictHeld(model, state, static_cast<int>(i), scratch);
    } else if (model.bodies[i].tree >= 0) {
      continue;  // predictTrees
    } else if (model.bodies[i].dynamic) {
      if (isIdle(scratch, static_cast<int>(i))) continue;
      const BodyCourse before = courseOf(scratch.bodies[i]);
      predictBody(model.bodies[i], state.bodies[i], dv_gravity_W, forceOn(scratch, i), h, scratch.bodies[i]);
      noteCourse(before, model.bodies[i].joint_group < 0, scratch, scratch.bodies[i]);
    } else {
      BodyScratch& body = scratch.bodies[i];
      const BodyCourse before = courseOf(body);
      body.X_WI_mid = state.bodies[i].X_WI;
      if (const int n = model.bodies[i].motion; n >= 0)
        predictDriven(state.bodies[i], state.driven_w_W[n], scratch.motion_inputs[n], h, body);
      place(model.bodies[i], scratch.bodies[i]);
      noteCourse(before, !model.bodies[i].driven, scratch, body);
    }
  }
}

}  // namespace

void predict(const WorldModel& model, const WorldState& state, WorldScratch& scratch) {
  predictBodies(model, state, scratch);
  if (!model.trees.empty()) predictTrees(model, state, scratch);
  for (std::size_t i = 0; i < model.points.size(); ++i) {
    predictPoint(model.points[i], model.point_forms[i], state.points[i], scratch.point_inputs[i], scratch.h,
                 scratch.points[i]);
  }
  if (!model.joint_groups.empty()) predictJoints(model, scratch);
  scratch.fast_pairs.clear();
}

void predictImpact(const WorldModel& model, const WorldState& state, WorldScratch& scratch) {
  scratch.h = 0;
  for (std::size_t i = 0; i < model.bodies.size(); ++i) {
    BodyScratch& out = scratch.bodies[i];
    const BodyState& s = state.bodies[i];
    out.rocks = false;
    out.X_WI_mid = s.X_WI;
    out.start = {s.v_W, bodyAngularVelocity(model, state, static_cast<int>(i))};
    out.free = out.end = out.start;
    out.free_angular_impulse_W.setZero();
    if (model.bodies[i].dynamic) out.inverse_inertia_W = inverseInertia(model.bodies[i].rotation, s.X_WI.q);
    place(model.bodies[i], out);
    if (isHeldBody(model, model.bodies[i])) predictHeld(model, state, static_cast<int>(i), scratch);
  }
  for (std::size_t i = 0; i < model.points.size(); ++i) {
    PointScratch& out = scratch.points[i];
    const double mass = model.points[i].mass;
    out.p_mid_W = state.points[i].p_W;
    out.start.v_W = out.free.v_W = out.end.v_W = state.points[i].v_W;
    out.turned = false;
    out.inverse_twist = out.inverse_turn = 0;
    for (int axis = 0; axis < 3; ++axis)
      out.inverse_mass[axis] = model.points[i].locked[axis] || mass <= 0 ? 0 : 1 / mass;
    out.root_inverse_mass = out.inverse_mass.cwiseSqrt();
    out.mobility_h = 0;
  }
  if (!model.joint_groups.empty()) predictJoints(model, scratch);
  if (!model.trees.empty()) predictTreeImpacts(model, state, scratch);
  forgetContacts(scratch);
  scratch.fast_pairs.clear();
}

}  // namespace pincer::engine
