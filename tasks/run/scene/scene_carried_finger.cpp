// Fingers that a body carries: a tip on three sprung sliders.
#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <string>
#include <vector>

#include "pincer/contact/error.h"
#include "pincer/engine/model.h"
#include "pincer/tasks/run/scene/scene_keys.h"
#include "pincer/tasks/run/scene/scene_parts.h"

namespace pincer::tasks {
namespace {

constexpr double kLeastMass = 1e-9;  // of what has no mass of its own [kg]

// The keys of fingers that a hand moves.
void refuseKeysOfHands(const JsonValue& json) {
  for (const std::string_view key : {"method", "force", "trajectory", "arm"})
    refuse(json, key, "doesn't go with \"on\": the body moves the finger, no hand does. Remove one of the two.");
  for (const std::string_view key : {"patch_radius", "modulus", "effective_radius"})
    refuse(json, key, "doesn't go with \"on\": the pad of a carried finger is its material's \"torsion_radius\".");
  for (const std::string_view key : {"twist_stiffness", "twist_damping", "turn_stiffness", "turn_damping"})
    refuse(json, key, "doesn't go with \"on\": a carried finger turns with its body. Hold its body by a pivot.");
  refuse(json, "taxels", "doesn't go with \"on\". Take the forces of the two bodies, \"object|finger.f_x\".");
}

// The tip, its frame that of the finger.
engine::ColliderSpec readTipOnBody(const JsonValue& json, const std::string& file) {
  const JsonValue *shape = json.find("shape"), *radius = json.find("radius");
  if (shape && radius) radius->reject("says again how large the tip is, which \"shape\" does. Keep one of the two.");
  engine::ColliderSpec tip;
  tip.name = "tip";
  tip.shape = contact::Sphere{radius ? radius->number(ranges::kTipLength) : grasp::FingerModel{}.radius};
  if (!shape) return tip;
  const contact::FingerShape read = readFingerShape(*shape, file);
  if (const auto* sphere = std::get_if<contact::Sphere>(&read)) {
    tip.shape = *sphere;
  } else if (const auto* capsule = std::get_if<contact::CapsuleTip>(&read)) {
    const double half = capsule->half_F.norm();
    tip.shape = contact::Capsule{capsule->radius, half};
    tip.X_BS.q = Quat(frameFromNormal(capsule->half_F / half)).normalized();
  } else {
    shape->reject(
        "can't be carried: a finger on a body ends in a sphere or capsule. For others take a body on sliders.");
  }
  return tip;
}

// One number for all axes of the finger, or [x, y, z].
Vec3 readAlongAxes(const JsonValue& json, std::string_view key, const NumberRule& rule, const Vec3& usual) {
  const JsonValue* v = json.find(key);
  if (!v) return usual;
  if (v->kind() == JsonValue::Kind::kArray) return v->vector(rule);
  if (v->kind() == JsonValue::Kind::kObject)
    v->reject(
        "is along the contact's directions, but that of a carried finger is along its own axes: one number, or "
        "[x, y, z].");
  return Vec3::Constant(v->number(rule));
}

// Where the tip's springs are, and how stiff.
struct Mounting {
  Vec3 stiffness, damping;
  std::array<bool, 3> locked{};
};

Mounting readMounting(const JsonValue& json) {
  const engine::DrivenPointModel usual;
  Mounting mounting;
  mounting.stiffness = readAlongAxes(json, "stiffness", ranges::kStiffness, usual.stiffness);
  mounting.damping = readAlongAxes(json, "damping", ranges::kDamping, usual.damping);
  const JsonValue* locked = json.find("locked");
  if (locked) {
    for (const JsonValue& axis : locked->array()) mounting.locked[axis.oneOf(keys::kAxes)] = true;
  }
  if (mounting.locked == std::array{true, true, true})
    locked->reject(
        "leaves nothing to give way: such a tip is a part of the body. Give that another of its \"shapes\".");
  for (std::size_t axis = 0; axis < keys::kAxes.size(); ++axis) {
    if (!mounting.locked[axis] && !(mounting.stiffness[static_cast<Eigen::Index>(axis)] > 0))
      json.reject(fmt::format("has no stiffness along {}: nothing holds it there. Give it one, or lock the axis.",
                              keys::kAxes[axis]));
  }
  return mounting;
}

// A body at the finger's frame, which moves with what carries it.
int addBodyThere(engine::BodySpec spec, const JsonValue& json, const engine::BodyStart& start, SceneNames& names,
                 Scene& scene) {
  names.takeBody(spec.name, json, scene);
  scene.bodies.push_back(std::move(spec));
  scene.starts.push_back(start);
  scene.body_lines.push_back(json.line());
  return static_cast<int>(scene.bodies.size()) - 1;
}

// A body that a slider carries to the next slider: seen only.
engine::BodySpec bodyBetween(const std::string& name) {
  engine::BodySpec spec;
  spec.name = name;
  spec.shape = contact::Sphere{1e-3};
  spec.mass = kLeastMass;
  spec.shapes = {{.name = "dot", .shape = spec.shape, .X_BS = {}, .bits = {0, 0}}};
  return spec;
}

engine::JointModel sliderAlong(int axis, int body, int carrier, const Pose& X_CF) {
  const Pose X_FJ{Quat(frameFromNormal(Vec3::Unit(axis))).normalized(), Vec3::Zero()};
  engine::JointModel joint;
  joint.kind = engine::JointKind::kSlider;
  joint.a = body;
  joint.b = carrier;
  joint.X_AJ = X_FJ;
  joint.X_BJ = X_CF * X_FJ;
  return joint;
}

engine::BodySpec readTipBody(const JsonValue& json, const std::string& name, const std::string& file) {
  engine::BodySpec tip;
  tip.name = name;
  tip.shapes = {readTipOnBody(json, file)};
  const JsonValue* mass = json.find("mass");
  tip.mass = std::max(kLeastMass, mass ? mass->number(ranges::kProxyMass) : 0);
  if (const JsonValue* v = json.find("material")) tip.material = readMaterial(*v);
  return tip;
}

// The sliders from the carrier to the tip, along the axes that aren't locked. Returns the tip.
int addSliders(const JsonValue& json, const engine::BodySpec& tip, int carrier, const Pose& X_CF, SceneNames& names,
               Scene& scene) {
  const Mounting mounting = readMounting(json);
  const JsonValue* name = json.find("name");
  const JsonValue& place = name ? *name : json;
  engine::BodyStart start = scene.starts[static_cast<std::size_t>(carrier)];
  start.X_WB = start.X_WB * X_CF;
  auto left = std::count(mounting.locked.begin(), mounting.locked.end(), false);
  int last = carrier;
  for (int axis = 0; axis < 3; ++axis) {
    if (mounting.locked[static_cast<std::size_t>(axis)]) continue;
    const std::string slide = fmt::format("{}_{}", tip.name, keys::kAxes[static_cast<std::size_t>(axis)]);
    const int body = addBodyThere(--left > 0 ? bodyBetween(slide + "_carried") : tip, place, start, names, scene);
    engine::JointModel joint = sliderAlong(axis, body, last, last == carrier ? X_CF : Pose{});
    joint.name = slide;
    joint.damping = mounting.damping[axis];
    joint.traits.stiffness = mounting.stiffness[axis];
    names.take(joint.name, place);
    scene.joints.push_back(joint);
    scene.joint_lines.push_back(json.line());
    last = body;
  }
  return last;
}

// True if joints lead from the body to the world, or to what stands still or is driven.
bool hangsOnTheWorld(const Scene& scene, int body) {
  std::vector<bool> reached(scene.bodies.size());
  std::vector<int> left = {body};
  while (!left.empty()) {
    const int at = left.back();
    left.pop_back();
    if (at < 0 || !scene.bodies[static_cast<std::size_t>(at)].dynamic) return true;
    if (reached[static_cast<std::size_t>(at)]) continue;
    reached[static_cast<std::size_t>(at)] = true;
    for (const engine::JointModel& joint : scene.joints) {
      if (joint.a == at) left.push_back(joint.b);
      if (joint.b == at) left.push_back(joint.a);
    }
  }
  return false;
}

// In the body's frame. Of one that can't be built zero: it is refused when the world is, by its line.
Vec3 centerOfMass(const engine::BodySpec& spec, const engine::WorldOptions& options) {
  try {
    engine::WorldBuilder alone(options);
    alone.addBody(spec);
    return alone.build().bodies[0].X_BI.p;
  } catch (const InputError&) {
    return Vec3::Zero();
  }
}

// Springs need a tree that hangs on the world: three sliders and a ball joint at its centre of mass leave a free body
// as free as it was.
void holdFreely(const JsonValue& json, int body, SceneNames& names, Scene& scene) {
  const std::string name = scene.bodies[static_cast<std::size_t>(body)].name;
  const engine::BodyStart start = scene.starts[static_cast<std::size_t>(body)];
  const Vec3 center_B = centerOfMass(scene.bodies[static_cast<std::size_t>(body)], scene.options);
  engine::BodyStart moved{{Quat::Identity(), start.X_WB * center_B}, Vec3::Zero(), Vec3::Zero()};
  const Pose X_WF = moved.X_WB;
  const auto add = [&](engine::JointModel joint, const std::string& joint_name) {
    joint.name = joint_name;
    names.take(joint.name, json);
    scene.joints.push_back(joint);
    scene.joint_lines.push_back(json.line());
  };
  int last = -1;
  for (int axis = 0; axis < 3; ++axis) {
    const std::string slide = fmt::format("{}_{}", name, keys::kAxes[static_cast<std::size_t>(axis)]);
    moved.v_W[axis] = start.v_W[axis];
    const int between = addBodyThere(bodyBetween(slide + "_carried"), json, moved, names, scene);
    add(sliderAlong(axis, between, last, last < 0 ? X_WF : Pose{}), slide);
    last = between;
  }
  engine::JointModel ball;
  ball.kind = engine::JointKind::kBall;
  ball.a = body;
  ball.b = last;
  ball.X_AJ.p = center_B;
  add(ball, name + "_turn");
}

}  // namespace

void addCarriedFinger(const JsonValue& json, const std::string& usual_name, SceneNames& names, Scene& scene) {
  json.allowOnly(keys::kFinger);
  refuseKeysOfHands(json);
  const int carrier = names.bodyNamed(json.at("on", "The body that carries it."), scene);
  json.at("position", "Where the tip is in the frame of the body that carries it [m].");
  const Pose X_CF{quatFromRotationVector(readVector(json, "rotation", ranges::kRotation)),
                  readVector(json, "position", ranges::kCoordinate)};
  const JsonValue* name = json.find("name");
  const engine::BodySpec tip = readTipBody(json, name ? name->text() : usual_name, scene.file);
  if (!hangsOnTheWorld(scene, carrier)) holdFreely(json, carrier, names, scene);
  const int body = addSliders(json, tip, carrier, X_CF, names, scene);
  scene.pairs.push_back({carrier, body, false, {}});
  scene.pair_lines.push_back(json.line());
}

}  // namespace pincer::tasks
