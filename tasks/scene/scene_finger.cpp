#include <fmt/format.h>

#include <algorithm>

#include "tasks/scene/scene_keys.h"
#include "tasks/scene/scene_parts.h"

namespace pincer::tasks {
namespace {

constexpr NumberRule kProxyMass = {.min = 0, .max = 100, .remedy = "In kilograms; 0 gives a massless tip behind its spring."};
constexpr NumberRule kStiffness = {.min = 0, .max = 1e6, .remedy = "In N/m; typical: 200 to 2000."};
constexpr NumberRule kDamping = {.min = 0, .max = 1e5, .remedy = "In N s/m; typical: 2 to 5."};
constexpr NumberRule kForce = {.min = -1e4, .max = 1e4, .remedy = "In newtons."};
constexpr std::array<std::string_view, 3> kAxes = {"x", "y", "z"};

// One number for all axes, or [x, y, z].
Vec3 readPerAxis(const JsonValue& json, const NumberRule& rule) {
  if (json.kind() == JsonValue::Kind::kArray) return json.vector(rule);
  return Vec3::Constant(json.number(rule));
}

void requireHeldAxes(const JsonValue& json, const engine::DrivenPointModel& coupling) {
  for (int axis = 0; axis < 3; ++axis) {
    if (coupling.locked[axis] || coupling.mass + coupling.stiffness[axis] > 0) continue;
    json.reject(
        fmt::format("has neither mass nor stiffness along {}: nothing says where it is. Give it a mass or a stiffness, or lock the axis.",
                    kAxes[static_cast<std::size_t>(axis)]));
  }
}

engine::DrivenPointModel readCoupling(const JsonValue& json) {
  engine::DrivenPointModel coupling;
  if (const JsonValue* v = json.find("mass")) coupling.mass = v->number(kProxyMass);
  if (const JsonValue* v = json.find("stiffness")) coupling.stiffness = readPerAxis(*v, kStiffness);
  if (const JsonValue* v = json.find("damping")) coupling.damping = readPerAxis(*v, kDamping);
  if (const JsonValue* v = json.find("locked")) {
    for (const JsonValue& axis : v->array()) coupling.locked[static_cast<Eigen::Index>(axis.oneOf(kAxes))] = true;
  }
  requireHeldAxes(json, coupling);
  return coupling;
}

TimedPoint readKeyframe(const JsonValue& json, double after) {
  json.allowOnly(keys::kKeyframe);
  const JsonValue& time = json.at("time", "In seconds.");
  const double t = time.number({.min = 0, .max = 1e6, .remedy = "In seconds from the start."});
  if (t <= after) time.reject(fmt::format("doesn't come after {}. Keyframes go forward in time.", after));
  return {t, json.at("position", "Where the finger is then [m].").vector(kCoordinate), Vec3::Zero()};
}

Trajectory readKeyframes(const JsonValue& json) {
  std::vector<TimedPoint> keyframes;
  for (const JsonValue& keyframe : json.array())
    keyframes.push_back(readKeyframe(keyframe, keyframes.empty() ? -1 : keyframes.back().time));
  if (keyframes.empty()) json.reject("is empty. For a finger that rests, use \"position\".");
  return Trajectory::throughKeyframes(std::move(keyframes));
}

Trajectory readTrajectory(const JsonValue& json, const std::string& scene_file) {
  json.allowOnly(keys::kTrajectory);
  const JsonValue* keyframes = json.find("keyframes");
  const JsonValue* csv = json.find("csv");
  if ((keyframes != nullptr) == (csv != nullptr)) json.reject("needs either \"keyframes\" or \"csv\".");
  if (keyframes) return readKeyframes(*keyframes);
  try {
    return readTrajectoryCsv(besideScene(scene_file, csv->text()));
  } catch (const InputError& error) {
    csv->reject(fmt::format("can't be used: {}", error.what()));
  }
}

Trajectory readMotion(const JsonValue& json, const std::string& scene_file) {
  const JsonValue* position = json.find("position");
  const JsonValue* trajectory = json.find("trajectory");
  if (position && trajectory) position->reject("says again where the trajectory starts. Keep one of the two.");
  if (trajectory) return readTrajectory(*trajectory, scene_file);
  if (!position) json.reject("needs \"position\" [m] for a finger that rests, or \"trajectory\".");
  return Trajectory::throughKeyframes({{0, position->vector(kCoordinate), Vec3::Zero()}});
}

}  // namespace

SceneFinger readFinger(const JsonValue& json, const Scene& scene) {
  json.allowOnly(keys::kFinger);
  SceneFinger finger;
  finger.model.name = readName(json, scene, fmt::format("finger{}", scene.fingers.size()));
  if (const JsonValue* v = json.find("radius")) finger.model.radius = v->number(kLength);
  finger.model.coupling = readCoupling(json);
  finger.model.coupling.name = finger.model.name;
  finger.trajectory = readMotion(json, scene.file);
  if (const JsonValue* v = json.find("force")) finger.f_W = v->vector(kForce);
  return finger;
}

}  // namespace pincer::tasks
