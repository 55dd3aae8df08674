// Joints' ties and drives: couplings, tendons, drives.
#include <fmt/format.h>

#include <algorithm>

#include "pincer/tasks/run/scene/scene_keys.h"
#include "pincer/tasks/run/scene/scene_parts.h"

namespace pincer::tasks {
namespace {

// Numbers of a coupling's polynomial: as many as the engine's has.
constexpr std::size_t kMostCoefficients = std::tuple_size_v<decltype(engine::CouplingModel::polynomial)>;

// A joint that has one coordinate: a pivot or slider.
int readCoordinate(const JsonValue& json, const Scene& scene) {
  const int joint = SceneNames::jointNamed(json, scene);
  const engine::JointKind kind = scene.joints[static_cast<std::size_t>(joint)].kind;
  if (kind != engine::JointKind::kPivot && kind != engine::JointKind::kSlider)
    json.reject("is a ball or a weld: it has no single coordinate. Name a pivot or a slider.");
  return joint;
}

std::vector<engine::DriveTerm> readTerms(const JsonValue& json, const Scene& scene) {
  if (json.kind() != JsonValue::Kind::kObject || json.keys().empty())
    json.reject("must say by how much each joint counts: {\"left\": 0.5, \"right\": 0.5}.");
  std::vector<std::string_view> joints;
  for (const engine::JointModel& joint : scene.joints) joints.push_back(joint.name);
  json.allowOnly(joints);
  std::vector<engine::DriveTerm> terms;
  for (const std::string& name : json.keys()) {
    const auto joint = std::find(joints.begin(), joints.end(), name) - joints.begin();
    const engine::JointKind kind = scene.joints[static_cast<std::size_t>(joint)].kind;
    const JsonValue& share = json.at(name);
    if (kind != engine::JointKind::kPivot && kind != engine::JointKind::kSlider)
      share.reject("stands for a ball or a weld: it has no single coordinate. Name pivots and sliders only.");
    terms.push_back({static_cast<int>(joint), share.number(ranges::kTendonShare)});
  }
  return terms;
}

std::vector<engine::DriveTerm> readWhatItMoves(const JsonValue& json, const std::vector<SceneTendon>& tendons,
                                               const Scene& scene) {
  const JsonValue* const joint = json.find("joint");
  const JsonValue* const tendon = json.find("tendon");
  if ((joint != nullptr) == (tendon != nullptr))
    json.reject("needs either \"joint\" or \"tendon\": what the drive moves.");
  if (joint) return {{readCoordinate(*joint, scene), 1}};
  std::vector<std::string_view> known;
  for (const SceneTendon& t : tendons) known.push_back(t.name);
  return tendons[tendon->oneOf(known)].terms;
}

void readForceRange(const JsonValue& json, engine::DriveModel& drive) {
  if (json.array().size() != 2) json.reject("must be [least, largest], in N m on a pivot or N on a slider.");
  drive.lower_force = json.array()[0].number(ranges::kDriveForce);
  drive.upper_force = json.array()[1].number(ranges::kDriveForce);
  if (!(drive.lower_force < drive.upper_force)) json.reject("is no range: the first must be less than the second.");
}

void readControlRange(const JsonValue& json, engine::DriveModel& drive) {
  if (json.array().size() != 2) json.reject("must be [least, largest], as \"target\" is given.");
  drive.lower_control = json.array()[0].number(ranges::kDriveControl);
  drive.upper_control = json.array()[1].number(ranges::kDriveControl);
  if (!(drive.lower_control <= drive.upper_control)) json.reject("is no range: the first is more than the second.");
}

// Keys that each type takes besides its control.
void readLaw(const JsonValue& json, engine::DriveModel& drive) {
  using Control = engine::DriveModel::Control;
  const std::size_t type =
      json.at("type", "How it drives: position, velocity, motor or affine.").oneOf(keys::kDriveTypes);
  const bool is_position = type == 0, is_velocity = type == 1, is_affine = type == 3;
  drive.control = is_position ? Control::kPosition : is_velocity ? Control::kVelocity : Control::kForce;
  const auto take = [&](std::string_view key, bool goes, const NumberRule& rule, std::string_view otherwise,
                        double& out) {
    const JsonValue* const v = json.find(key);
    if (v && !goes) v->reject(otherwise);
    if (v) out = v->number(rule);
  };
  take("stiffness", is_position || is_affine, ranges::kJointStiffness,
       "goes with drives to a position and affine ones only. Remove the key.", drive.stiffness);
  take("damping", type != 2, ranges::kJointDamping, "doesn't go with a motor, which is a force: give it to the joint.",
       drive.damping);
  take("gain", !is_position && !is_velocity, ranges::kDriveGain,
       "goes with motors and affine drives only: force per unit of the control.", drive.gain);
  take("offset", is_affine, ranges::kDriveForce, "goes with affine drives only: a force that is always there.",
       drive.offset);
  if (is_position && !(drive.stiffness > 0))
    json.reject("needs \"stiffness\", above 0: how hard it pulls towards the position.");
  if (is_velocity && !(drive.damping > 0)) json.reject("needs \"damping\", above 0: force per rate that it is off by.");
}

Trajectory readControl(const JsonValue& json) {
  json.allowOnly(keys::kDriveTrajectory);
  std::vector<TimedPoint> points;
  for (const JsonValue& keyframe : json.at("keyframes", "What the drive is told at which time.").array()) {
    keyframe.allowOnly(keys::kDriveKeyframe);
    const JsonValue& time = keyframe.at("time", "In seconds.");
    const double value = keyframe.at("value", "A position, a rate or a force, as the drive's type has it.")
                             .number(ranges::kDriveControl);
    points.push_back({time.number(ranges::kTime), {value, 0, 0}, Vec3::Zero()});
    requireOnward(points, ranges::kDriveControl.max, time);
  }
  if (points.empty()) json.reject("has no keyframe. For a control that stays, use \"target\".");
  return Trajectory::throughKeyframes(std::move(points));
}

}  // namespace

engine::CouplingModel readCoupling(const JsonValue& json, const Scene& scene) {
  json.allowOnly(keys::kCoupling);
  engine::CouplingModel coupling;
  coupling.joint = readCoordinate(json.at("joint", "The joint that follows."), scene);
  const JsonValue& follows = json.at("follows", "The joint that it follows.");
  coupling.follows = readCoordinate(follows, scene);
  if (coupling.joint == coupling.follows) follows.reject("is the joint itself. Name another.");
  const JsonValue* const polynomial = json.find("polynomial");
  if (!polynomial) return coupling;
  const std::vector<JsonValue>& coefficients = polynomial->array();
  if (coefficients.size() < 2 || coefficients.size() > kMostCoefficients)
    polynomial->reject(fmt::format("must have 2 to {} numbers: c0 + c1 q + c2 q^2 + ..", kMostCoefficients));
  coupling.polynomial.fill(0);
  for (std::size_t k = 0; k < coefficients.size(); ++k)
    coupling.polynomial[k] = coefficients[k].number(ranges::kCoefficient);
  return coupling;
}

SceneTendon readTendon(const JsonValue& json, SceneNames& names, const Scene& scene) {
  json.allowOnly(keys::kTendon);
  json.at("name", "Drives go by it.");
  return {names.readNext(json, ""),
          readTerms(json.at("joints", "By how much each joint counts: {\"left\": 0.5, \"right\": 0.5}."), scene)};
}

SceneDrive readDrive(const JsonValue& json, const std::vector<SceneTendon>& tendons, SceneNames& names,
                     const Scene& scene) {
  json.allowOnly(keys::kDrive);
  SceneDrive drive;
  drive.model.name = names.readNext(json, fmt::format("drive{}", scene.drives.size()));
  drive.model.terms = readWhatItMoves(json, tendons, scene);
  readLaw(json, drive.model);
  if (const JsonValue* v = json.find("force")) readForceRange(*v, drive.model);
  if (const JsonValue* v = json.find("control")) readControlRange(*v, drive.model);
  const JsonValue* const target = json.find("target");
  const JsonValue* const trajectory = json.find("trajectory");
  if (target && trajectory) target->reject("says again what \"trajectory\" says. Keep one of the two.");
  if (trajectory || target) readDriveControl(trajectory ? *trajectory : *target, drive);
  return drive;
}

void readDriveControl(const JsonValue& json, SceneDrive& drive) {
  drive.moves = json.kind() == JsonValue::Kind::kObject;
  drive.control = drive.moves
                      ? readControl(json)
                      : Trajectory::throughKeyframes({{0, {json.number(ranges::kDriveControl), 0, 0}, Vec3::Zero()}});
}

void driveControls(const Scene& scene, double time, std::span<engine::DriveInput> controls) {
  for (std::size_t i = 0; i < controls.size(); ++i) {
    const TimedPoint at = scene.drives[i].control.at(time);
    controls[i] = {at.p_W.x(), at.v_W.x(), scene.drives[i].moves};
  }
}

}  // namespace pincer::tasks
