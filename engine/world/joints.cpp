#include "pincer/engine/world/joints.h"

#include <algorithm>

#include "pincer/contact/functions/invariants.h"
#include "pincer/engine/motion/free_motion.h"
#include "pincer/engine/solve/linear.h"
#include "pincer/engine/tree/loop_closure.h"
#include "pincer/engine/world/held_body.h"

namespace pincer::engine {
namespace {

constexpr double kJointRegularisation = 1e-13;  // of A's diagonal

// One side of a joint at one moment: where its frame J is, and how its body answers impulses.
struct JointSide {
  int body = -1;  // -1: the world
  Pose X_WJ;
  Vec3 arm_W = Vec3::Zero();  // J's origin from the centre of mass
};

// Pose, and inverse inertia in W, of the bodies of a group at one moment.
class JointMoment {
 public:
  virtual const Pose& X_WI(int body) const = 0;
  virtual const Mat3& inverseInertia(int body) const = 0;

 protected:
  ~JointMoment() = default;
};

class MiddleOfTick final : public JointMoment {
 public:
  explicit MiddleOfTick(const WorldScratch& scratch) : scratch_(scratch) {}
  const Pose& X_WI(int body) const override { return scratch_.bodies[body].X_WI_mid; }
  const Mat3& inverseInertia(int body) const override { return scratch_.bodies[body].inverse_inertia_W; }

 private:
  const WorldScratch& scratch_;
};

// The inverse inertia of the middle, whatever the pose: any symmetric positive metric projects onto the same joints.
class EndOfTick final : public JointMoment {
 public:
  EndOfTick(const WorldState& state, const WorldScratch& scratch) : state_(state), scratch_(scratch) {}
  const Pose& X_WI(int body) const override { return state_.bodies[body].X_WI; }
  const Mat3& inverseInertia(int body) const override { return scratch_.bodies[body].inverse_inertia_W; }

 private:
  const WorldState& state_;
  const WorldScratch& scratch_;
};

JointSide sideOf(const JointMoment& moment, int body, const Pose& X_IJ) {
  if (body < 0) return {body, X_IJ, Vec3::Zero()};
  const Pose& X_WI = moment.X_WI(body);
  return {body, X_WI * X_IJ, X_WI.q * X_IJ.p};
}

// Fills the rows that the joint blocks; with `e`, how far each is violated.
class RowWriter {
 public:
  RowWriter(const JointModel& joint, const JointMoment& moment, JointGroupScratch& group)
      : a_(sideOf(moment, joint.a, joint.X_AJ)),
        b_(sideOf(moment, joint.b, joint.X_BJ)),
        R_WJ_(b_.X_WJ.q.toRotationMatrix()),
        group_(group) {
    // Impulses act where J of a is on both sides, slid away or missed by what the middle misses: none turns the whole.
    b_.arm_W += a_.X_WJ.p - b_.X_WJ.p;
  }

  const Vec3& armOfA() const { return a_.arm_W; }
  const Vec3& armOfB() const { return b_.arm_W; }

  void writeAll(JointKind kind) {
    const Vec3 apart = a_.X_WJ.p - b_.X_WJ.p;
    for (int k = 0; k < (kind == JointKind::kSlider ? 2 : 3); ++k) point(R_WJ_.col(k), R_WJ_.col(k).dot(apart));
    if (kind == JointKind::kBall) return;
    const Quat q = b_.X_WJ.q.conjugate() * a_.X_WJ.q;
    const Vec3 twist_J = (q.w() < 0 ? -2.0 : 2.0) * q.vec();
    // Of a pivot any angle is allowed: what its axes miss is the turn of a's axis.
    const Vec3 miss_W =
        kind == JointKind::kPivot ? Vec3(R_WJ_.col(2).cross(a_.X_WJ.q * Vec3::UnitZ())) : Vec3(R_WJ_ * twist_J);
    for (int k = 0; k < (kind == JointKind::kPivot ? 2 : 3); ++k) turn(R_WJ_.col(k), R_WJ_.col(k).dot(miss_W));
  }

  void writeFree(JointKind kind) {
    if (kind == JointKind::kSlider) point(R_WJ_.col(2), 0);
    if (kind == JointKind::kPivot) turn(R_WJ_.col(2), 0);
  }

 private:
  void point(const Vec3& n_W, double e) {
    add({a_.body, b_.body, n_W, a_.arm_W.cross(n_W), b_.arm_W.cross(n_W), Vec3::Zero(), 0, 0, e});
  }
  void turn(const Vec3& m_W, double e) { add({a_.body, b_.body, Vec3::Zero(), m_W, m_W, m_W, 0, 0, e}); }
  void add(const JointRow& row) {
    PINCER_ASSERT(group_.rows.size() < group_.rows.capacity());  // the tick allocates nothing
    group_.rows.push_back(row);
  }

