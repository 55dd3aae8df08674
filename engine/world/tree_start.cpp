// Places of trees at the start, and those that a caller gives them.
#include <fmt/format.h>

#include <cmath>
#include <numbers>

#include "pincer/contact/elementary.h"
#include "pincer/contact/functions/invariants.h"
#include "pincer/engine/tree/loop_closure.h"
#include "pincer/engine/tree/tree_inertia.h"
#include "pincer/engine/world/joints.h"
#include "pincer/engine/world/tree_motion.h"

namespace pincer::engine {
namespace {

TreeBase baseOfTree(const WorldModel& model, const WorldState& state, const TreeModel& tree) {
  if (tree.base < 0) return {};
  TreeBase base{state.bodies[tree.base].X_WI, {}};
  if (const BodyModel& body = model.bodies[tree.base]; body.driven)
    base.motion = {state.bodies[tree.base].v_W, state.driven_w_W[body.motion]};
  return base;
}

// The angle of q about z that is nearest to `about`.
double turnNear(const Quat& q, double about) {
  const double turn = 2 * math::atan2(q.z(), q.w()), full = 2 * std::numbers::pi;
  return turn + full * std::round((about - turn) / full);
}

constexpr int kFromStart = 5;        // passes, from kLargestJointGap
constexpr int kFromAnywhere = 50;    // from where one of the loop's joints was put
constexpr double kIsClosed = 1e-12;  // [m, rad]

// Closes the loops, where they can be: the other joints move, by their inertia, but
// hardly the one that `kept` is the column of.
double closeTree(const TreeModel& tree, const TreeBase& base, int passes, int kept, std::span<double> q,
                 std::span<double> u) {
  constexpr double kHeavy = 1e12;  // times its inertia: it hardly moves
  TreePlace place(tree);
  placeLinks(tree, base, q, place);
  std::vector<CompositeInertia> composite(tree.links.size());
  TreeFactor factor(tree);
  fillInertia(tree, place, composite, factor.entries);
  if (kept >= 0) factor.entries[entryOf(tree, kept, kept)] *= kHeavy;
  factorise(tree, factor);
  LoopRows rows(tree);
  return closeLoops(tree, base, factor, passes, rows, factor.loops, q, u, place);
}

// Reads one tree's coordinates and rates off the bodies that it moves.
class TreeReader {
 public:
  TreeReader(const WorldModel& model, const TreeModel& tree, WorldState& state)
      : model_(model), tree_(tree), state_(state), v_(tree.coordinates.size()) {}

  void read() {
    for (const TreeLink& link : tree_.links) readLink(link);
    const std::span<double> q = treeCoordinates(tree_, state_);
    const std::span<double> u = treeRates(tree_, state_);
    std::vector<double> follows(q.size());
    const std::vector<double> none(u.size(), 0.0);
    growCoordinates(tree_, q, none, follows);
    for (std::size_t i = 0; i < tree_.coordinates.size(); ++i) checkFollows(tree_.coordinates[i], q, follows);
    std::copy(follows.begin(), follows.end(), q.begin());
    ratesOfColumns(tree_, v_, u);
    if (!tree_.loops.empty()) closeTree(tree_, baseOfTree(model_, state_, tree_), kFromStart, -1, q, u);
  }

 private:
  struct Frame {
    Pose X_W;
    Motion motion;  // of the frame's origin
  };
  Frame parentOf(const TreeLink& link) const {
    if (link.parent >= 0) return frameOf(tree_.links[link.parent].body);
    const TreeBase base = baseOfTree(model_, state_, tree_);
    return {base.X_WB, base.motion};
  }
  Frame frameOf(int body) const {
    return {state_.bodies[body].X_WI, {state_.bodies[body].v_W, bodyAngularVelocity(model_, state_, body)}};
  }

