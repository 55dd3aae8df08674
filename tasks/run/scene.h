// scene: a world, the fingers in it and what is expected to happen, as read from a JSON file and checked (format:
// docs/scenes.md, docs/scene.schema.json). The same files serve tests, benchmarks, demonstrations and users.
#pragma once
#include <cstdint>
#include <optional>
#include <span>
#include <string>
#include <vector>

#include "pincer/grasp/baseline.h"
#include "pincer/grasp/step.h"
#include "pincer/tasks/run/expectation.h"
#include "pincer/tasks/run/quantity.h"
#include "pincer/tasks/run/trajectory.h"

namespace pincer::tasks {

class JsonValue;

struct SceneFinger {
  grasp::FingerModel model;
  grasp::FingerMethod method = grasp::FingerMethod::kProxy;
  Trajectory trajectory;    // of the device; a single point when the finger rests
  Trajectory turn;          // rotation vectors of the finger frame F [rad]
  Vec3 f_W = Vec3::Zero();  // constant force on the proxy, besides the coupling [N]
};

// The motion of a driven body: a place and a rotation vector from keyframe to keyframe.
struct SceneMotion {
  Trajectory place, turn;
  engine::MotionInput at(double time) const;
};

// Settings of two bodies that differ from the usual.
struct ScenePair {
  int a = 0, b = 0;
  bool touch = true;
  engine::Material material;  // if they touch
};

// A drive, and what it is told: a control that stays, or that follows keyframes.
struct SceneDrive {
  engine::DriveModel model;
  Trajectory control;  // in x
  bool moves = false;
};

// From where a viewer looks at first (tasks/view/camera.h says what the numbers mean); it chooses what is absent.
struct SceneCamera {
  std::optional<double> yaw, pitch;  // [rad]
  std::optional<double> distance;    // [m]
  std::optional<Vec3> target_W;      // [m]
};

struct Recording {
  std::int64_t every = 1;            // ticks between two rows
  std::vector<Quantity> quantities;  // may be empty: nothing is recorded
};

struct Scene {
  std::string file;  // for messages
  std::string description;
  std::string remarks;           // what of its robots' files has no effect, as lines for people
  engine::WorldOptions options;  // tick, gravity, solver
  double duration = 0;           // [s], a whole number of ticks
  std::vector<engine::BodySpec> bodies;
  std::vector<engine::BodyStart> starts;  // one per body
  std::vector<SceneMotion> motions;       // one per driven body, in order
  std::vector<ScenePair> pairs;
  std::vector<engine::JointModel> joints;
  std::vector<engine::CouplingModel> couplings;
  std::vector<SceneDrive> drives;
  std::vector<BodyFrame> frames;
  std::vector<SceneFinger> fingers;
  Recording record;
  SceneCamera camera;
  std::vector<Expectation> expectations;
  std::vector<int> body_lines, joint_lines, coupling_lines, drive_lines,
      pair_lines;  // in the file, for messages; empty where there is none

  std::int64_t ticks() const;  // in `duration`
};

constexpr int kSceneVersion = 1;  // of the format, which a scene names

// Throws InputError: file, line, path, value, range, remedy.
Scene readScene(const std::string& path);
// The same from text; files that it names are relative to the folder of `name`.
Scene parseScene(std::string_view json, const std::string& name);
// The same from what was parsed already.
Scene sceneOf(const JsonValue& json, const std::string& name);

// A quantity of the scene by its name (docs/scenes.md). Throws InputError, with a did-you-mean.
Quantity quantityOf(const std::string& name, const Scene& scene);

grasp::GraspModel buildWorld(const Scene& scene);
std::vector<grasp::FingerMethod> methodsOf(const Scene& scene);  // of its fingers
grasp::GraspState startState(const Scene& scene, const grasp::GraspModel& model);

// Where every finger's device is at `time`, the end of a tick. One entry per finger.
void fingerInputs(const Scene& scene, double time, std::span<grasp::FingerInput> inputs);

// How every driven body moves at `time`, the end of a tick. One entry per driven body.
void bodyMotions(const Scene& scene, double time, std::span<engine::MotionInput> motions);

// The control of every drive at `time`, the end of a tick. One entry per drive.
void driveControls(const Scene& scene, double time, std::span<engine::DriveInput> controls);

// How many whole ticks `seconds` is, or -1 when it is none (to a millionth of a tick).
std::int64_t wholeTicks(double seconds, double tick);

}  // namespace pincer::tasks