  JointSide a_, b_;
  Mat3 R_WJ_;
  JointGroupScratch& group_;
};

// The row's velocity.
double rate(const JointRow& row, const Motion& a, const Motion& b) {
  return row.n_W.dot(a.v_W - b.v_W) + row.ang_a_W.dot(a.w_W) - row.ang_b_W.dot(b.w_W);
}

// Change of the row's velocity by an impulse on `body`.
double response(const JointRow& row, int body, const Vec3& mlin_W, const Vec3& mang_W) {
  double sum = 0;
  if (row.a == body) sum += row.n_W.dot(mlin_W) + row.ang_a_W.dot(mang_W);
  if (row.b == body) sum -= row.n_W.dot(mlin_W) + row.ang_b_W.dot(mang_W);
  return sum;
}

// A, factorised.
void factorise(const WorldModel& model, const JointMoment& moment, JointGroupScratch& group) {
  const int m = static_cast<int>(group.rows.size());
  PINCER_ASSERT(group.rows.size() * group.rows.size() <= group.A.size());
  for (int j = 0; j < m; ++j) {
    const JointRow& row = group.rows[j];
    for (int i = 0; i < m; ++i) group.A[i + j * m] = 0;
    for (int side = 0; side < 2; ++side) {
      const int body = side == 0 ? row.a : row.b;
      if (body < 0 || !model.bodies[body].dynamic) continue;
      const double sign = side == 0 ? 1 : -1;
      const Vec3 mlin = sign * model.bodies[body].inverse_mass * row.n_W;
      const Vec3 mang = sign * moment.inverseInertia(body) * (side == 0 ? row.ang_a_W : row.ang_b_W);
      for (int i = 0; i < m; ++i) group.A[i + j * m] += response(group.rows[i], body, mlin, mang);
    }
  }
  for (int k = 0; k < m; ++k)
    group.A[k * (m + 1)] = group.A[k * (m + 1)] * (1 + kJointRegularisation) + group.rows[k].softness;
  group.sound = m > 0 && factoriseLu(group.A.data(), m, group.pivots.data());
}

// lambda = -A^-1 rhs, in place.
void solve(JointGroupScratch& group) {
  const int m = static_cast<int>(group.rows.size());
  if (group.sound) solveLu(group.A.data(), m, group.pivots.data(), group.lambda.data());
  for (int k = 0; k < m; ++k) group.lambda[k] = group.sound ? -group.lambda[k] : 0;
}

// Calls use(body, linear impulse, angular impulse) for both ends of every row's impulse.
template <typename Use>
void forEachImpulse(const WorldModel& model, const JointGroupScratch& group, const Use& use) {
  for (std::size_t k = 0; k < group.rows.size(); ++k) {
    const JointRow& row = group.rows[k];
    if (row.a >= 0 && model.bodies[row.a].dynamic)
      use(row.a, Vec3(group.lambda[k] * row.n_W), Vec3(group.lambda[k] * row.ang_a_W));
    if (row.b >= 0 && model.bodies[row.b].dynamic)
      use(row.b, Vec3(-group.lambda[k] * row.n_W), Vec3(-group.lambda[k] * row.ang_b_W));
  }
}

const Motion kRest;

const Motion& startOf(const WorldScratch& scratch, int body) { return body < 0 ? kRest : scratch.bodies[body].start; }
const Motion& freeOf(const WorldScratch& scratch, int body) { return body < 0 ? kRest : scratch.bodies[body].free; }

// h/2 (dG/dt) v: what the row's velocity is by the end of the tick if it is 0 with the directions of the
// middle. A slider's point also slides past b.
double turnOfRow(const JointRow& row, const WorldScratch& scratch, const Vec3& arm_a_W, const Vec3& arm_b_W,
                 bool slides) {
  const Motion &a = startOf(scratch, row.a), &b = startOf(scratch, row.b);
  const Vec3 v_rel = a.v_W + a.w_W.cross(arm_a_W) - b.v_W - b.w_W.cross(arm_b_W);
  Vec3 change = Vec3::Zero();
  if (row.a >= 0) change += a.w_W.cross(a.w_W.cross(arm_a_W));
  if (row.b >= 0) change -= b.w_W.cross(b.w_W.cross(arm_b_W));
  if (slides) change -= b.w_W.cross(v_rel);
  const double directions = b.w_W.cross(row.n_W).dot(v_rel) + b.w_W.cross(row.m_W).dot(a.w_W - b.w_W);
  return 0.5 * scratch.h * (row.n_W.dot(change) + directions);
}

void setDamping(const WorldModel& model, const WorldScratch& scratch, double damping, JointRow& row) {
  const double hd = scratch.h * damping;
  PINCER_ASSERT(hd > 0);
  double mobility = 0;
  for (int side = 0; side < 2; ++side) {
    const int body = side == 0 ? row.a : row.b;
    if (body < 0 || !model.bodies[body].dynamic) continue;
    const Vec3& ang = side == 0 ? row.ang_a_W : row.ang_b_W;
    mobility +=
        model.bodies[body].inverse_mass * row.n_W.squaredNorm() + ang.dot(scratch.bodies[body].inverse_inertia_W * ang);
  }
  const bool soft = hd * mobility < 1;
  row.softness = (soft ? 2 : 1) / hd;
  row.bias = soft ? rate(row, startOf(scratch, row.a), startOf(scratch, row.b)) : 0;
}

void writeGroup(const WorldModel& model, const JointGroup& g, const JointMoment& moment, JointGroupScratch& group) {
  group.rows.clear();
  for (int j = g.first; j < g.first + g.count; ++j)
    RowWriter(model.joints[j], moment, group).writeAll(model.joints[j].kind);
}

void predictGroup(const WorldModel& model, const JointGroup& g, WorldScratch& scratch, JointGroupScratch& group) {
  const MiddleOfTick moment(scratch);
  group.rows.clear();
  for (int j = g.first; j < g.first + g.count; ++j) {
    const JointModel& joint = model.joints[j];
    RowWriter writer(joint, moment, group);
    const std::size_t first = group.rows.size();
    writer.writeAll(joint.kind);
    const bool slides = joint.kind == JointKind::kSlider;
    for (std::size_t k = first; k < group.rows.size(); ++k) {
      group.rows[k].bias = turnOfRow(group.rows[k], scratch, writer.armOfA(), writer.armOfB(), slides);
    }
    if (!(joint.damping > 0) || scratch.h == 0) continue;
    writer.writeFree(joint.kind);
    setDamping(model, scratch, joint.damping, group.rows.back());
  }
  factorise(model, moment, group);
}

}  // namespace

void predictJoints(const WorldModel& model, WorldScratch& scratch) {
  for (std::size_t n = 0; n < model.joint_groups.size(); ++n) {
    if (model.joint_groups[n].is_held_body) continue;
    JointGroupScratch& group = scratch.joint_groups[n];
    predictGroup(model, model.joint_groups[n], scratch, group);
    if (group.may_touch) factoriseInverseMass(model, scratch, model.joint_groups[n], group);
    for (std::size_t k = 0; k < group.rows.size(); ++k) {
      const JointRow& row = group.rows[k];
      group.lambda[k] = rate(row, freeOf(scratch, row.a), freeOf(scratch, row.b)) + row.bias;
    }
    solve(group);
    forEachImpulse(model, group, [&](int body, const Vec3& linear_W, const Vec3& angular_W) {
      BodyScratch& out = scratch.bodies[body];
      out.free.v_W += model.bodies[body].inverse_mass * linear_W;
      out.free.w_W += out.inverse_inertia_W * angular_W;
      out.free_angular_impulse_W += angular_W;
    });
  }
}

void gatherJointImpulses(const WorldModel& model, WorldScratch& scratch) {
  for (std::size_t n = 0; n < model.joint_groups.size(); ++n) {
    JointGroupScratch& group = scratch.joint_groups[n];
    if (model.joint_groups[n].is_held_body) {
      gatherHeldBody(model, model.joint_groups[n], scratch, group);
      continue;
    }
    std::fill(group.lambda.begin(), group.lambda.end(), 0.0);
    group.touched = false;
    for (const int body : model.joint_groups[n].bodies) {
      const BodyScratch& s = scratch.bodies[body];
      if (!s.touched) continue;
      group.touched = true;
      const Vec3 mlin = model.bodies[body].inverse_mass * s.impulse_W, mang = s.inverse_inertia_W * s.angular_impulse_W;
      for (std::size_t k = 0; k < group.rows.size(); ++k) group.lambda[k] += response(group.rows[k], body, mlin, mang);
    }
    solve(group);
    forEachImpulse(model, group, [&](int body, const Vec3& linear_W, const Vec3& angular_W) {
      scratch.bodies[body].impulse_W += linear_W;
      scratch.bodies[body].angular_impulse_W += angular_W;
    });
    for (const int body : model.joint_groups[n].bodies) {
      scratch.bodies[body].angular_impulse_W += scratch.bodies[body].free_angular_impulse_W;
      scratch.bodies[body].touched = true;
    }
  }
}

namespace {

// Newton's method onto the joints; returns the angular momentum that moving the bodies adds.
Vec3 settlePositions(const WorldModel& model, const JointGroup& g, const JointMoment& moment, WorldState& state,
                     WorldScratch& scratch, JointGroupScratch& group) {
  Vec3 added_W = Vec3::Zero();
  for (int pass = 0; pass < kClosingPasses; ++pass) {
    writeGroup(model, g, moment, group);
    factorise(model, moment, group);
    for (std::size_t k = 0; k < group.rows.size(); ++k) group.lambda[k] = group.rows[k].miss;
    solve(group);
    forEachImpulse(model, group, [&](int body, const Vec3& linear_W, const Vec3& angular_W) {
      BodyState& s = state.bodies[body];
      s.X_WI.p += model.bodies[body].inverse_mass * linear_W;
      s.X_WI.q = (quatFromRotationVector(scratch.bodies[body].inverse_inertia_W * angular_W) * s.X_WI.q).normalized();
      added_W += linear_W.cross(s.v_W);
    });
  }
  for (const int body : g.bodies) {
    if (model.bodies[body].dynamic)
      scratch.bodies[body].inverse_inertia_W = inverseInertia(model.bodies[body].rotation, state.bodies[body].X_WI.q);
  }
  return added_W;
}

// Nothing but its own joints pushes on it.
bool isFree(const WorldModel& model, const JointGroup& g, const JointGroupScratch& group) {
  const auto moves = [&](int body) { return body >= 0 && model.bodies[body].dynamic; };
  return !group.touched && std::all_of(model.joints.begin() + g.first, model.joints.begin() + g.first + g.count,
                                       [&](const JointModel& joint) { return moves(joint.a) && moves(joint.b); });
}

// Turns the whole group, as if it were rigid, by what gives it this angular momentum.
void turnGroup(const WorldModel& model, const JointGroup& g, const Vec3& added_W, WorldState& state) {
  double mass = 0;
  Vec3 sum_W = Vec3::Zero();
  for (const int body : g.bodies) {
    mass += model.bodies[body].mass;
    sum_W += model.bodies[body].mass * state.bodies[body].X_WI.p;
  }
  const Vec3 centre_W = sum_W / mass;
  Mat3 inertia_W = Mat3::Zero();
  for (const int body : g.bodies) {
    const Vec3 arm_W = state.bodies[body].X_WI.p - centre_W;
    const Mat3 R_WI = state.bodies[body].X_WI.q.toRotationMatrix();
    inertia_W += R_WI * model.bodies[body].moments.asDiagonal() * R_WI.transpose() +
                 model.bodies[body].mass * (arm_W.squaredNorm() * Mat3::Identity() - arm_W * arm_W.transpose());
  }
  const Vec3 w_W = inertia_W.inverse() * added_W;
  for (const int body : g.bodies) {
    BodyState& s = state.bodies[body];
    const Vec3 own_I = s.X_WI.q.conjugate() * w_W;
    s.v_W += w_W.cross(s.X_WI.p - centre_W);
    s.L_W += s.X_WI.q * model.bodies[body].moments.cwiseProduct(own_I);
  }
}

}  // namespace

void settleJoints(const WorldModel& model, WorldState& state, WorldScratch& scratch) {
  const EndOfTick moment(state, scratch);
  const auto motion = [&](int body) {
    if (body < 0) return Motion{};
    return Motion{state.bodies[body].v_W, bodyAngularVelocity(model, state, body)};
  };
  for (std::size_t n = 0; n < model.joint_groups.size(); ++n) {
    const JointGroup& g = model.joint_groups[n];
    if (g.is_held_body) continue;
    JointGroupScratch& group = scratch.joint_groups[n];
    const Vec3 added_W = settlePositions(model, g, moment, state, scratch, group);
    if (isFree(model, g, group)) turnGroup(model, g, -added_W, state);
    writeGroup(model, g, moment, group);
    factorise(model, moment, group);
    for (std::size_t k = 0; k < group.rows.size(); ++k) {
      group.lambda[k] = rate(group.rows[k], motion(group.rows[k].a), motion(group.rows[k].b));
    }
    solve(group);
    forEachImpulse(model, group, [&](int body, const Vec3& linear_W, const Vec3& angular_W) {
      state.bodies[body].v_W += model.bodies[body].inverse_mass * linear_W;
      state.bodies[body].L_W += angular_W;
    });
  }
}

Vec2 jointGap(const WorldState& state, const JointModel& joint) {
  const Pose a = state.bodies[joint.a].X_WI * joint.X_AJ;
  const Pose b = joint.b < 0 ? joint.X_BJ : state.bodies[joint.b].X_WI * joint.X_BJ;
  Vec3 apart = b.q.conjugate() * (a.p - b.p);
  if (joint.kind == JointKind::kSlider) apart.z() = 0;
  const double tilt = (b.q * Vec3::UnitZ()).cross(a.q * Vec3::UnitZ()).norm();
  const double turn = 2 * (b.q.conjugate() * a.q).vec().norm();
  const double miss = joint.kind == JointKind::kBall ? 0 : joint.kind == JointKind::kPivot ? tilt : turn;
  return {apart.norm(), miss};
}

}  // namespace pincer::engine
