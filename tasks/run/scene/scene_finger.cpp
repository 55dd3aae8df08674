#include <fmt/format.h>

#include <algorithm>

#include "pincer/tasks/run/scene/scene_keys.h"
#include "pincer/tasks/run/scene/scene_parts.h"

namespace pincer::tasks {
namespace {

// One number for all axes, or [x, y, z].
Vec3 readPerAxis(const JsonValue& json, const NumberRule& rule) {
  if (json.kind() == JsonValue::Kind::kArray) return json.vector(rule);
  return Vec3::Constant(json.number(rule));
}

void requireHeldAxes(const JsonValue& json, const engine::DrivenPointModel& coupling) {
  for (int axis = 0; axis < 3; ++axis) {
    if (coupling.locked[axis] || coupling.mass + coupling.stiffness[axis] > 0) continue;
    json.reject(
        fmt::format("has neither mass nor stiffness along {}: nothing says where it is. Give it a mass or a stiffness, "
                    "or lock the axis.",
                    keys::kAxes[static_cast<std::size_t>(axis)]));
  }
}

// One number, [x, y, z] in the world, or {"normal": .., "tangential": ..} of the contact.
void readDirections(const JsonValue& json, const NumberRule& rule, Vec3& value, bool& along_normal) {
  if (json.kind() != JsonValue::Kind::kObject) {
    value = readPerAxis(json, rule);
    return;
  }
  json.allowOnly(keys::kPerDirection);
  const double tangential = json.at("tangential", "Along the surface.").number(rule);
  value = Vec3(tangential, tangential, json.at("normal", "Against the surface.").number(rule));
  along_normal = true;
}

void requireOneKindOfAxes(const JsonValue& json) {
  const JsonValue *stiffness = json.find("stiffness"), *damping = json.find("damping");
  const auto has = [](const JsonValue* v, JsonValue::Kind kind) { return v && v->kind() == kind; };
  const bool along = has(stiffness, JsonValue::Kind::kObject) || has(damping, JsonValue::Kind::kObject);
  if (!along) return;
  for (const JsonValue* v : {stiffness, damping}) {
    if (has(v, JsonValue::Kind::kArray))
      v->reject("is along the world's axes, but the other one along the contact's. Give both in one way.");
  }
  if (const JsonValue* v = json.find("locked"))
    v->reject("locks axes of the world, but the coupling is along the contact's. Remove one.");
}

// Damped within some ticks unless it is said how.
void readTurn(const JsonValue& json, engine::DrivenPointModel& coupling) {
  constexpr double kUsualDamping = 1e-3;  // over the stiffness [s]
  const JsonValue *stiffness = json.find("turn_stiffness"), *damping = json.find("turn_damping");
  if (stiffness) coupling.turn_stiffness = stiffness->number(ranges::kTurn);
  coupling.turn_damping = damping ? damping->number(ranges::kTurn) : kUsualDamping * coupling.turn_stiffness;
  if (!(coupling.turn_stiffness + coupling.turn_damping > 0)) return;
  for (const char* key : {"twist_stiffness", "twist_damping"}) {
    if (const JsonValue* v = json.find(key))
      v->reject("is about the contact normal, but a turn_stiffness is about every axis. Keep one.");
  }
}

void readCoupling(const JsonValue& json, grasp::FingerModel& finger) {
  engine::DrivenPointModel& coupling = finger.coupling;
  requireOneKindOfAxes(json);
  if (const JsonValue* v = json.find("mass")) coupling.mass = v->number(ranges::kProxyMass);
  if (const JsonValue* v = json.find("stiffness"))
    readDirections(*v, ranges::kStiffness, coupling.stiffness, finger.along_normal);
  if (const JsonValue* v = json.find("damping"))
    readDirections(*v, ranges::kDamping, coupling.damping, finger.along_normal);
  if (const JsonValue* v = json.find("locked")) {
    for (const JsonValue& axis : v->array()) coupling.locked[static_cast<Eigen::Index>(axis.oneOf(keys::kAxes))] = true;
  }
  if (const JsonValue* v = json.find("twist_stiffness")) coupling.twist_stiffness = v->number(ranges::kTwist);
  if (const JsonValue* v = json.find("twist_damping")) coupling.twist_damping = v->number(ranges::kTwist);
  readTurn(json, coupling);
  coupling.name = finger.name;
  requireHeldAxes(json, coupling);
}

grasp::PressureGrid readTaxels(const JsonValue& json) {
  constexpr int kFewestTaxels = 2, kMostTaxels = 64;  // in a row or column; chosen: eight times a fingerpad's sensor
  json.allowOnly(keys::kTaxels);
  const auto count = [&](const char* key) {
    return json.at(key, "How many taxels that way.")
        .integer(kFewestTaxels, kMostTaxels, "A fingerpad's sensor has 8 x 6.");
  };
  grasp::PressureGrid grid{.rows = count("rows"), .columns = count("columns")};
  if (const JsonValue* v = json.find("pitch")) grid.pitch = v->number(ranges::kTaxelPitch);
  return grid;
}

// Pad and tip.
void readTipOf(const JsonValue& json, const Scene& scene, grasp::FingerModel& finger) {
  const JsonValue *shape = json.find("shape"), *radius = json.find("radius");
  if (shape && radius) radius->reject("says again how large the tip is, which \"shape\" does. Keep one of the two.");
  if (radius) finger.radius = radius->number(ranges::kTipLength);
  if (shape) finger.shape = readFingerShape(*shape, scene.file);
  if (shape) finger.radius = contact::boundingRadiusOf(*finger.shape);
  const JsonValue *patch = json.find("patch_radius"), *modulus = json.find("modulus");
  if (patch && modulus) patch->reject("and \"modulus\" both say how large the patch is. Keep one of the two.");
  if (patch) finger.pad.patch_radius = patch->number(ranges::kPatch);
  if (modulus) finger.pad.modulus = modulus->number(ranges::kModulus);
  if (const JsonValue* v = json.find("taxels")) finger.taxels = readTaxels(*v);
  if (const JsonValue* v = json.find("effective_radius"))
    finger.pad.effective_radius = v->number(ranges::kEffectiveRadius);
}

grasp::ArmPort readArm(const JsonValue& json) {
  json.allowOnly(keys::kArm);
  grasp::ArmPort arm;
  if (const JsonValue* v = json.find("mass")) arm.mass = v->number(ranges::kArmMass);
  if (const JsonValue* v = json.find("damping")) arm.damping = v->number(ranges::kDamping);
  return arm;
}

struct FingerPath {
  Trajectory place, turn;
};

FingerPath readKeyframes(const JsonValue& json, const Vec3& rotation) {
  std::vector<TimedPoint> places, turns;
  Vec3 turn = rotation;
  for (const JsonValue& keyframe : json.array()) {
    keyframe.allowOnly(keys::kKeyframe);
    const JsonValue& time = keyframe.at("time", "In seconds.");
    const double t = time.number(ranges::kTime);
    if (const JsonValue* v = keyframe.find("rotation")) turn = v->vector(ranges::kRotation);
    places.push_back(
        {t, keyframe.at("position", "Where the finger is then [m].").vector(ranges::kCoordinate), Vec3::Zero()});
    turns.push_back({t, turn, Vec3::Zero()});
    requireOnward(places, ranges::kFastest, time);
    requireOnward(turns, ranges::kFastestSpin, time);
  }
  if (places.empty()) json.reject("is empty. For a finger that rests, use \"position\".");
  return {Trajectory::throughKeyframes(std::move(places)), Trajectory::throughKeyframes(std::move(turns))};
}

Trajectory constantTurn(const Vec3& rotation) { return Trajectory::throughKeyframes({{0, rotation, Vec3::Zero()}}); }

FingerPath readTrajectory(const JsonValue& json, const std::string& scene_file, const Vec3& rotation) {
  json.allowOnly(keys::kTrajectory);
  const JsonValue* keyframes = json.find("keyframes");
  const JsonValue* csv = json.find("csv");
  if ((keyframes != nullptr) == (csv != nullptr)) json.reject("needs either \"keyframes\" or \"csv\".");
  if (keyframes) return readKeyframes(*keyframes, rotation);
  try {
    return {readTrajectoryCsv(besideScene(scene_file, csv->text())), constantTurn(rotation)};
  } catch (const InputError& error) {
    csv->reject(fmt::format("can't be used: {}", error.what()));
  }
}

FingerPath readMotion(const JsonValue& json, const std::string& scene_file) {
  const JsonValue* position = json.find("position");
  const JsonValue* trajectory = json.find("trajectory");
  if (position && trajectory) position->reject("says again where the trajectory starts. Keep one of the two.");
  const JsonValue* turn = json.find("rotation");
  const Vec3 rotation = turn ? turn->vector(ranges::kRotation) : Vec3::Zero();
  if (trajectory) return readTrajectory(*trajectory, scene_file, rotation);
  if (!position) json.reject("needs \"position\" [m] for a finger that rests, or \"trajectory\".");
  return {Trajectory::throughKeyframes({{0, position->vector(ranges::kCoordinate), Vec3::Zero()}}),
          constantTurn(rotation)};
}

}  // namespace

SceneFinger readFinger(const JsonValue& json, const std::string& usual_name, SceneNames& names, const Scene& scene) {
  json.allowOnly(keys::kFinger);
  refuse(json, "material", "goes with \"on\" only: a finger of a hand has the friction of what it touches.");
  SceneFinger finger;
  finger.model.name = names.readNext(json, usual_name);
  readTipOf(json, scene, finger.model);
  readCoupling(json, finger.model);
  if (const JsonValue* v = json.find("method"))
    finger.method = static_cast<grasp::FingerMethod>(v->oneOf(grasp::kFingerMethodNames));
  if (const JsonValue* v = json.find("arm")) finger.model.arm = readArm(*v);
  const FingerPath path = readMotion(json, scene.file);
  finger.trajectory = path.place;
  finger.turn = path.turn;
  if (const JsonValue* v = json.find("force")) finger.f_W = v->vector(ranges::kForce);
  return finger;
}

}  // namespace pincer::tasks
