#include "pincer/tasks/run/scene.h"

#include <fmt/format.h>

#include <cmath>
#include <filesystem>

#include "pincer/tasks/run/files/file_limits.h"
#include "pincer/tasks/run/files/strict_json.h"
#include "pincer/tasks/run/scene/scene_keys.h"
#include "pincer/tasks/run/scene/scene_parts.h"
#include "pincer/tasks/run/scene/scene_robot.h"

namespace pincer::tasks {
namespace {

const std::vector<JsonValue>& listOf(const JsonValue& json, std::size_t most) {
  const std::vector<JsonValue>& items = json.array();
  if (items.size() > most)
    json.reject(fmt::format("has {} elements; a scene has at most {}. Leave some out.", items.size(), most));
  return items;
}

void checkVersion(const JsonValue& json) {
  const JsonValue& version = json.at("version", "This program reads version 1.");
  version.integer(kSceneVersion, kSceneVersion, "This program reads version 1.");
}

void readSolver(const JsonValue& json, engine::WorldOptions& options) {
  json.allowOnly(keys::kSolver);
  if (const JsonValue* v = json.find("tolerance")) options.solver.tolerance = v->number(ranges::kTolerance);
  if (const JsonValue* v = json.find("max_contacts"))
    options.max_contacts = v->integer(4, 65536, "A whole number of contacts; left out, the scene's bodies decide.");
  if (const JsonValue* v = json.find("position_tolerance"))
    options.position_tolerance = v->number(ranges::kPositionTolerance);
  if (const JsonValue* v = json.find("max_parts"))
    options.max_parts = v->integer(2, 1024, "How many parts a tick may be cut into.");
  if (const JsonValue* v = json.find("accuracy")) options.solver.accuracy = v->number(ranges::kAccuracy);
  if (const JsonValue* v = json.find("budget")) options.solver.budget = v->number(ranges::kBudget);
  if (const JsonValue* v = json.find("sleep")) options.sleep = v->boolean();
  if (const JsonValue* v = json.find("contact_margin")) options.contact_margin = v->number(ranges::kContactMargin);
}

void readTimes(const JsonValue& json, Scene& scene) {
  if (const JsonValue* v = json.find("tick")) scene.options.h = v->number(ranges::kTick);
  const JsonValue& duration = json.at("duration", "How long the scene lasts [s].");
  scene.duration = duration.number(ranges::kDuration);
  if (wholeTicks(scene.duration, scene.options.h) < 1)
    duration.reject(fmt::format("isn't a whole number of ticks of {} s.", scene.options.h));
}

void readJoints(const JsonValue& json, SceneNames& names, Scene& scene) {
  for (const JsonValue& joint : listOf(json, kMostJoints)) {
    scene.joints.push_back(readJoint(joint, names, scene));
    scene.joint_lines.push_back(joint.line());
  }
}

SceneCamera readCamera(const JsonValue& json) {
  json.allowOnly(keys::kCamera);
  SceneCamera camera;
  if (const JsonValue* v = json.find("yaw")) camera.yaw = v->number(ranges::kYaw);
  if (const JsonValue* v = json.find("pitch")) camera.pitch = v->number(ranges::kPitch);
  if (const JsonValue* v = json.find("distance")) camera.distance = v->number(ranges::kViewDistance);
  if (const JsonValue* v = json.find("target")) camera.target_W = v->vector(ranges::kCoordinate);
  return camera;
}

// Joints, what ties them together and what drives them, frames.
void readJointed(const JsonValue& json, SceneNames& names, Scene& scene) {
  if (const JsonValue* v = json.find("joints")) readJoints(*v, names, scene);
  if (const JsonValue* v = json.find("couplings")) {
    for (const JsonValue& coupling : listOf(*v, kMostJoints)) {
      scene.couplings.push_back(readCoupling(coupling, scene));
      scene.coupling_lines.push_back(coupling.line());
    }
  }
  std::vector<SceneTendon> tendons;
  if (const JsonValue* v = json.find("tendons")) {
    for (const JsonValue& tendon : listOf(*v, kMostJoints)) tendons.push_back(readTendon(tendon, names, scene));
  }
  if (const JsonValue* v = json.find("drives")) {
    for (const JsonValue& drive : listOf(*v, kMostJoints)) {
      scene.drives.push_back(readDrive(drive, tendons, names, scene));
      scene.drive_lines.push_back(drive.line());
    }
  }
  if (const JsonValue* v = json.find("frames")) {
    for (const JsonValue& frame : listOf(*v, kMostJoints)) scene.frames.push_back(readFrame(frame, names, scene));
  }
}

void readBodies(const JsonValue& json, SceneNames& names, SceneHulls& hulls, Scene& scene) {
  for (const JsonValue& body : listOf(json.at("bodies", "What is in the world."), kMostBodies)) {
    readBody(body, names, hulls, scene);
    scene.body_lines.push_back(body.line());
  }
  if (const JsonValue* v = json.find("pairs")) {
    for (const JsonValue& pair : listOf(*v, kMostPairs)) {
      scene.pairs.push_back(readPair(pair, names, scene));
      scene.pair_lines.push_back(pair.line());
    }
  }
  readJointed(json, names, scene);
}

// A control that stays, or keyframes, for each drive by its name in the robot's file.
void tellDrives(const JsonValue& json, const std::string& prefix, Scene& scene) {
  std::vector<std::string_view> names;
  for (const SceneDrive& drive : scene.drives) {
    if (drive.model.name.rfind(prefix, 0) == 0)
      names.push_back(std::string_view(drive.model.name).substr(prefix.size()));
  }
  json.allowOnly(names);
  for (SceneDrive& drive : scene.drives) {
    if (drive.model.name.rfind(prefix, 0) != 0) continue;
    if (const JsonValue* v = json.find(std::string_view(drive.model.name).substr(prefix.size())))
      readDriveControl(*v, drive);
  }
}

// Its bodies, joints and drives; in messages all of them stand where the robot is named.
void addRobot(const JsonValue& json, const RobotFileOptions& options, SceneNames& names, SceneHulls& hulls,
              Scene& scene) {
  const std::array lines = {&scene.body_lines, &scene.joint_lines, &scene.coupling_lines, &scene.drive_lines,
                            &scene.pair_lines};
  std::array<std::ptrdiff_t, lines.size()> before;
  for (std::size_t i = 0; i < lines.size(); ++i) before[i] = std::ssize(*lines[i]);
  const RobotJson robot = readRobot(json, options, scene);
  try {
    readBodies(robot.json, names, hulls, scene);
  } catch (const InputError& error) {
    json.reject(fmt::format("can't be had: {}", error.what()));
  }
  if (const JsonValue* v = json.find("drives")) tellDrives(*v, robot.prefix, scene);
  for (std::size_t i = 0; i < lines.size(); ++i) std::fill(lines[i]->begin() + before[i], lines[i]->end(), json.line());
}

void readFingers(const JsonValue& json, SceneNames& names, Scene& scene) {
  int count = 0;
  for (const JsonValue& finger : listOf(json, kMostFingers)) {
    const std::string usual_name = fmt::format("finger{}", count++);
    if (finger.find("on"))
      addCarriedFinger(finger, usual_name, names, scene);
    else
      scene.fingers.push_back(readFinger(finger, usual_name, names, scene));
  }
}

}  // namespace

Scene sceneOf(const JsonValue& json, const std::string& name) { return sceneOf(json, name, RobotFileOptions{}); }

Scene sceneOf(const JsonValue& json, const std::string& name, const RobotFileOptions& options) {
  json.allowOnly(keys::kScene);
  checkVersion(json);
  Scene scene;
  scene.file = name;
  if (const JsonValue* v = json.find("description")) scene.description = v->text();
  if (const JsonValue* v = json.find("gravity")) scene.options.gravity_W = v->vector(ranges::kGravity);
  readTimes(json, scene);
  if (const JsonValue* v = json.find("solver")) readSolver(*v, scene.options);
  if (const JsonValue* v = json.find("combination"))
    scene.options.combination = static_cast<engine::Combination>(v->oneOf(keys::kCombinations));
  SceneNames names;
  SceneHulls hulls;
  if (const JsonValue* v = json.find("robots")) {
    for (const JsonValue& robot : listOf(*v, kMostRobots)) addRobot(robot, options, names, hulls, scene);
  }
  readBodies(json, names, hulls, scene);
  if (const JsonValue* v = json.find("fingers")) readFingers(*v, names, scene);
  if (scene.bodies.empty() && scene.fingers.empty())
    json.at("bodies").reject("is empty, and there is no finger: nothing could happen.");
  if (const JsonValue* v = json.find("camera")) scene.camera = readCamera(*v);
  if (const JsonValue* v = json.find("record")) scene.record = readRecording(*v, scene);
  if (const JsonValue* v = json.find("expect")) {
    for (const JsonValue& expectation : listOf(*v, kMostQuantities))
      scene.expectations.push_back(readExpectation(expectation, scene));
  }
  return scene;
}

std::int64_t Scene::ticks() const { return wholeTicks(duration, options.h); }

Scene readScene(const std::string& path) { return sceneOf(readJson(path, kSceneFile), path); }

Scene parseScene(std::string_view json, const std::string& name) { return sceneOf(parseJson(json, name), name); }

namespace {

void addPair(const ScenePair& pair, engine::WorldBuilder& builder) {
  if (pair.touch) {
    builder.setPairMaterial(pair.a, pair.b, pair.material);
  } else {
    builder.excludePair(pair.a, pair.b);
  }
}

// Runs `build`, which makes part `index` of the world; what is said against it
// gets the scene's name and the part's line.
template <class Build>
auto atLine(const Scene& scene, const std::vector<int>& lines, std::size_t index, const Build& build) {
  try {
    return build();
  } catch (const InputError& error) {
    const std::string line = index < lines.size() ? fmt::format(":{}", lines[index]) : "";
    throw InputError(fmt::format("{}{}: {}", scene.file, line, error.what()));
  }
}

}  // namespace

grasp::GraspModel buildWorld(const Scene& scene) {
  engine::WorldBuilder builder = atLine(scene, {}, 0, [&] { return engine::WorldBuilder(scene.options); });
  for (std::size_t i = 0; i < scene.bodies.size(); ++i)
    atLine(scene, scene.body_lines, i, [&] { builder.addBody(scene.bodies[i]); });
  for (std::size_t i = 0; i < scene.joints.size(); ++i)
    atLine(scene, scene.joint_lines, i, [&] { builder.addJoint(scene.joints[i]); });
  for (std::size_t i = 0; i < scene.couplings.size(); ++i)
    atLine(scene, scene.coupling_lines, i, [&] { builder.addCoupling(scene.couplings[i]); });
  for (std::size_t i = 0; i < scene.drives.size(); ++i)
    atLine(scene, scene.drive_lines, i, [&] { builder.addDrive(scene.drives[i].model); });
  for (std::size_t i = 0; i < scene.pairs.size(); ++i)
    atLine(scene, scene.pair_lines, i, [&] { addPair(scene.pairs[i], builder); });
  std::vector<grasp::FingerModel> fingers;
  for (const SceneFinger& finger : scene.fingers) fingers.push_back(finger.model);
  // Groups of bodies that joints make are found out last.
  return atLine(scene, scene.joint_lines, 0, [&] { return grasp::buildGrasp(std::move(builder), std::move(fingers)); });
}

std::vector<grasp::FingerMethod> methodsOf(const Scene& scene) {
  std::vector<grasp::FingerMethod> methods;
  for (const SceneFinger& finger : scene.fingers) methods.push_back(finger.method);
  return methods;
}

grasp::GraspState startState(const Scene& scene, const grasp::GraspModel& model) {
  std::vector<Vec3> fingers;
  for (const SceneFinger& finger : scene.fingers) fingers.push_back(finger.trajectory.start());
  return grasp::makeState(model, scene.starts, fingers);
}

void fingerInputs(const Scene& scene, double time, std::span<grasp::FingerInput> inputs) {
  for (std::size_t i = 0; i < inputs.size(); ++i) {
    const SceneFinger& finger = scene.fingers[i];
    const TimedPoint device = finger.trajectory.at(time);
    inputs[i].p_WF = device.p_W;
    inputs[i].v_WF = device.v_W;
    inputs[i].q_WF = quatFromRotationVector(finger.turn.at(time).p_W);
    inputs[i].f_W = finger.f_W;
  }
}

std::int64_t wholeTicks(double seconds, double tick) {
  const double ticks = seconds / tick;
  const double whole = std::round(ticks);
  return std::abs(ticks - whole) <= 1e-6 ? static_cast<std::int64_t>(whole) : -1;
}

std::string besideScene(const std::string& file, const std::string& name) {
  return (std::filesystem::path(file).parent_path() / name).string();
}

}  // namespace pincer::tasks
