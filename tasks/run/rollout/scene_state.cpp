#include "pincer/tasks/run/rollout/scene_state.h"

#include <fmt/format.h>

#include <algorithm>

#include "pincer/contact/error.h"
#include "pincer/tasks/run/files/spelling.h"

namespace pincer::tasks {
namespace {

constexpr double kNotSaid = std::numeric_limits<double>::quiet_NaN();  // NaN in a row: left as the scene has it

// The first number decides: a place of which only a part is said has numbers that aren't finite, which the tick flags.
template <class Row>
bool isSaid(const Row& row) {
  return !std::isnan(row[0]);
}

template <class Named>
int indexOf(const std::vector<Named>& items, const std::string& name, std::string_view what,
            std::string_view (*nameOf)(const Named&)) {
  std::vector<std::string_view> names;
  for (const Named& item : items) names.push_back(nameOf(item));
  const auto found = std::find(names.begin(), names.end(), name);
  if (found == names.end())
    throw InputError(fmt::format("{} \"{}\" isn't in this scene.{}", what, name, suggestion(name, names)));
  return static_cast<int>(found - names.begin());
}

std::vector<int> drivenBodies(const engine::WorldModel& world) {
  std::vector<int> driven;
  for (std::size_t i = 0; i < world.bodies.size(); ++i) {
    if (world.bodies[i].driven) driven.push_back(static_cast<int>(i));
  }
  return driven;
}

std::vector<int> jointsWithCoordinate(const std::vector<engine::JointModel>& all) {
  std::vector<int> joints;
  for (std::size_t i = 0; i < all.size(); ++i) {
    if (all[i].kind == engine::JointKind::kPivot || all[i].kind == engine::JointKind::kSlider)
      joints.push_back(static_cast<int>(i));
  }
  return joints;
}

std::optional<grasp::BaselineFingers> baselinesOf(const Scene& scene) {
  const std::vector<grasp::FingerMethod> methods = methodsOf(scene);
  const bool are_ours = std::all_of(methods.begin(), methods.end(),
                                    [](grasp::FingerMethod m) { return m == grasp::FingerMethod::kProxy; });
  return are_ours ? std::nullopt : std::optional(grasp::BaselineFingers(methods));
}

Pose poseOf(const std::array<double, 7>& row) {
  return {Quat(row[3], row[4], row[5], row[6]).normalized(), Vec3(row[0], row[1], row[2])};
}

bool pushes(const SceneInputs& inputs) {
  const auto pushed = [](const engine::BodyForce& f) { return !f.f_W.isZero(0) || !f.tau_W.isZero(0); };
  return std::any_of(inputs.body_force.begin(), inputs.body_force.end(), pushed);
}

}  // namespace

SceneModel::SceneModel(Scene read)
    : scene(std::move(read)),
      grasp(buildWorld(scene)),
      driven(drivenBodies(grasp.world)),
      joints(jointsWithCoordinate(scene.joints)) {}

int SceneModel::bodyNamed(const std::string& name) const {
  return indexOf<engine::BodySpec>(scene.bodies, name, "body",
                                   [](const engine::BodySpec& b) { return std::string_view(b.name); });
}

int SceneModel::fingerNamed(const std::string& name) const {
  return indexOf<SceneFinger>(scene.fingers, name, "finger",
                              [](const SceneFinger& f) { return std::string_view(f.model.name); });
}

int SceneModel::jointNamed(const std::string& name) const {
  std::vector<engine::JointModel> named;
  for (const int joint : joints) named.push_back(scene.joints[static_cast<std::size_t>(joint)]);
  return indexOf<engine::JointModel>(named, name, "pivot or slider",
                                     [](const engine::JointModel& j) { return std::string_view(j.name); });
}

SceneState::SceneState(const SceneModel& model)
    : grasp(startState(model.scene, model.grasp)),
      baselines(baselinesOf(model.scene)),
      held(model.scene.fingers.size(), Vec3::Constant(kNotSaid)) {}

std::string hashText(const SceneState& state) { return hashText(state.grasp.world); }

SceneInputs::SceneInputs(const SceneModel& model)
    : finger_place(model.scene.fingers.size(), Vec3::Constant(kNotSaid)),
      finger_velocity(finger_place),
      finger_turn(model.scene.fingers.size(), Eigen::Vector4d::Constant(kNotSaid)),
      finger_force(model.scene.fingers.size(), Vec3::Zero()),
      body_force(model.scene.bodies.size()),
      motion_place(model.driven.size()),
      motion_rate(model.driven.size()),
      drive_target(model.scene.drives.size(), kNotSaid),
      gravity(Vec3::Constant(kNotSaid)) {
  for (auto& row : motion_place) row.fill(kNotSaid);
  for (auto& row : motion_rate) row.fill(0);
}

SceneStepper::SceneStepper(const SceneModel& model)
    : model_(model),
      scratch_(grasp::makeScratch(model.grasp)),
      fingers_(model.scene.fingers.size()),
      motions_(model.driven.size()),
      controls_(model.scene.drives.size()) {}

StepsReport SceneStepper::step(SceneState& state, const SceneInputs& inputs, std::int64_t ticks,
                               const std::function<bool()>& stop) {
  if (state.baselines && (pushes(inputs) || isSaid(inputs.gravity))) {
    throw InputError(
        fmt::format("{}: a finger of this scene is rendered as published (\"method\"), which knows no forces on bodies "
                    "and no other "
                    "gravity. Leave them out, or take the method \"proxy\".",
                    model_.scene.file));
  }
  return run(state, &inputs, ticks, stop);
}

StepsReport SceneStepper::step(SceneState& state, std::int64_t ticks, const std::function<bool()>& stop) {
  return run(state, nullptr, ticks, stop);
}

StepsReport SceneStepper::run(SceneState& state, const SceneInputs* inputs, std::int64_t ticks,
                              const std::function<bool()>& stop) {
  constexpr std::int64_t kAsk = 1000;  // about a millisecond of a pinch
  engine::AppliedForces applied;
  if (inputs && pushes(*inputs)) applied.forces = inputs->body_force;
  if (inputs && isSaid(inputs->gravity)) applied.gravity_W = inputs->gravity;
  StepsReport all;
  while (all.ticks < ticks && (all.status & engine::kStateNotFinite) == 0) {
    if (stop && all.ticks % kAsk == kAsk - 1 && stop()) break;
    tellFingers(state, inputs, ticks - all.ticks);
    tellBodies(state, inputs);
    tellDrives(state, inputs);
    const engine::StepReport one =
        state.baselines ? state.baselines->step(model_.grasp, state.grasp, *scratch_, fingers_, motions_, controls_)
                        : grasp::step(model_.grasp, state.grasp, *scratch_, fingers_, motions_, applied, controls_);
    ++all.ticks;
    all.status |= one.status;
    all.contacts = one.contacts;
    all.parts = one.parts;
    all.asleep = one.asleep;
  }
  return all;
}

// Devices at the end of the coming tick. One that is told its place has `left` ticks to go there, this one included.
void SceneStepper::tellFingers(const SceneState& state, const SceneInputs* inputs, std::int64_t left) {
  const double h = model_.scene.options.h;
  fingerInputs(model_.scene, static_cast<double>(state.grasp.world.tick + 1) * h, fingers_);
  for (std::size_t i = 0; i < fingers_.size(); ++i) {
    const Vec3& place = inputs && isSaid(inputs->finger_place[i]) ? inputs->finger_place[i] : state.held[i];
    grasp::FingerInput& finger = fingers_[i];
    if (isSaid(place)) {
      const Vec3& from = state.grasp.world.points[i].p_target_W;
      const Vec3 way = (place - from) / static_cast<double>(left);
      finger.p_WF = left == 1 ? place : Vec3(from + way);
      finger.v_WF = way / h;
    }
    if (!inputs) continue;
    if (isSaid(inputs->finger_velocity[i])) finger.v_WF = inputs->finger_velocity[i];
    const Eigen::Vector4d& q = inputs->finger_turn[i];
    if (isSaid(q)) finger.q_WF = Quat(q[0], q[1], q[2], q[3]).normalized();
    finger.f_W += inputs->finger_force[i];
  }
}

void SceneStepper::tellBodies(const SceneState& state, const SceneInputs* inputs) {
  if (motions_.empty()) return;
  bodyMotions(model_.scene, static_cast<double>(state.grasp.world.tick + 1) * model_.scene.options.h, motions_);
  if (!inputs) return;
  for (std::size_t i = 0; i < motions_.size(); ++i) {
    if (!isSaid(inputs->motion_place[i])) continue;
    const std::array<double, 6>& rate = inputs->motion_rate[i];
    motions_[i].X_WB = poseOf(inputs->motion_place[i]);
    motions_[i].motion = {Vec3(rate[0], rate[1], rate[2]), Vec3(rate[3], rate[4], rate[5])};
  }
}

void SceneStepper::tellDrives(const SceneState& state, const SceneInputs* inputs) {
  driveControls(model_.scene, static_cast<double>(state.grasp.world.tick + 1) * model_.scene.options.h, controls_);
  if (!inputs) return;
  for (std::size_t i = 0; i < controls_.size(); ++i) {
    if (!std::isnan(inputs->drive_target[i])) controls_[i] = {inputs->drive_target[i], 0, false};
  }
}

}  // namespace pincer::tasks
