#include "pincer/tasks/lab/experiments/cylinder_alignment.h"

#include <fmt/format.h>

#include <cmath>
#include <numbers>

#include "pincer/engine/state.h"
#include "pincer/tasks/lab/experiments/shaded_objects.h"
#include "pincer/tasks/lab/experiments/study.h"
#include "pincer/tasks/lab/experiments/study_parameters.h"
#include "pincer/tasks/lab/participants/random.h"

namespace pincer::tasks {
namespace {

engine::WorldBuilder cylinderWorld(const CylinderAlignmentOptions& o, int& object) {
  engine::WorldBuilder builder{engine::WorldOptions{}};
  if (!o.pivot) builder.addBody({"table", contact::HalfSpace{}, false, 0, {o.table_friction, o.table_friction, 0, 0}});
  const contact::CylinderWithFlat shape{o.radius, 0.5 * o.length, flatDistance(o)};
  object = builder.addBody(
      {"cylinder", shape, true, o.mass, {o.friction, o.dynamic_ratio * o.friction, 0, o.torsion_radius}});
  if (o.pivot) {
    engine::JointModel joint;
    joint.a = object;
    joint.X_BJ.p = Vec3(0, 0, 0.5 * o.length);
    joint.damping = o.pivot_damping;
    builder.addJoint(joint);
  }
  return builder;
}

}  // namespace

double flatDistance(const CylinderAlignmentOptions& options) {
  return options.radius * math::cos(options.flat_half_angle);
}

void validate(const CylinderAlignmentOptions& o) {
  const RangeCheck check("cylinder-alignment", "cylinder_alignment");
  visitParameters(o, check);
  check("participants", o.participants, Parameter{"", {1, 1000, false, "The published study had 12."}});
  check("start_max", o.start_max,
        Parameter{"", {o.start_min, 3.1416, false, "It is in radians, at least start_min; 3.1416 is usual."}});
  requireNamed(o.conditions, "cylinder-alignment");
  for (const HandCondition& condition : o.conditions) {
    const CylinderAlignmentOptions changed = inCondition(o, condition);
    visitParameters(condition, RangeCheck("cylinder-alignment: condition " + condition.name, "conditions"));
    visitParameters(changed, RangeCheck("cylinder-alignment: condition " + condition.name, "conditions"));
  }
}

double wrapAngle(double angle) {
  const double turn = 2 * std::numbers::pi;
  const double wrapped = angle - turn * std::round(angle / turn);
  return wrapped <= -std::numbers::pi ? wrapped + turn : wrapped;
}

double flatAngle(const Pose& X_WB) {
  const Vec3 n_W = X_WB.q * Vec3::UnitX();
  return math::atan2(n_W.y(), n_W.x());
}

std::vector<double> startAngles(const CylinderAlignmentOptions& options, int count, std::uint64_t seed) {
  Random random(seed);
  std::vector<double> angles;
  for (int i = 0; i < count; ++i)
    angles.push_back((i % 2 == 0 ? 1 : -1) * random.uniform(options.start_min, options.start_max));
  for (std::size_t i = angles.size(); i > 1; --i) std::swap(angles[i - 1], angles[random.below(i)]);
  return angles;
}

HandScene makeCylinderScene(const CylinderAlignmentOptions& options, const CylinderTrialSpec& spec) {
  int object = 0;
  const engine::WorldBuilder world = cylinderWorld(options, object);
  const Vec3 middle_W(0, 0, 0.5 * options.length);
  engine::BodyStart start;
  start.X_WB = {quatFromRotationVector({0, 0, kTargetAngle + spec.start_angle}), middle_W};
  std::vector<engine::BodyStart> starts;
  if (!options.pivot) starts.emplace_back();
  starts.push_back(start);
  HandScene scene =
      makeHandScene(options.hand, world, starts, middle_W, options.radius, spec.condition.display_tactile);
  if (options.shading) {
    const auto felt = shadedCylinder(options.radius, 0.5 * options.length, flatDistance(options), *options.shading);
    grasp::feelAs(scene.model.grasp, object, contact::Mesh{felt});
  }
  scene.object = object;
  scene.cues.seed = spec.seed;
  scene.cues.mass = options.mass;
  scene.cues.flat_distance = flatDistance(options);
  scene.cues.target_angle = kTargetAngle;
  return scene;
}

}  // namespace pincer::tasks
