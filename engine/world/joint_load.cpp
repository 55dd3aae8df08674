// Forces that joints carry: Newton's and Euler's laws for all that hangs on a joint, over
// the last part of the tick, at its middle.
//
//   f = sum over bodies beyond the joint of (m (v+ - v)/h - m g - f_applied) - contacts'
//   impulses/h,     moments likewise about J
#include <algorithm>
#include <limits>
#include <vector>

#include "pincer/contact/assert.h"
#include "pincer/engine/step.h"
#include "pincer/engine/world/scratch.h"

namespace pincer::engine {
namespace {

constexpr char kFarSide = 1;  // mark of a body that hangs on the joint

bool isFree(const WorldModel& model, int body) { return body >= 0 && model.bodies[body].dynamic; }

// Marks the bodies that hang on the joint's body `first`. False if the joint's other
// one is among them, or what doesn't move.
bool findBeyond(const WorldModel& model, int joint, int first, std::vector<char>& beyond) {
  std::fill(beyond.begin(), beyond.end(), char{0});
  if (!isFree(model, first)) return false;
  beyond[first] = kFarSide;
  for (bool grows = true; grows;) {
    grows = false;
    for (int j = 0; j < static_cast<int>(model.joints.size()); ++j) {
      const JointModel& other = model.joints[j];
      if (j == joint) continue;
      if (!isFree(model, other.b)) {
        if (beyond[other.a] == kFarSide) return false;
      } else if (beyond[other.a] != beyond[other.b]) {
        beyond[other.a] = beyond[other.b] = kFarSide;
        grows = true;
      }
    }
  }
  const int last = first == model.joints[joint].a ? model.joints[joint].b : model.joints[joint].a;
  return !isFree(model, last) || beyond[last] != kFarSide;
}

// A force and its moment about a point.
struct Wrench {
  Vec3 f_W = Vec3::Zero(), moment_W = Vec3::Zero();
  void add(const Vec3& at_W, const Vec3& force_W, const Vec3& torque_W) {
    f_W += force_W;
    moment_W += at_W.cross(force_W) + torque_W;
  }
};

// Inertia forces of a body less its weight.
void addInertia(const WorldModel& model, const WorldState& state, const WorldScratch& scratch, int i, const Vec3& p_WJ,
                Wrench& sum) {
  const BodyModel& body = model.bodies[i];
  const BodyScratch& s = scratch.bodies[i];
  const BodyState& end = state.bodies[i];
  const auto angular = [&](const Vec3& w_W) {
    return Vec3(s.X_WI_mid.q * body.moments.cwiseProduct(s.X_WI_mid.q.conjugate() * w_W));
  };
  const bool rests = end.v_W.isZero(0) && end.L_W.isZero(0);
  const Vec3 w_end_W = bodyAngularVelocity(model, state, i),
             w_mid_W = rests ? Vec3(Vec3::Zero()) : Vec3(0.5 * (s.start.w_W + w_end_W));
  const Vec3 dv_W = rests ? Vec3(Vec3::Zero()) : Vec3(end.v_W - s.start.v_W);
  const Vec3 dL_W =
      rests ? Vec3(Vec3::Zero()) : Vec3(angular(w_end_W - s.start.w_W) + scratch.h * w_mid_W.cross(angular(w_mid_W)));
  sum.add(s.X_WI_mid.p - p_WJ, body.mass * (dv_W / scratch.h - scratch.gravity_W), dL_W / scratch.h);
}

}  // namespace

JointLoad jointLoadAt(const WorldModel& model, const WorldState& state, const WorldScratch& scratch, int joint,
                      const AppliedForces& applied) {
  PINCER_DEMAND(joint >= 0 && joint < std::ssize(model.joint_places),
                "jointLoadAt: the joint is one that addJoint returned");
  if (!(scratch.h > 0)) return {};
  const int place = model.joint_places[joint].joint;
  const JointModel& own = model.joints[place];
  std::vector<char> beyond(model.bodies.size());
  const bool hangs = findBeyond(model, place, own.a, beyond);
  if (!hangs && !findBeyond(model, place, own.b, beyond)) {
    const Vec3 unknown = Vec3::Constant(std::numeric_limits<double>::quiet_NaN());
    return {unknown, unknown};
  }
  const Pose X_WJ = scratch.bodies[own.a].X_WI_mid * own.X_AJ;
  Wrench sum;
  for (int i = 0; i < static_cast<int>(model.bodies.size()); ++i) {
    if (beyond[i] != kFarSide) continue;
    addInertia(model, state, scratch, i, X_WJ.p, sum);
    if (!applied.forces.empty())
      sum.add(scratch.bodies[i].X_WI_mid.p - X_WJ.p, -applied.forces[i].f_W, -applied.forces[i].tau_W);
  }
  const auto takeAway = [&](const Contact& c, const Side& side, double sign) {
    if (side.kind != SideKind::kBody || beyond[side.index] != kFarSide) return;
    Vec3 moment_W = Vec3::Zero();
    for (int k = kTorsionRow; k < rowsOf(c.material); ++k) moment_W += (radiusOf(c, k) * c.r[k]) * axisOf(c, k);
    sum.add(c.p_W - X_WJ.p, (-sign / scratch.h) * c.impulse_W, (-sign / scratch.h) * moment_W);
  };
  forEachContact(scratch, [&](const Contact& c) {
    if (!c.active()) return;
    takeAway(c, c.a, 1);
    takeAway(c, c.b, -1);
  });
  const Quat q_JW = X_WJ.q.conjugate();
  const double sign = hangs ? 1 : -1;
  return {q_JW * (sign * sum.f_W), q_JW * (sign * sum.moment_W)};
}

}  // namespace pincer::engine