  void readLink(const TreeLink& link) {
    const Frame parent = parentOf(link), own = frameOf(link.body);
    const Pose X_WJ = parent.X_W * link.X_PJ, X_WK = own.X_W * link.X_LJ;  // on the parent, on the link
    const Quat q_JK = X_WJ.q.conjugate() * X_WK.q;
    const Vec3 w_J = X_WJ.q.conjugate() * (own.motion.w_W - parent.motion.w_W);
    const double sign = link.reversed ? -1 : 1;
    double* const q = state_.tree_q.data() + tree_.first_q + link.first_q;
    double* const v = v_.data() + link.first_v;
    if (link.kind == JointKind::kPivot) {
      q[0] = turnNear(link.reversed ? q_JK.conjugate() : q_JK, tree_.coordinates[link.first_v].traits.start);
      v[0] = sign * w_J.z();
    } else if (link.kind == JointKind::kSlider) {
      q[0] = sign * (X_WJ.q.conjugate() * (X_WK.p - X_WJ.p)).z();
      const Vec3 v_K = own.motion.v_W + own.motion.w_W.cross(X_WK.p - own.X_W.p),
                 v_J = parent.motion.v_W + parent.motion.w_W.cross(X_WK.p - parent.X_W.p);
      v[0] = sign * (X_WJ.q.conjugate() * (v_K - v_J)).z();
    } else if (link.kind == JointKind::kBall) {
      const Quat unit = q_JK.normalized();
      q[0] = unit.w();
      for (int k = 0; k < 3; ++k) {
        q[1 + k] = unit.vec()[k];
        v[k] = w_J[k];
      }
    }
  }

  void checkFollows(const TreeCoordinate& own, std::span<const double> q, std::span<const double> follows) const {
    if (own.q < 0 || std::abs(q[own.q] - follows[own.q]) <= kLargestJointGap) return;
    throw InputError(
        fmt::format("the joint of body \"{}\": it starts at {:g}, and where the joint that it follows starts it must "
                    "be at {:g}. Start both where "
                    "the coupling holds them.",
                    model_.bodies[tree_.links[own.link].body].name, q[own.q], follows[own.q]));
  }

