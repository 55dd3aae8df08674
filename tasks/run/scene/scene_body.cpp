#include <fmt/format.h>

#include <algorithm>

#include "pincer/contact/smooth_mesh.h"
#include "pincer/engine/motion/mass.h"
#include "pincer/tasks/run/scene/scene_keys.h"
#include "pincer/tasks/run/scene/scene_parts.h"

namespace pincer::tasks {

engine::Material readMaterial(const JsonValue& json) {
  json.allowOnly(keys::kMaterial);
  engine::Material material;
  if (const JsonValue* v = json.find("mu_s")) material.mu_s = v->number(ranges::kFriction);
  material.mu_d = material.mu_s;
  if (const JsonValue* v = json.find("mu_d")) {
    material.mu_d = v->number(
        {.min = 0, .max = material.mu_s, .remedy = "Dynamic friction isn't larger than static friction (mu_s)."});
  }
  if (const JsonValue* v = json.find("restitution")) material.restitution = v->number(ranges::kRestitution);
  if (const JsonValue* v = json.find("torsion_radius")) material.torsion_radius = v->number(ranges::kTorsionRadius);
  if (const JsonValue* v = json.find("rolling_radius")) material.rolling_radius = v->number(ranges::kRollingRadius);
  if (const JsonValue* v = json.find("stribeck_speed")) {
    material.stribeck_speed = v->number(ranges::kStribeckSpeed);
  }
  return material;
}

bool isSupport(const contact::Shape& shape) {
  return std::holds_alternative<contact::HalfSpace>(shape) || std::holds_alternative<contact::Dish>(shape);
}

void refuse(const JsonValue& json, std::string_view key, std::string_view because) {
  if (const JsonValue* value = json.find(key)) value->reject(because);
}

Vec3 readVector(const JsonValue& json, std::string_view key, const NumberRule& rule) {
  const JsonValue* value = json.find(key);
  return value ? value->vector(rule) : Vec3::Zero();
}

std::optional<double> readWeight(const JsonValue& json, const std::function<double()>& volume) {
  const JsonValue* mass = json.find("mass");
  const JsonValue* density = json.find("density");
  if (mass && density) density->reject("says again what \"mass\" says. Keep one of the two.");
  if (mass) return mass->number(ranges::kMass);
  if (!density) return std::nullopt;
  const double rho = density->number(ranges::kDensity);
  const double weighed = [&] {
    try {
      return rho * volume();
    } catch (const InputError& error) {
      density->reject(fmt::format("can't be used: {}", error.what()));
    }
  }();
  if (!isWithin(weighed, ranges::kMass))
    density->reject(fmt::format("makes a mass of {:g} kg, which {}", weighed, outOfRange(ranges::kMass)));
  return weighed;
}

namespace {

bool hasSupport(const engine::BodySpec& spec) {
  if (spec.shapes.empty()) return isSupport(spec.shape);
  return std::any_of(spec.shapes.begin(), spec.shapes.end(),
                     [](const engine::ColliderSpec& part) { return isSupport(part.shape); });
}

bool readDynamic(const JsonValue& json, bool has_support) {
  const JsonValue* fixed = json.find("static");
  if (const JsonValue* v = json.find("trajectory")) {
    if (has_support) v->reject("doesn't go with this shape: half-spaces and dishes never move. Use a box.");
    if (fixed) fixed->reject("doesn't go with a trajectory: one of the two says how the body moves. Remove one.");
    return false;
  }
  if (!has_support) return !(fixed && fixed->boolean());
  if (fixed && !fixed->boolean())
    fixed->reject("doesn't go with this shape: half-spaces and dishes never move. Remove the key.");
  return false;
}

void refuseWeight(const JsonValue& json, bool driven) {
  const std::string_view because =
      driven ? "doesn't go with a trajectory, which the body follows whatever touches it. Remove the key."
             : "doesn't go with a body that never moves. Remove the key.";
  for (const std::string_view key : {"mass", "density", "inertia"}) refuse(json, key, because);
  const JsonValue* shapes = json.find("shapes");
  if (!shapes) return;
  for (const JsonValue& part : shapes->array()) {
    for (const std::string_view key : {"mass", "density"}) refuse(part, key, because);
  }
}

// Of several shapes, a density is that of those without a mass of their own.
double readMass(const JsonValue& json, const engine::BodySpec& spec) {
  if (!spec.dynamic) {
    refuseWeight(json, json.find("trajectory") != nullptr);
    return 0;
  }
  double given = 0;
  const auto volume = [&] {
    if (spec.shapes.empty()) return engine::volumeOf(spec.shape);
    double sum = 0;
    for (const engine::ColliderSpec& part : spec.shapes) sum += part.mass > 0 ? 0 : engine::volumeOf(part.shape);
    return sum;
  };
  for (const engine::ColliderSpec& part : spec.shapes) given += part.mass;
  const std::optional<double> weight = readWeight(json, volume);
  const bool has_each = !spec.shapes.empty() && std::all_of(spec.shapes.begin(), spec.shapes.end(),
                                                            [](const auto& part) { return part.mass > 0; });
  if (!weight && !has_each) json.reject("lacks the key \"mass\" [kg] (or \"density\" [kg/m^3], or \"static\": true).");
  return !weight ? given : json.find("density") ? given + *weight : *weight;
}

void readShapes(const JsonValue& json, const std::string& file, SceneHulls& hulls, engine::BodySpec& spec) {
  const JsonValue* shapes = json.find("shapes");
  if (!shapes) {
    spec.shape = readShape(json.at("shape", "For example {\"type\": \"sphere\", \"radius\": 0.02}."), file, hulls);
    return;
  }
  refuse(json, "shape", "doesn't go with \"shapes\". Keep one of the two.");
  spec.shapes = readParts(*shapes, file, hulls);
}

engine::BodyStart readStart(const JsonValue& json, const engine::BodySpec& spec) {
  engine::BodyStart start;
  if (spec.shapes.empty() && std::holds_alternative<contact::HalfSpace>(spec.shape)) {
    for (const std::string_view key : {"position", "rotation"})
      refuse(json, key, "doesn't go with a half-space: its shape has \"point\" and \"normal\".");
    start.X_WB = readHalfSpacePose(json.at("shape"));
  } else {
    start.X_WB.p = readVector(json, "position", ranges::kCoordinate);
    start.X_WB.q = quatFromRotationVector(readVector(json, "rotation", ranges::kRotation));
  }
  if (!spec.dynamic) {
    for (const std::string_view key : {"velocity", "angular_velocity"})
      refuse(json, key, "doesn't go with a body that never moves. Remove the key.");
  }
  start.v_W = readVector(json, "velocity", ranges::kVelocity);
  start.w_W = readVector(json, "angular_velocity", ranges::kSpin);
  return start;
}

}  // namespace

void readBody(const JsonValue& json, SceneNames& names, SceneHulls& hulls, Scene& scene) {
  json.allowOnly(keys::kBody);
  engine::BodySpec spec;
  spec.name = names.readNextBody(json, scene);
  readShapes(json, scene.file, hulls, spec);
  spec.dynamic = readDynamic(json, hasSupport(spec));
  spec.mass = readMass(json, spec);
  if (const JsonValue* inertia = json.find("inertia")) spec.inertia = readInertia(*inertia);
  if (const JsonValue* material = json.find("material")) spec.material = readMaterial(*material);
  engine::BodyStart start = readStart(json, spec);
  if (const JsonValue* trajectory = json.find("trajectory")) {
    spec.driven = true;
    scene.motions.push_back(readBodyTrajectory(*trajectory, start, readVector(json, "rotation", ranges::kRotation)));
  }
  scene.starts.push_back(start);
  scene.bodies.push_back(std::move(spec));
}

ScenePair readPair(const JsonValue& json, const SceneNames& names, const Scene& scene) {
  json.allowOnly(keys::kPair);
  const JsonValue& two = json.at("bodies", "The names of two bodies.");
  if (two.array().size() != 2) two.reject("needs two names of bodies.");
  ScenePair pair;
  pair.a = names.bodyNamed(two.array()[0], scene);
  pair.b = names.bodyNamed(two.array()[1], scene);
  if (pair.a == pair.b) two.reject("names one body twice. A body doesn't touch itself.");
  if (const JsonValue* v = json.find("touch")) pair.touch = v->boolean();
  const JsonValue* material = json.find("material");
  if (!pair.touch && material) material->reject("doesn't go with two that never touch. Remove the key.");
  if (pair.touch && !material)
    json.reject("lacks the key \"material\", what the two are to each other (or \"touch\": false).");
  if (material) pair.material = readMaterial(*material);
  return pair;
}

}  // namespace pincer::tasks
