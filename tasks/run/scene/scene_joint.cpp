// Joints between two bodies, or a body and the world.
#include <fmt/format.h>

#include "pincer/tasks/run/scene/scene_keys.h"
#include "pincer/tasks/run/scene/scene_parts.h"

namespace pincer::tasks {
namespace {

Quat readAxis(const JsonValue& json) {
  const JsonValue* axis = json.find("axis");
  if (!axis) return Quat::Identity();
  const Vec3 n = axis->vector(ranges::kDirection);
  if (!(n.norm() > ranges::kShortestDirection)) axis->reject("has no length, so no direction. For example [0, 0, 1].");
  return Quat(frameFromNormal(n.normalized())).normalized();
}

bool hasAxis(const engine::JointModel& joint) {
  return joint.kind == engine::JointKind::kPivot || joint.kind == engine::JointKind::kSlider;
}

// A stop's place; null: there is none on that side.
double readLimit(const JsonValue& json, double none) {
  return json.kind() == JsonValue::Kind::kNull ? none : json.number(ranges::kJointPosition);
}

void readLimits(const JsonValue& json, engine::JointTraits& traits) {
  if (json.array().size() != 2)
    json.reject("must be [lower, upper], radians of a pivot or metres of a slider; null where there is no stop.");
  traits.lower = readLimit(json.array()[0], traits.lower);
  traits.upper = readLimit(json.array()[1], traits.upper);
  if (!(traits.lower < traits.upper))
    json.reject("leaves no way: the first must be less than the second. To hold it, make it a weld.");
}

// Forces along the free axis.
void readTraits(const JsonValue& json, engine::JointModel& joint) {
  const auto along = [&](std::string_view key, const NumberRule& rule, double& out) {
    const JsonValue* const v = json.find(key);
    if (!v) return;
    out = v->number(rule);
    if (!hasAxis(joint))
      v->reject("doesn't go with this type: only pivots and sliders have one free axis. Remove the key.");
  };
  along("damping", ranges::kJointDamping, joint.damping);
  along("restitution", ranges::kRestitution, joint.traits.restitution);
  along("stiffness", ranges::kJointStiffness, joint.traits.stiffness);
  along("rest", ranges::kJointPosition, joint.traits.rest);
  along("friction", ranges::kJointFriction, joint.traits.friction);
  along("start", ranges::kJointPosition, joint.traits.start);
  if (const JsonValue* v = json.find("armature")) {
    joint.traits.armature = v->number(ranges::kArmature);
    if (joint.kind == engine::JointKind::kWeld) v->reject("doesn't go with a weld: nothing moves. Remove the key.");
  }
  const JsonValue* const limits = json.find("limits");
  if (limits) {
    if (!hasAxis(joint))
      limits->reject("doesn't go with this type: only pivots and sliders have stops. Remove the key.");
    readLimits(*limits, joint.traits);
  }
  const JsonValue* const start = json.find("start");
  if (joint.traits.start < joint.traits.lower || joint.traits.start > joint.traits.upper)
    (start ? start : limits)
        ->reject(
            fmt::format("is beyond a stop: the joint starts at {:g}. The bodies' positions are those at \"start\".",
                        joint.traits.start));
}

// By how much a's side of the joint is ahead of b's at the start.
Pose wayAtStart(const engine::JointModel& joint) {
  if (joint.kind == engine::JointKind::kPivot)
    return {quatFromRotationVector({0, 0, joint.traits.start}), Vec3::Zero()};
  return {Quat::Identity(), {0, 0, joint.traits.start}};
}

}  // namespace

engine::JointModel readJoint(const JsonValue& json, SceneNames& names, const Scene& scene) {
  json.allowOnly(keys::kJoint);
  engine::JointModel joint;
  joint.name = names.readNext(json, fmt::format("joint{}", scene.joints.size()));
  joint.kind = static_cast<engine::JointKind>(
      json.at("type", "What the joint leaves free: pivot, slider, ball or weld.").oneOf(keys::kJointTypes));
  const JsonValue& body = json.at("body", "The body that it holds.");
  joint.a = names.bodyNamed(body, scene);
  const auto start = [&](int i) { return scene.starts[static_cast<std::size_t>(i)].X_WB; };
  if (!scene.bodies[static_cast<std::size_t>(joint.a)].dynamic)
    body.reject(
        "never moves by itself: a joint has nothing to hold. Name the moving body here, this one under \"to\".");
  readTraits(json, joint);
  Pose X_WJ{readAxis(json), start(joint.a).p};
  if (const JsonValue* v = json.find("point")) X_WJ.p = v->vector(ranges::kCoordinate);
  joint.X_AJ = start(joint.a).inverse() * X_WJ;
  if (joint.traits.start != 0) X_WJ = X_WJ * wayAtStart(joint).inverse();
  joint.X_BJ = X_WJ;
  if (const JsonValue* v = json.find("to")) {
    joint.b = names.bodyNamed(*v, scene);
    if (joint.b == joint.a) v->reject("is the body itself. Name another, or leave the key out for the world.");
    joint.X_BJ = start(joint.b).inverse() * X_WJ;
  }
  return joint;
}

BodyFrame readFrame(const JsonValue& json, SceneNames& names, const Scene& scene) {
  json.allowOnly(keys::kFrame);
  BodyFrame frame;
  frame.name = names.readNext(json, fmt::format("frame{}", scene.frames.size()));
  frame.body = names.bodyNamed(json.at("body", "The body that carries it."), scene);
  frame.X_BF = {quatFromRotationVector(readVector(json, "rotation", ranges::kRotation)),
                readVector(json, "position", ranges::kCoordinate)};
  return frame;
}

}  // namespace pincer::tasks
