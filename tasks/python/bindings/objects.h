// objects: what Python holds of pincer: a model with its source, a state whose numbers can be watched,
// inputs, a pool. They know nothing of Python.
#pragma once
#include <atomic>
#include <memory>
#include <string>
#include <vector>

#include "pincer/tasks/run/rollout/rollout.h"

namespace pincer::python {

struct Model : tasks::SceneModel {
  Model(tasks::Scene scene, std::string name, std::string text)
      : SceneModel(std::move(scene)), name(std::move(name)), text(std::move(text)) {}

  std::string name, text;  // of its source, from which it can be read again
};
using ModelPointer = std::shared_ptr<const Model>;

// Of a pivot or slider.
inline const std::string& nameOfJoint(const Model& model, std::size_t joint) {
  return model.scene.joints[static_cast<std::size_t>(model.joints[joint])].name;
}

// A file's path or the name of a built-in scene. Throws InputError.
ModelPointer loadModel(const std::string& path_or_name);
// From the text of a scene; files that it names are relative to the folder of `name`.
ModelPointer parseModel(const std::string& text, const std::string& name);

// One contact as a row of a structured array.
struct ContactRow {
  std::uint64_t id;
  std::int32_t body, shape, other_body, other_shape, finger;
  double place[3], normal[3], gap, force[3], moment[3], mu;
  bool pushes, slips;
};

// A finger's report of the last tick, with its own copy of the pressure map.
struct FingerFelt {
  grasp::FingerReport report;
  std::vector<grasp::Taxel> pressure;
};

// A state and what is derived from it: rows of places, rates and joints at fixed addresses, which follow every
// step; contacts and reports of the last tick.
class State {
 public:
  explicit State(ModelPointer model);
  State(const State& other);  // a snapshot: its contacts and reports are those of `other`
  State& operator=(const State&) = delete;

  const Model& model() const { return *model_; }
  const ModelPointer& sharedModel() const { return model_; }
  const tasks::SceneState& scene() const { return scene_; }
  std::string hash() const { return tasks::hashText(scene_); }

  // One thread at a time, or throws InputError. `inputs` may be null.
  tasks::StepsReport step(const tasks::SceneInputs* inputs, std::int64_t ticks, const std::function<bool()>& stop);

  void restore(const State& snapshot);  // of the same model, or throws InputError
  void reset();                         // to the start of the scene
  void setBytes(std::string_view bytes);
  void place(int body, const engine::BodyStart& start);
  void setJoint(int joint, double position, double velocity);
  void hold(int finger, const Vec3& place);  // NaN: it follows the scene's trajectory again
  engine::BodyStart startOf(int body) const;

  std::vector<ContactRow> contacts() const;
  FingerFelt felt(int finger) const;
  tasks::Moment moment() const;
  const grasp::GraspScratch* scratch() const;

  double* places() { return places_.data(); }  // bodies x 7
  double* rates() { return rates_.data(); }    // bodies x 6
  double* jointPositions() { return joint_positions_.data(); }
  double* jointVelocities() { return joint_velocities_.data(); }

  // For who steps states in bulk (rollout): between the two nobody else touches it.
  tasks::SceneState& lend();
  void takeBack();

 private:
  class InUse;
  void refresh();

  ModelPointer model_;
  tasks::SceneState scene_;
  mutable std::unique_ptr<tasks::SceneStepper> stepper_;  // made at the first step, or where a quantity asks for it
  bool stepped_ = false;                                  // what touches is in the stepper, else in what follows
  std::vector<ContactRow> contacts_;
  std::vector<FingerFelt> felt_;
  std::vector<grasp::FingerReport> reports_;
  std::vector<double> places_, rates_, joint_positions_, joint_velocities_;
  std::atomic<bool> busy_{false};
};

}  // namespace pincer::python
