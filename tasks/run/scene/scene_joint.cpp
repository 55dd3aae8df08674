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

}  // namespace

engine::JointModel readJoint(const JsonValue& json, const SceneNames& names, const Scene& scene) {
  json.allowOnly(keys::kJoint);
  engine::JointModel joint;
  joint.kind =
      static_cast<engine::JointKind>(json.at("type", "What the joint leaves free: pivot, slider, ball or weld.").oneOf(keys::kJointTypes));
  const JsonValue& body = json.at("body", "The body that it holds.");
  joint.a = names.bodyNamed(body, scene);
  const auto start = [&](int i) { return scene.starts[static_cast<std::size_t>(i)].X_WB; };
  if (!scene.bodies[static_cast<std::size_t>(joint.a)].dynamic)
    body.reject("never moves by itself: a joint has nothing to hold. Name the moving body here, this one under \"to\".");
  Pose X_WJ{readAxis(json), start(joint.a).p};
  if (const JsonValue* v = json.find("point")) X_WJ.p = v->vector(ranges::kCoordinate);
  joint.X_AJ = start(joint.a).inverse() * X_WJ;
  joint.X_BJ = X_WJ;
  if (const JsonValue* v = json.find("to")) {
    joint.b = names.bodyNamed(*v, scene);
    if (joint.b == joint.a) v->reject("is the body itself. Name another, or leave the key out for the world.");
    joint.X_BJ = start(joint.b).inverse() * X_WJ;
  }
  if (const JsonValue* v = json.find("damping")) {
    joint.damping = v->number(ranges::kJointDamping);
    const bool has_axis = joint.kind == engine::JointKind::kPivot || joint.kind == engine::JointKind::kSlider;
    if (!has_axis) v->reject("doesn't go with this type: only pivots and sliders have a free axis to damp. Remove the key.");
  }
  return joint;
}

}  // namespace pincer::tasks
