#include <fmt/format.h>

#include "contact/smooth_mesh.h"
#include "engine/motion/mass.h"
#include "tasks/scene/scene_keys.h"
#include "tasks/scene/scene_parts.h"

namespace pincer::tasks {
namespace {

constexpr NumberRule kMass = {.min = 0, .max = 1e6, .min_open = true, .remedy = "Masses are in kilograms: 75 g is 0.075."};
constexpr NumberRule kDensity = {
    .min = 0, .max = 1e5, .min_open = true, .remedy = "Densities are in kg/m^3: water 1000, ABS plastic 1050, aluminium 2700."};
constexpr NumberRule kFriction = {.min = 0, .remedy = "A friction coefficient can't be negative; typical: skin on plastic 0.6."};
constexpr NumberRule kRestitution = {.min = 0, .max = 1, .remedy = "0 doesn't bounce, 1 loses nothing; typical: plastic on wood 0.5."};
constexpr NumberRule kTorsionRadius = {.min = 0, .max = 1, .remedy = "In metres; 0 for a point contact, a fingertip's is about 0.0033."};
constexpr NumberRule kRollingRadius = {
    .min = 0, .max = 1, .remedy = "In metres; 0 rolls freely, a hundredth of a ball's radius is a soft floor."};
constexpr NumberRule kVelocity = {.min = -1e3, .max = 1e3, .remedy = "Velocities are in m/s."};
constexpr NumberRule kRotation = {.min = -100, .max = 100, .remedy = "An axis times an angle in radians."};
constexpr NumberRule kSpin = {.min = -1e4, .max = 1e4, .remedy = "Angular velocities are in rad/s."};

engine::Material readMaterial(const JsonValue& json) {
  json.allowOnly(keys::kMaterial);
  engine::Material material;
  if (const JsonValue* v = json.find("mu_s")) material.mu_s = v->number(kFriction);
  material.mu_d = material.mu_s;
  if (const JsonValue* v = json.find("mu_d")) {
    material.mu_d = v->number({.min = 0, .max = material.mu_s, .remedy = "Dynamic friction isn't larger than static friction (mu_s)."});
  }
  if (const JsonValue* v = json.find("restitution")) material.restitution = v->number(kRestitution);
  if (const JsonValue* v = json.find("torsion_radius")) material.torsion_radius = v->number(kTorsionRadius);
  if (const JsonValue* v = json.find("rolling_radius")) material.rolling_radius = v->number(kRollingRadius);
  if (const JsonValue* v = json.find("stribeck_speed")) {
    material.stribeck_speed = v->number({.min = 0, .max = 100, .remedy = "In m/s: below it friction rises to mu_s; 0: it doesn't."});
  }
  return material;
}

bool isSupport(const contact::Shape& shape) {
  return std::holds_alternative<contact::HalfSpace>(shape) || std::holds_alternative<contact::Dish>(shape);
}

bool readDynamic(const JsonValue& json, const contact::Shape& shape) {
  const JsonValue* fixed = json.find("static");
  if (const JsonValue* v = json.find("trajectory")) {
    if (isSupport(shape)) v->reject("doesn't go with this shape: half-spaces and dishes never move. Use a box.");
    if (fixed) fixed->reject("doesn't go with a trajectory: one of the two says how the body moves. Remove one.");
    return false;
  }
  if (!isSupport(shape)) return !(fixed && fixed->boolean());
  if (fixed && !fixed->boolean()) fixed->reject("doesn't go with this shape: half-spaces and dishes never move. Remove the key.");
  return false;
}

void refuse(const JsonValue& json, std::string_view key, std::string_view because) {
  if (const JsonValue* value = json.find(key)) value->reject(because);
}

double readMass(const JsonValue& json, const engine::BodySpec& spec) {
  const JsonValue* mass = json.find("mass");
  const JsonValue* density = json.find("density");
  if (!spec.dynamic) {
    const bool driven = json.find("trajectory") != nullptr;
    const std::string_view because = driven ? "doesn't go with a trajectory, which the body follows whatever touches it. Remove the key."
                                            : "doesn't go with a body that never moves. Remove the key.";
    refuse(json, "mass", because);
    refuse(json, "density", because);
    return 0;
  }
  if (mass && density) density->reject("says again what \"mass\" says. Keep one of the two.");
  if (mass) return mass->number(kMass);
  if (!density) json.reject("lacks the key \"mass\" [kg] (or \"density\" [kg/m^3], or \"static\": true).");
  const double rho = density->number(kDensity);
  try {
    return rho * engine::volumeOf(spec.shape);
  } catch (const InputError& error) {
    density->reject(fmt::format("can't be used: {}", error.what()));
  }
}

Vec3 readVector(const JsonValue& json, std::string_view key, const NumberRule& rule) {
  const JsonValue* value = json.find(key);
  return value ? value->vector(rule) : Vec3::Zero();
}

engine::BodyStart readStart(const JsonValue& json, const engine::BodySpec& spec) {
  engine::BodyStart start;
  if (std::holds_alternative<contact::HalfSpace>(spec.shape)) {
    for (const std::string_view key : {"position", "rotation"})
      refuse(json, key, "doesn't go with a half-space: its shape has \"point\" and \"normal\".");
    start.X_WB = readHalfSpacePose(json.at("shape"));
  } else {
    start.X_WB.p = readVector(json, "position", kCoordinate);
    start.X_WB.q = quatFromRotationVector(readVector(json, "rotation", kRotation));
  }
  if (!spec.dynamic) {
    for (const std::string_view key : {"velocity", "angular_velocity"})
      refuse(json, key, "doesn't go with a body that never moves. Remove the key.");
  }
  start.v_W = readVector(json, "velocity", kVelocity);
  start.w_W = readVector(json, "angular_velocity", kSpin);
  return start;
}

}  // namespace

void readBody(const JsonValue& json, Scene& scene) {
  json.allowOnly(keys::kBody);
  engine::BodySpec spec;
  spec.name = readName(json, scene, fmt::format("body{}", scene.bodies.size()));
  spec.shape = readShape(json.at("shape", "For example {\"type\": \"sphere\", \"radius\": 0.02}."), scene.file);
  spec.dynamic = readDynamic(json, spec.shape);
  spec.mass = readMass(json, spec);
  if (const JsonValue* material = json.find("material")) spec.material = readMaterial(*material);
  engine::BodyStart start = readStart(json, spec);
  if (const JsonValue* trajectory = json.find("trajectory")) {
    spec.driven = true;
    scene.motions.push_back(readBodyTrajectory(*trajectory, start, readVector(json, "rotation", kRotation)));
  }
  scene.starts.push_back(start);
  scene.bodies.push_back(std::move(spec));
}

ScenePair readPair(const JsonValue& json, const Scene& scene) {
  json.allowOnly(keys::kPair);
  const JsonValue& names = json.at("bodies", "The names of two bodies.");
  if (names.array().size() != 2) names.reject("needs two names of bodies.");
  std::vector<std::string_view> known;
  for (const engine::BodySpec& body : scene.bodies) known.push_back(body.name);
  ScenePair pair;
  pair.a = static_cast<int>(names.array()[0].oneOf(known));
  pair.b = static_cast<int>(names.array()[1].oneOf(known));
  if (pair.a == pair.b) names.reject("names one body twice. A body doesn't touch itself.");
  if (const JsonValue* v = json.find("touch")) pair.touch = v->boolean();
  const JsonValue* material = json.find("material");
  if (!pair.touch && material) material->reject("doesn't go with two that never touch. Remove the key.");
  if (pair.touch && !material) json.reject("lacks the key \"material\", what the two are to each other (or \"touch\": false).");
  if (material) pair.material = readMaterial(*material);
  return pair;
}

}  // namespace pincer::tasks
