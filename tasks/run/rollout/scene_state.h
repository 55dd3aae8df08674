// scene_state: a scene as model and state apart, for who drives it by hand: one model, many states, each a plain value.
//
//   SceneModel model(readScene("pinch.json"));
//   SceneState state(model);
//   SceneStepper stepper(model);
//   stepper.step(state, SceneInputs(model), 10);      same bits as ten ticks of Simulation
//
// Simulation (tasks/run/simulation.h) is the same with one state, moved by nobody but its file.
#pragma once
#include <array>
#include <cstdint>
#include <functional>
#include <optional>
#include <string>
#include <vector>

#include "pincer/grasp/baseline.h"
#include "pincer/grasp/step.h"
#include "pincer/tasks/run/scene.h"

namespace pincer::tasks {

// Built once, then constant; any number of threads may step states of it.
struct SceneModel {
  explicit SceneModel(Scene scene);  // builds the world; throws InputError

  Scene scene;
  grasp::GraspModel grasp;
  std::vector<int> driven;  // bodies that follow motions, in the order of SceneInputs::motion_place
  std::vector<int> joints;  // pivots and sliders, which have one coordinate each, as places in scene.joints

  // Index by name; throws InputError with a did-you-mean.
  int bodyNamed(const std::string& name) const;
  int fingerNamed(const std::string& name) const;
  int jointNamed(const std::string& name) const;  // place in `joints`
};

// All that evolves.
struct SceneState {
  explicit SceneState(const SceneModel& model);

  grasp::GraspState grasp;
  std::optional<grasp::BaselineFingers> baselines;  // where some finger is rendered as published
  std::vector<Vec3> held;  // where a finger's device is to stay [m]; NaN: it follows the scene's trajectory

  double time() const { return grasp.world.time; }
};

// As of its world (quantity.h).
std::string hashText(const SceneState& state);

// Places body `body` anew: pose X_WB, velocity of its centre of mass [m/s], angular velocity [rad/s]. What its contacts
// remembered is forgotten. The quaternion is normalised. Throws InputError when a value isn't finite, the quaternion is
// zero, the body can't have a velocity, or a tree of joints places it (placeJoint) or stands on it.
void placeBody(const SceneModel& model, SceneState& state, int body, const engine::BodyStart& start);

// Coordinate of `joint`, a place in SceneModel::joints, and its rate [rad, rad/s] of a pivot, [m, m/s] of a slider.
double jointPosition(const SceneModel& model, const SceneState& state, int joint);
double jointVelocity(const SceneModel& model, const SceneState& state, int joint);

// Sets both; what the joint carries goes along, and what follows it by a coupling. All contacts forget what they
// remembered. Throws InputError, and changes nothing, when a number isn't finite, the position is beyond the joint's
// stops, the joint follows another one, or is one of a loop of bodies.
void placeJoint(const SceneModel& model, SceneState& state, int joint, double position, double velocity);

// Inputs that a caller may give in place of the scene's trajectories. NaN: not said.
struct SceneInputs {
  explicit SceneInputs(const SceneModel& model);  // nothing is said

  // of each device at the end of the step [m]; NaN: SceneState::held, else the trajectory
  std::vector<Vec3> finger_place;
  std::vector<Vec3> finger_velocity;          // at its end [m/s]; NaN: of the way from where the device was
  std::vector<Eigen::Vector4d> finger_turn;   // orientation of F: quaternion w, x, y, z; NaN: the trajectory's
  std::vector<Vec3> finger_force;             // on each proxy, besides the scene's [N]
  std::vector<engine::BodyForce> body_force;  // one per body
  // of driven bodies: x, y, z, qw, qx, qy, qz; NaN: the scene's trajectory
  std::vector<std::array<double, 7>> motion_place;
  std::vector<std::array<double, 6>> motion_rate;  // of their origins [m/s], and angular [rad/s]
  std::vector<double> drive_target;  // what each drive is told, all through the step; NaN: what the scene tells it
  Vec3 gravity;                      // [m/s^2]; NaN: the scene's
};

// Sum of several ticks.
struct StepsReport {
  std::uint32_t status = engine::kStepOk;  // of all of them together
  std::int64_t ticks = 0;                  // done; fewer than asked for where the state broke, or somebody stopped it
  int contacts = 0, parts = 1;             // of the last tick
  bool asleep = false;                     // likewise
};

// Steps states of one model; one thread at a time.
class SceneStepper {
 public:
  explicit SceneStepper(const SceneModel& model);

  // `ticks` >= 1 ticks. A device that is told its place goes there evenly over them. Ends early after a tick whose
  // state isn't finite, or when `stop`, asked every thousand ticks, says so. Allocates nothing. Throws InputError,
  // before it begins, for forces on bodies or another gravity where fingers are rendered as published: those take none.
  StepsReport step(SceneState& state, const SceneInputs& inputs, std::int64_t ticks,
                   const std::function<bool()>& stop = {});
  // The scene's trajectories, but for devices that are held.
  StepsReport step(SceneState& state, std::int64_t ticks, const std::function<bool()>& stop = {});

  // Of the last tick.
  std::span<const grasp::FingerReport> fingers() const { return grasp::fingersOf(*scratch_); }
  const engine::WorldScratch& world() const { return grasp::worldOf(*scratch_); }
  const grasp::GraspScratch& scratch() const { return *scratch_; }

 private:
  StepsReport run(SceneState& state, const SceneInputs* inputs, std::int64_t ticks, const std::function<bool()>& stop);
  void tellFingers(const SceneState& state, const SceneInputs* inputs, std::int64_t left);
  void tellBodies(const SceneState& state, const SceneInputs* inputs);
  void tellDrives(const SceneState& state, const SceneInputs* inputs);

  const SceneModel& model_;
  grasp::ScratchHandle scratch_;
  std::vector<grasp::FingerInput> fingers_;
  std::vector<engine::MotionInput> motions_;
  std::vector<engine::DriveInput> controls_;
};

}  // namespace pincer::tasks
