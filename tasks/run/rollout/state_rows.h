// state_rows: the state of all bodies as rows of numbers, as arrays have them.
#pragma once
#include <span>

#include "pincer/tasks/run/rollout/scene_state.h"

namespace pincer::tasks {

// x, y, z [m], qw, qx, qy, qz of X_WB per body.
void writePlaces(const SceneModel& model, const SceneState& state, std::span<double> out);
// v_W of the centre of mass [m/s] and w_W [rad/s] per body.
void writeRates(const SceneModel& model, const SceneState& state, std::span<double> out);
// Coordinates of the pivots and sliders [rad, m], and their rates [rad/s, m/s].
void writeJoints(const SceneModel& model, const SceneState& state, std::span<double> positions,
                 std::span<double> velocities);
// Time, places, rates, joints (rollout.h).
void writeStateRow(const SceneModel& model, const SceneState& state, std::span<double> out);

}  // namespace pincer::tasks
