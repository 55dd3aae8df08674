// actuator: drives of joints and fixed tendons.
//
//   force = gear (gain u + bias_0 + bias_1 l + bias_2 l'),   l = gear times the coordinate
//
// motor: gain 1. position: gain kp, bias_1 = -kp, bias_2 = -kv. velocity: gain kv, bias_2 = -kv. A class has one
// default for all of them: each element of it, then the actuator itself, changes what those before it have made.
#include <fmt/format.h>

#include <cmath>

#include "pincer/tasks/run/files/spelling.h"
#include "pincer/tasks/run/robot/mjcf_parts.h"

namespace pincer::tasks::mjcf {
namespace {

// An actuator as far as its defaults and itself have said.
struct Draft {
  RobotDrive drive;
  bool has_bias = false;  // biastype is affine
  double inherit_range = 0;
};

void readGeneral(const Values& values, Draft& draft) {
  // Types of actuator that drives here can be; oneOf rejects all others.
  constexpr std::string_view kGains[] = {"fixed"}, kBiases[] = {"none", "affine"}, kDynamics[] = {"none"};
  values.oneOf("gaintype", kGains, 0);
  values.oneOf("dyntype", kDynamics, 0);
  draft.has_bias = values.oneOf("biastype", kBiases, draft.has_bias) == 1;
  const std::vector<double> gain = values.numbers("gainprm", 0, 10), bias = values.numbers("biasprm", 0, 10);
  if (!gain.empty()) draft.drive.gain = gain[0];
  for (std::size_t i = 0; i < bias.size() && i < 3; ++i) draft.drive.bias[static_cast<Eigen::Index>(i)] = bias[i];
}

double notNegative(const Values& values, std::string_view name, double fallback) {
  const double value = values.number(name, fallback);
  if (!(value >= 0)) values.reject(name, "is negative.");
  return value;
}

void readPosition(const Values& values, Draft& draft) {
  RobotDrive& drive = draft.drive;
  drive.gain = notNegative(values, "kp", drive.gain);
  drive.bias[1] = -drive.gain;
  if (values.has("kv") && values.has("dampratio")) values.element().reject("has kv and dampratio. Keep one of them.");
  if (values.has("kv")) {
    drive.bias[2] = -notNegative(values, "kv", 0);
    drive.damping_ratio = 0;
  }
  if (values.has("dampratio")) drive.damping_ratio = notNegative(values, "dampratio", 0);
  draft.inherit_range = notNegative(values, "inheritrange", draft.inherit_range);
  draft.has_bias = true;
}

void readVelocity(const Values& values, Draft& draft) {
  RobotDrive& drive = draft.drive;
  drive.gain = notNegative(values, "kv", drive.gain);
  drive.bias = Vec3(0, 0, -drive.gain);
  drive.damping_ratio = 0;
  draft.has_bias = true;
}

void readMotor(Draft& draft) {
  draft.drive.gain = 1;
  draft.drive.bias.setZero();
  draft.drive.damping_ratio = 0;
  draft.has_bias = false;
}

void readKind(const XmlElement& element, Draft& draft) {
  const Values values(element);
  if (element.tag == "general") readGeneral(values, draft);
  if (element.tag == "position") readPosition(values, draft);
  if (element.tag == "velocity") readVelocity(values, draft);
  if (element.tag == "motor") readMotor(draft);
  const std::vector<double> gear = values.numbers("gear", 1, 6);
  for (std::size_t i = 1; i < gear.size(); ++i) {
    if (gear[i] != 0) values.reject("gear", "acts along more than one axis. Joints and tendons have one.");
  }
  if (!gear.empty()) draft.drive.gear = gear[0];
}

// The elements that an actuator is made of: its class's, from the outermost on, and itself.
std::vector<const XmlElement*> layersOf(const Reading& reading, const XmlElement& element) {
  std::vector<const XmlElement*> layers = {&element};
  const std::string* name = element.find("class");
  const auto& classes = reading.document.classes;
  for (int c = name ? classNamed(reading.document, *name, element) : 0; c >= 0;
       c = classes[static_cast<std::size_t>(c)].parent) {
    const auto defaults = classes[static_cast<std::size_t>(c)].elements.find("actuator");
    if (defaults == classes[static_cast<std::size_t>(c)].elements.end()) continue;
    for (auto e = defaults->second.rbegin(); e != defaults->second.rend(); ++e) layers.push_back(&*e);
  }
  return {layers.rbegin(), layers.rend()};
}

std::string tendonNamed(const Reading& reading, const Values& values) {
  const std::string name = values.required("tendon");
  std::vector<std::string_view> names;
  for (const RobotTendon& tendon : reading.robot.tendons) {
    if (tendon.name == name) return name;
    names.push_back(tendon.name);
  }
  values.reject("tendon", fmt::format("is the name of no fixed tendon.{}", suggestion(name, names)));
}

void connect(const Reading& reading, const Values& values, RobotDrive& drive) {
  if (values.has("joint") == values.has("tendon"))
    values.element().reject("needs either a joint or a tendon to drive.");
  if (values.has("tendon")) {
    drive.tendon = tendonNamed(reading, values);
    return;
  }
  const RobotJoint& joint = jointNamed(reading, values, "joint");
  if (joint.kind != RobotJointKind::kHinge && joint.kind != RobotJointKind::kSlide)
    values.reject("joint", "is neither hinge nor slide: drives have one axis here.");
  drive.joint = joint.name;
}

// About the middle of the joint's range, so many times as wide.
Vec2 inheritedRange(const Reading& reading, const Values& values, const Draft& draft) {
  const auto at = reading.joints.find(draft.drive.joint);
  if (at == reading.joints.end() || !at->second->limits)
    values.reject("inheritrange", "needs a joint that has limits.");
  const Vec2 ends = *at->second->limits;
  const double middle = 0.5 * ends.sum(), half = 0.5 * draft.inherit_range * (ends[1] - ends[0]);
  return {middle - half, middle + half};
}

RobotDrive readDrive(const Reading& reading, const XmlElement& element) {
  Draft draft;
  for (const XmlElement* layer : layersOf(reading, element)) readKind(*layer, draft);
  const Values values(reading.document, element, "actuator", 0);
  RobotDrive& drive = draft.drive;
  drive.place = element.place();
  drive.name =
      values.element().find("name") ? values.text("name") : fmt::format("drive{}", reading.robot.drives.size());
  connect(reading, values, drive);
  if (!draft.has_bias) drive.bias.setZero();
  if (draft.inherit_range > 0 && values.range("ctrlrange").value_or(Vec2::Zero()) != Vec2::Zero())
    values.reject("ctrlrange", "stands beside an inheritrange, its own or its class'. Keep one of the two.");
  drive.controls = values.limits("ctrlrange", "ctrllimited", reading.compiler().autolimits);
  if (!drive.controls && draft.inherit_range > 0) drive.controls = inheritedRange(reading, values, draft);
  drive.forces = values.limits("forcerange", "forcelimited", reading.compiler().autolimits);
  return drive;
}

}  // namespace

void readActuators(Reading& reading) {
  for (const XmlElement* section : sections(reading.document, "actuator")) {
    for (const XmlElement& element : section->children) reading.robot.drives.push_back(readDrive(reading, element));
  }
}

}  // namespace pincer::tasks::mjcf