  const WorldModel& model_;
  const TreeModel& tree_;
  WorldState& state_;
  std::vector<double> v_;  // by coordinates
};

// dq/dz of a coordinate that follows another one; 1 of all others.
double shareOf(const TreeModel& tree, const TreeCoordinate& own, std::span<const double> q) {
  if (own.leader < 0) return 1;
  const double z = q[tree.coordinates[own.leader].q];
  double slope = 0;
  for (std::size_t k = own.polynomial.size() - 1; k > 0; --k)
    slope = slope * z + static_cast<double>(k) * own.polynomial[k];
  return slope;
}

void placeLinksOf(const WorldModel& model, const TreeModel& tree, WorldState& state) {
  const TreeBase base = baseOfTree(model, state, tree);
  const std::span<const double> q = treeCoordinates(tree, state);
  const std::span<const double> u = treeRates(tree, state);
  TreePlace place(tree);
  placeLinks(tree, base, q, place);
  moveLinks(tree, base, q, u, place);
  for (std::size_t l = 0; l < tree.links.size(); ++l) {
    const BodyModel& body = model.bodies[tree.links[l].body];
    const Motion& motion = place.links[l].motion;
    const Pose X_WI = linkPose(place, static_cast<int>(l));
    state.bodies[tree.links[l].body] = {X_WI, motion.v_W,
                                        X_WI.q * body.moments.cwiseProduct(X_WI.q.conjugate() * motion.w_W)};
  }
}

const JointPlace& placeOfJoint(const WorldModel& model, int joint) {
  PINCER_DEMAND(isIndex(joint, model.joint_places.size()),
                "jointPosition, setJoint: the joint is one that addJoint returned");
  const JointPlace& place = model.joint_places[joint];
  const JointKind kind = model.joints[place.joint].kind;
  PINCER_DEMAND(kind == JointKind::kPivot || kind == JointKind::kSlider,
                "jointPosition, setJoint: the joint is a pivot or a slider");
  return place;
}

// The coordinate of a joint that no tree has, and its rate, read off its two bodies.
struct ReadOff {
  double position, velocity;
};
ReadOff readOff(const WorldModel& model, const WorldState& state, const JointModel& joint) {
  const bool is_held_to_world = joint.b < 0;
  const Pose X_WK = state.bodies[joint.a].X_WI * joint.X_AJ,
             X_WJ = is_held_to_world ? joint.X_BJ : state.bodies[joint.b].X_WI * joint.X_BJ;
  const Vec3 axis_W = X_WJ.q * Vec3::UnitZ(), w_a = bodyAngularVelocity(model, state, joint.a);
  const Vec3 w_b = is_held_to_world ? Vec3(Vec3::Zero()) : bodyAngularVelocity(model, state, joint.b);
  if (joint.kind == JointKind::kPivot)
    return {turnNear(X_WJ.q.conjugate() * X_WK.q, joint.traits.start), axis_W.dot(w_a - w_b)};
  Vec3 v_W = state.bodies[joint.a].v_W + w_a.cross(X_WK.p - state.bodies[joint.a].X_WI.p);
  if (!is_held_to_world) v_W -= state.bodies[joint.b].v_W + w_b.cross(X_WK.p - state.bodies[joint.b].X_WI.p);
  return {axis_W.dot(X_WK.p - X_WJ.p), axis_W.dot(v_W)};
}

}  // namespace

void readTrees(const WorldModel& model, WorldState& state) {
  state.tree_q.resize(static_cast<std::size_t>(model.tree_q_count));
  state.tree_v.resize(static_cast<std::size_t>(model.tree_v_count));
  state.brakes.resize(static_cast<std::size_t>(model.tree_coordinate_count));
  state.controls.resize(model.drives.size());
  state.drives.resize(model.drives.size());
  for (const TreeModel& tree : model.trees) {
    TreeReader(model, tree, state).read();
    placeLinksOf(model, tree, state);
  }
}

double armatureEnergy(const WorldModel& model, const WorldState& state) {
  double energy = 0;
  for (const TreeModel& tree : model.trees) {
    for (const TreeCoordinate& own : tree.coordinates) {
      if (!(own.traits.armature > 0)) continue;
      const double u = state.tree_v[tree.first_v + own.column];
      const double rate = shareOf(tree, own, treeCoordinates(tree, state)) * u;
      energy += 0.5 * own.traits.armature * rate * rate;
    }
  }
  return energy;
}

double springEnergy(const WorldModel& model, const WorldState& state) {
  double energy = 0;
  for (const TreeModel& tree : model.trees) {
    for (const TreeCoordinate& own : tree.coordinates) {
      if (own.q < 0 || !(own.traits.stiffness > 0)) continue;
      const double stretch = state.tree_q[tree.first_q + own.q] - own.traits.rest;
      energy += 0.5 * own.traits.stiffness * stretch * stretch;
    }
  }
  return energy;
}

double jointPosition(const WorldModel& model, const WorldState& state, int joint) {
  const JointPlace& place = placeOfJoint(model, joint);
  if (place.tree < 0) return readOff(model, state, model.joints[place.joint]).position;
  const TreeModel& tree = model.trees[place.tree];
  return state.tree_q[tree.first_q + tree.coordinates[place.coordinate].q];
}

double jointVelocity(const WorldModel& model, const WorldState& state, int joint) {
  const JointPlace& at_joint = placeOfJoint(model, joint);
  if (at_joint.tree < 0) return readOff(model, state, model.joints[at_joint.joint]).velocity;
  const TreeModel& tree = model.trees[at_joint.tree];
  const TreeCoordinate& own = tree.coordinates[at_joint.coordinate];
  return shareOf(tree, own, treeCoordinates(tree, state)) * state.tree_v[tree.first_v + own.column];
}

void setJoint(const WorldModel& model, WorldState& state, int joint, double position, double velocity) {
  const JointPlace& at_joint = placeOfJoint(model, joint);
  PINCER_DEMAND(at_joint.tree >= 0, "setJoint: a tree has the joint (tree.h)");
  const TreeModel& tree = model.trees[at_joint.tree];
  const TreeCoordinate& own = tree.coordinates[at_joint.coordinate];
  PINCER_DEMAND(own.leader < 0, "setJoint: the joint follows another one; set that one");
  const std::span<double> q = treeCoordinates(tree, state);
  q[own.q] = position;
  state.tree_v[tree.first_v + own.column] = velocity;
  const std::vector<double> none(static_cast<std::size_t>(tree.columnCount()), 0.0);
  growCoordinates(tree, q, none, q);
  if (!tree.loops.empty() &&
      closeTree(tree, baseOfTree(model, state, tree), kFromAnywhere, own.column, q, treeRates(tree, state)) > kIsClosed)
    throw InputError(fmt::format(
        "setJoint: with the joint of body \"{}\" at {:g} its loop can't be closed. Put it nearer to where it was.",
        model.bodies[tree.links[own.link].body].name, position));
  placeLinksOf(model, tree, state);
}

}  // namespace pincer::engine
