#include "pincer/tasks/run/rollout/state_rows.h"

namespace pincer::tasks {

void writePlaces(const SceneModel& model, const SceneState& state, std::span<double> out) {
  double* at = out.data();
  for (std::size_t i = 0; i < model.scene.bodies.size(); ++i, at += 7) {
    const Pose X_WB = engine::bodyPose(model.grasp.world, state.grasp.world, static_cast<int>(i));
    Eigen::Map<Vec3>{at} = X_WB.p;
    Eigen::Map<Eigen::Vector4d>{at + 3} << X_WB.q.w(), X_WB.q.x(), X_WB.q.y(), X_WB.q.z();
  }
}

void writeRates(const SceneModel& model, const SceneState& state, std::span<double> out) {
  double* at = out.data();
  for (std::size_t i = 0; i < model.scene.bodies.size(); ++i, at += 6) {
    Eigen::Map<Vec3>{at} = state.grasp.world.bodies[i].v_W;
    Eigen::Map<Vec3>{at + 3} = engine::bodyAngularVelocity(model.grasp.world, state.grasp.world, static_cast<int>(i));
  }
}

void writeJoints(const SceneModel& model, const SceneState& state, std::span<double> positions,
                 std::span<double> velocities) {
  for (std::size_t i = 0; i < model.joints.size(); ++i) {
    positions[i] = jointPosition(model, state, static_cast<int>(i));
    velocities[i] = jointVelocity(model, state, static_cast<int>(i));
  }
}

void writeStateRow(const SceneModel& model, const SceneState& state, std::span<double> out) {
  const std::size_t bodies = model.scene.bodies.size(), joints = model.joints.size();
  out[0] = state.time();
  writePlaces(model, state, out.subspan(1, 7 * bodies));
  writeRates(model, state, out.subspan(1 + 7 * bodies, 6 * bodies));
  writeJoints(model, state, out.subspan(1 + 13 * bodies, joints), out.subspan(1 + 13 * bodies + joints));
}

}  // namespace pincer::tasks
