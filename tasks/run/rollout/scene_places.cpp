// Bodies and joints placed anew by a caller.
#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "pincer/contact/elementary.h"
#include "pincer/contact/error.h"
#include "pincer/tasks/run/rollout/scene_state.h"

namespace pincer::tasks {
namespace {

void forgetContacts(SceneState& state) {
  state.grasp.world.contact_count = 0;
  std::fill(state.grasp.followed.colliders.begin(), state.grasp.followed.colliders.end(), -1);
}

// Links lie where their coordinates put them, and these count from the base.
void requireFree(const SceneModel& model, std::size_t body) {
  const engine::WorldModel& world = model.grasp.world;
  const std::string& name = model.scene.bodies[body].name;
  if (world.bodies[body].tree >= 0)
    throw InputError(
        fmt::format("body \"{}\" hangs on a tree of joints, which place it. Set its joints instead.", name));
  const auto stands_on_it = [&](const engine::TreeModel& tree) { return tree.base == static_cast<int>(body); };
  if (std::any_of(world.trees.begin(), world.trees.end(), stands_on_it))
    throw InputError(fmt::format(
        "body \"{}\" carries a tree of joints and can't be placed anew. Place it in the scene, or give it a motion.",
        name));
}

int jointOfScene(const SceneModel& model, int joint) { return model.joints[static_cast<std::size_t>(joint)]; }

// Name of the joint that `own` follows.
std::string_view leaderOf(const engine::WorldModel& world, const engine::TreeModel& tree,
                          const engine::TreeCoordinate& own) {
  return world.joints[static_cast<std::size_t>(tree.coordinates[static_cast<std::size_t>(own.leader)].joint)].name;
}

void requireRange(const engine::JointModel& joint, double position, double velocity) {
  if (!std::isfinite(position) || !std::isfinite(velocity))
    throw InputError(
        fmt::format("joint \"{}\": position {} with velocity {} isn't finite.", joint.name, position, velocity));
  // A stop that is pushed gives by a round-off, so that a joint's own place can always be given back to it.
  constexpr double kGive = 1e-6;
  if (position < joint.traits.lower - kGive || position > joint.traits.upper + kGive) {
    throw InputError(fmt::format("joint \"{}\": position = {} is out of range [{}, {}], its stops.", joint.name,
                                 position, joint.traits.lower, joint.traits.upper));
  }
}

// The one body that `joint` alone holds to what never moves.
void placeHeldBody(const engine::WorldModel& world, engine::WorldState& state, const engine::JointModel& joint,
                   double position, double velocity) {
  const bool turns = joint.kind == engine::JointKind::kPivot;
  const Pose X_WJ = joint.b < 0 ? joint.X_BJ : state.bodies[static_cast<std::size_t>(joint.b)].X_WI * joint.X_BJ;
  const Quat turn(math::cos(position / 2), 0, 0, math::sin(position / 2));
  const Pose X_JK = turns ? Pose{turn, Vec3::Zero()} : Pose{Quat::Identity(), Vec3(0, 0, position)};
  const Vec3 axis_W = X_WJ.q * Vec3::UnitZ();
  engine::BodyState& body = state.bodies[static_cast<std::size_t>(joint.a)];
  body.X_WI = X_WJ * X_JK * joint.X_AJ.inverse();
  const Vec3 w_W = turns ? Vec3(velocity * axis_W) : Vec3(Vec3::Zero());
  body.v_W = turns ? Vec3(w_W.cross(body.X_WI.p - X_WJ.p)) : Vec3(velocity * axis_W);
  const Vec3& moments = world.bodies[static_cast<std::size_t>(joint.a)].moments;
  body.L_W = body.X_WI.q * moments.cwiseProduct(body.X_WI.q.conjugate() * w_W);
}

}  // namespace

void placeBody(const SceneModel& model, SceneState& state, int body, const engine::BodyStart& start) {
  const auto index = static_cast<std::size_t>(body);
  std::vector<engine::BodyStart> starts = model.scene.starts;
  starts[index] = start;
  requireFree(model, index);
  const double length = start.X_WB.q.norm();
  if (!(length > 0) || !std::isfinite(length)) {
    throw InputError(fmt::format(
        "body \"{}\": quaternion w, x, y, z = {}, {}, {}, {} is no rotation. It has to be finite and not zero.",
        model.scene.bodies[index].name, start.X_WB.q.w(), start.X_WB.q.x(), start.X_WB.q.y(), start.X_WB.q.z()));
  }
  starts[index].X_WB.q.coeffs() /= length;
  std::vector<Vec3> points;
  for (const engine::PointState& point : state.grasp.world.points) points.push_back(point.p_target_W);
  state.grasp.world.bodies[index] = engine::makeState(model.grasp.world, starts, points).bodies[index];
  forgetContacts(state);
}

double jointPosition(const SceneModel& model, const SceneState& state, int joint) {
  return engine::jointPosition(model.grasp.world, state.grasp.world, jointOfScene(model, joint));
}

double jointVelocity(const SceneModel& model, const SceneState& state, int joint) {
  return engine::jointVelocity(model.grasp.world, state.grasp.world, jointOfScene(model, joint));
}

void placeJoint(const SceneModel& model, SceneState& state, int joint, double position, double velocity) {
  const engine::WorldModel& world = model.grasp.world;
  const int number = jointOfScene(model, joint);
  const engine::JointPlace& at = world.joint_places[static_cast<std::size_t>(number)];
  const engine::JointModel& own = world.joints[static_cast<std::size_t>(at.joint)];
  requireRange(own, position, velocity);
  if (at.tree >= 0) {
    const engine::TreeModel& tree = world.trees[static_cast<std::size_t>(at.tree)];
    const engine::TreeCoordinate& coordinate = tree.coordinates[static_cast<std::size_t>(at.coordinate)];
    if (coordinate.leader >= 0) {
      throw InputError(fmt::format("joint \"{}\" follows joint \"{}\" by a coupling. Set that one.", own.name,
                                   leaderOf(world, tree, coordinate)));
    }
    engine::setJoint(world, state.grasp.world, number, position, velocity);
  } else {
    const int group = world.bodies[static_cast<std::size_t>(own.a)].joint_group;
    if (!world.joint_groups[static_cast<std::size_t>(group)].is_held_body)
      throw InputError(fmt::format(
          "joint \"{}\" is one of a loop of bodies, which no single joint places. Place its bodies instead.",
          own.name));
    placeHeldBody(world, state.grasp.world, own, position, velocity);
  }
  forgetContacts(state);
}

}  // namespace pincer::tasks
