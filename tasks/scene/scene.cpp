#include "tasks/scene/scene.h"

#include <fmt/format.h>

#include <cmath>
#include <filesystem>

#include "tasks/scene/scene_keys.h"
#include "tasks/scene/scene_parts.h"
#include "tasks/scene/strict_json.h"

namespace pincer::tasks {
namespace {

constexpr NumberRule kGravity = {.min = -1e3, .max = 1e3, .remedy = "In m/s^2; on Earth [0, 0, -9.81]."};
constexpr NumberRule kTick = {.min = 1e-5, .max = 1e-2, .remedy = "In seconds; a haptic tick is 0.001."};
constexpr NumberRule kDuration = {.min = 0, .max = 1e6, .min_open = true, .remedy = "In seconds."};
constexpr NumberRule kTolerance = {.min = 1e-14, .max = 1e-2, .remedy = "Of the solver's relative residual; usual: 1e-10."};

constexpr NumberRule kBudget = {.min = 1e-6, .max = 10, .remedy = "In seconds; half a tick leaves time for everything else."};
constexpr NumberRule kPositionTolerance = {.min = 1e-12, .max = 1, .remedy = "Position error per tick in metres; 1e-6 is a micrometre."};

void checkVersion(const JsonValue& json) {
  const JsonValue& version = json.at("version", "This program reads version 1.");
  version.integer(kSceneVersion, kSceneVersion, "This program reads version 1.");
}

void readSolver(const JsonValue& json, engine::WorldOptions& options) {
  json.allowOnly(keys::kSolver);
  if (const JsonValue* v = json.find("tolerance")) options.solver.tolerance = v->number(kTolerance);
  if (const JsonValue* v = json.find("max_contacts")) options.max_contacts = v->integer(4, 256, "A whole number of contacts.");
  if (const JsonValue* v = json.find("position_tolerance")) options.position_tolerance = v->number(kPositionTolerance);
  if (const JsonValue* v = json.find("max_parts")) options.max_parts = v->integer(2, 1024, "How many parts a tick may be cut into.");
  if (const JsonValue* v = json.find("budget")) options.solver.budget = v->number(kBudget);
  if (const JsonValue* v = json.find("sleep")) options.sleep = v->boolean();
  if (const JsonValue* v = json.find("contact_margin")) options.contact_margin = v->number(kLength);
}

void readTimes(const JsonValue& json, Scene& scene) {
  if (const JsonValue* v = json.find("tick")) scene.options.h = v->number(kTick);
  const JsonValue& duration = json.at("duration", "How long the scene lasts [s].");
  scene.duration = duration.number(kDuration);
  if (wholeTicks(scene.duration, scene.options.h) < 1)
    duration.reject(fmt::format("isn't a whole number of ticks of {} s.", scene.options.h));
}

}  // namespace

Scene sceneOf(const JsonValue& json, const std::string& name) {
  json.allowOnly(keys::kScene);
  checkVersion(json);
  Scene scene;
  scene.file = name;
  if (const JsonValue* v = json.find("description")) scene.description = v->text();
  if (const JsonValue* v = json.find("gravity")) scene.options.gravity_W = v->vector(kGravity);
  readTimes(json, scene);
  if (const JsonValue* v = json.find("solver")) readSolver(*v, scene.options);
  for (const JsonValue& body : json.at("bodies", "What is in the world.").array()) readBody(body, scene);
  if (const JsonValue* v = json.find("pairs")) {
    for (const JsonValue& pair : v->array()) scene.pairs.push_back(readPair(pair, scene));
  }
  if (const JsonValue* v = json.find("joints")) {
    for (const JsonValue& joint : v->array()) scene.joints.push_back(readJoint(joint, scene));
  }
  if (const JsonValue* v = json.find("fingers")) {
    for (const JsonValue& finger : v->array()) scene.fingers.push_back(readFinger(finger, scene));
  }
  if (scene.bodies.empty() && scene.fingers.empty()) json.at("bodies").reject("is empty, and there is no finger: nothing could happen.");
  if (const JsonValue* v = json.find("record")) scene.record = readRecording(*v, scene);
  if (const JsonValue* v = json.find("expect")) {
    for (const JsonValue& expectation : v->array()) scene.expectations.push_back(readExpectation(expectation, scene));
  }
  return scene;
}

std::int64_t Scene::ticks() const { return wholeTicks(duration, options.h); }

Scene readScene(const std::string& path) { return sceneOf(readJson(path), path); }

Scene parseScene(std::string_view json, const std::string& name) { return sceneOf(parseJson(json, name), name); }

grasp::GraspModel buildWorld(const Scene& scene) {
  try {
    engine::WorldBuilder builder(scene.options);
    for (const engine::BodySpec& body : scene.bodies) builder.addBody(body);
    for (const engine::JointModel& joint : scene.joints) builder.addJoint(joint);
    for (const ScenePair& pair : scene.pairs) {
      if (pair.touch) {
        builder.setPairMaterial(pair.a, pair.b, pair.material);
      } else {
        builder.excludePair(pair.a, pair.b);
      }
    }
    std::vector<grasp::FingerModel> fingers;
    for (const SceneFinger& finger : scene.fingers) fingers.push_back(finger.model);
    return grasp::buildGrasp(std::move(builder), std::move(fingers));
  } catch (const InputError& error) {
    throw InputError(fmt::format("{}: {}", scene.file, error.what()));
  }
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
