#include "pincer/tasks/python/bindings/objects.h"

#include <algorithm>

#include "pincer/contact/error.h"
#include "pincer/tasks/run/rollout/state_bytes.h"
#include "pincer/tasks/run/rollout/state_rows.h"
#include "pincer/tasks/run/scene/builtin_scenes.h"

namespace pincer::python {
namespace {

ContactRow rowOf(const engine::ContactReport& c) {
  ContactRow row{c.id, c.body, c.shape, c.other_body, c.other_shape, c.point,  {},
                 {},   c.gap,  {},      {},           c.mu,          c.pushes, c.sliding};
  std::copy_n(c.p_W.data(), 3, row.place);
  std::copy_n(c.n_W.data(), 3, row.normal);
  std::copy_n(c.f_W.data(), 3, row.force);
  std::copy_n(c.moment_W.data(), 3, row.moment);
  return row;
}

FingerFelt feltOf(const grasp::FingerReport& report) {
  FingerFelt felt{report, {report.pressure.begin(), report.pressure.end()}};
  felt.report.pressure = {};
  return felt;
}

}  // namespace

ModelPointer loadModel(const std::string& path_or_name) {
  tasks::Scene scene = tasks::readSceneOrBuiltin(path_or_name);
  return std::make_shared<const Model>(std::move(scene), path_or_name, tasks::sceneText(path_or_name));
}

ModelPointer parseModel(const std::string& text, const std::string& name) {
  return std::make_shared<const Model>(tasks::parseScene(text, name), name, text);
}

// Marks a state as being stepped or changed.
class State::InUse {
 public:
  explicit InUse(State& state) : busy_(state.busy_) {
    if (busy_.exchange(true))
      throw InputError("this state is being stepped by another thread. Give each thread a copy() of its own.");
  }
  ~InUse() { busy_ = false; }
  InUse(const InUse&) = delete;
  InUse& operator=(const InUse&) = delete;

 private:
  std::atomic<bool>& busy_;
};

State::State(ModelPointer model)
    : model_(std::move(model)),
      scene_(*model_),
      places_(7 * model_->scene.bodies.size()),
      rates_(6 * model_->scene.bodies.size()),
      joint_positions_(model_->joints.size()),
      joint_velocities_(model_->joints.size()) {
  reset();
}

State::State(const State& other)
    : model_(other.model_),
      scene_(other.scene_),
      contacts_(other.contacts()),
      places_(other.places_),
      rates_(other.rates_),
      joint_positions_(other.joint_positions_),
      joint_velocities_(other.joint_velocities_) {
  for (std::size_t i = 0; i < other.model_->scene.fingers.size(); ++i) felt_.push_back(other.felt(static_cast<int>(i)));
  refresh();
}

tasks::StepsReport State::step(const tasks::SceneInputs* inputs, std::int64_t ticks,
                               const std::function<bool()>& stop) {
  const InUse in_use(*this);
  if (!stepper_) stepper_ = std::make_unique<tasks::SceneStepper>(*model_);
  const tasks::StepsReport report =
      inputs ? stepper_->step(scene_, *inputs, ticks, stop) : stepper_->step(scene_, ticks, stop);
  stepped_ = true;
  refresh();
  return report;
}

void State::restore(const State& snapshot) {
  const InUse in_use(*this);
  if (snapshot.model_ != model_) throw InputError("restore: the snapshot is a state of another model.");
  if (&snapshot == this) return;
  std::vector<ContactRow> contacts = snapshot.contacts();
  std::vector<FingerFelt> felt;
  for (std::size_t i = 0; i < model_->scene.fingers.size(); ++i) felt.push_back(snapshot.felt(static_cast<int>(i)));
  scene_ = snapshot.scene_;
  contacts_ = std::move(contacts);
  felt_ = std::move(felt);
  stepped_ = false;
  refresh();
}

void State::reset() {
  const InUse in_use(*this);
  scene_ = tasks::SceneState(*model_);
  contacts_.clear();
  felt_.assign(model_->scene.fingers.size(), {});
  stepped_ = false;
  refresh();
}

void State::setBytes(std::string_view bytes) {
  const InUse in_use(*this);
  tasks::setFromBytes(scene_, bytes);
  refresh();
}

void State::place(int body, const engine::BodyStart& start) {
  const InUse in_use(*this);
  tasks::placeBody(*model_, scene_, body, start);
  refresh();
}

void State::setJoint(int joint, double position, double velocity) {
  const InUse in_use(*this);
  tasks::placeJoint(*model_, scene_, joint, position, velocity);
  refresh();
}

void State::hold(int finger, const Vec3& place) { scene_.held[static_cast<std::size_t>(finger)] = place; }

engine::BodyStart State::startOf(int body) const {
  const engine::WorldState& world = scene_.grasp.world;
  return {engine::bodyPose(model_->grasp.world, world, body), world.bodies[static_cast<std::size_t>(body)].v_W,
          engine::bodyAngularVelocity(model_->grasp.world, world, body)};
}

std::vector<ContactRow> State::contacts() const {
  if (!stepped_) return contacts_;
  std::vector<ContactRow> rows;
  const int count = engine::contactCount(stepper_->world());
  for (int k = 0; k < count; ++k) rows.push_back(rowOf(engine::contactAt(stepper_->world(), k)));
  return rows;
}

FingerFelt State::felt(int finger) const {
  const auto index = static_cast<std::size_t>(finger);
  return stepped_ ? feltOf(stepper_->fingers()[index]) : felt_[index];
}

tasks::Moment State::moment() const {
  if (!stepped_) stepper_ = std::make_unique<tasks::SceneStepper>(*model_);  // in which nothing touches yet
  return {model_->grasp,
          scene_.grasp,
          stepped_ ? stepper_->fingers() : std::span<const grasp::FingerReport>(reports_),
          model_->scene.starts,
          stepper_->scratch(),
          model_->scene.frames};
}

const grasp::GraspScratch* State::scratch() const { return stepped_ ? &stepper_->scratch() : nullptr; }

tasks::SceneState& State::lend() {
  if (busy_.exchange(true))
    throw InputError("this state is being stepped by another thread, or is in the list twice. Give each its copy().");
  return scene_;
}

void State::takeBack() {
  contacts_.clear();
  felt_.assign(model_->scene.fingers.size(), {});
  stepped_ = false;
  refresh();
  busy_ = false;
}

void State::refresh() {
  tasks::writePlaces(*model_, scene_, places_);
  tasks::writeRates(*model_, scene_, rates_);
  tasks::writeJoints(*model_, scene_, joint_positions_, joint_velocities_);
  if (stepped_) return;
  reports_.clear();
  for (const FingerFelt& felt : felt_) {
    reports_.push_back(felt.report);
    reports_.back().pressure = felt.pressure;
  }
}

}  // namespace pincer::python
