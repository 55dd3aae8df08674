// contact, tendon, equality, keyframe: what ties the bodies of the tree
// together, keeps them apart, and where they start.
#include <fmt/format.h>

#include <algorithm>

#include "pincer/tasks/run/files/spelling.h"
#include "pincer/tasks/run/robot/mjcf_parts.h"

namespace pincer::tasks::mjcf {
namespace {

template <class Act>
void forEach(const Reading& reading, std::string_view section, Act act) {
  for (const XmlElement* element : sections(reading.document, section)) {
    for (const XmlElement& child : element->children) act(child);
  }
}

bool isActive(const Reading& reading, const XmlElement& element) {
  return Values(reading.document, element, "default_equality", 0).boolean("active", true);
}

void readContact(Reading& reading, const XmlElement& element) {
  if (element.tag == "pair") return readPair(reading, element);
  const Values values(element);
  reading.robot.excluded.push_back(
      {bodyNamed(reading, values, "body1"), bodyNamed(reading, values, "body2"), element.place()});
}

// A hinge or slide: couplings and tendons go by one coordinate.
const RobotJoint& axisNamed(const Reading& reading, const Values& values, std::string_view attribute) {
  const RobotJoint& joint = jointNamed(reading, values, attribute);
  if (joint.kind != RobotJointKind::kHinge && joint.kind != RobotJointKind::kSlide)
    values.reject(attribute, "is neither hinge nor slide, so it has no single coordinate. Name one that has.");
  return joint;
}

// A joint that stands there twice counts with the sum.
void addToTendon(const std::string& joint, double coefficient, RobotTendon& tendon) {
  for (auto& [name, sum] : tendon.joints) {
    if (name == joint) {
      sum += coefficient;
      return;
    }
  }
  tendon.joints.emplace_back(joint, coefficient);
}

void readTendon(Reading& reading, const XmlElement& element) {
  const Values values(reading.document, element, "default_tendon", 0);
  RobotTendon tendon;
  tendon.place = element.place();
  tendon.name = values.text("name", fmt::format("tendon{}", reading.robot.tendons.size()));
  for (const XmlElement& child : element.children) {
    const Values part(child);
    addToTendon(axisNamed(reading, part, "joint").name, part.number("coef", 0), tendon);
  }
  if (tendon.joints.empty()) element.reject("runs over no joint.");
  tendon.limits = values.limits("range", "limited", reading.compiler().autolimits);
  tendon.stiffness = values.number("stiffness", 0);
  tendon.damping = values.number("damping", 0);
  if (!(tendon.stiffness >= 0 && tendon.damping >= 0))
    element.reject("has a negative spring or damper. A spring pulls back, a damper brakes.");
  tendon.friction = values.number("frictionloss", 0);
  const std::vector<double> rest = values.numbers("springlength", 1, 2);
  if (!rest.empty() && rest[0] >= 0) tendon.rest = Vec2(rest[0], rest.back());
  reading.robot.tendons.push_back(std::move(tendon));
}

void readCoupling(Reading& reading, const XmlElement& element) {
  const Values values(element);
  RobotCoupling coupling;
  coupling.place = element.place();
  coupling.follower = axisNamed(reading, values, "joint1").name;
  if (values.has("joint2")) coupling.leader = axisNamed(reading, values, "joint2").name;
  if (coupling.leader == coupling.follower)
    values.reject("joint2", "is the joint itself. Name the one that it follows.");
  const std::vector<double> given = values.numbers("polycoef", 1, 5);
  coupling.polynomial = {0, 1, 0, 0, 0};
  for (std::size_t i = 0; i < given.size(); ++i) coupling.polynomial[i] = given[i];
  reading.robot.couplings.push_back(std::move(coupling));
}

// A site's body and place, for loops that are given by sites.
const RobotFrame& siteNamed(const Reading& reading, const Values& values, std::string_view attribute) {
  const std::string name = values.required(attribute);
  std::vector<std::string_view> names;
  for (const RobotFrame& frame : reading.robot.frames) {
    if (frame.name == name) return frame;
    names.push_back(frame.name);
  }
  values.reject(attribute, fmt::format("is the name of no site.{}", suggestion(name, names)));
}

void readLoop(Reading& reading, const XmlElement& element) {
  const Values values(element);
  RobotLoop loop;
  loop.place = element.place();
  loop.is_weld = element.tag == "weld";
  if (values.has("site1")) {
    const RobotFrame &a = siteNamed(reading, values, "site1"), &b = siteNamed(reading, values, "site2");
    loop.a = a.body;
    loop.b = b.body;
    loop.p_A = a.X_BF.p;
    loop.p_B = b.X_BF.p;
    if (loop.is_weld) element.reject("welds two sites, which isn't known yet: name the bodies.");
  } else {
    loop.a = bodyNamed(reading, values, "body1");
    loop.b = values.has("body2") ? bodyNamed(reading, values, "body2") : -1;
    loop.p_A = values.vector("anchor", Vec3::Zero());
    if (!loop.is_weld && !values.has("anchor")) element.reject("needs the attribute \"anchor\".");
    const std::vector<double> pose = values.numbers("relpose", 7, 7);  // a turn of four zeros: as they are drawn
    if (std::any_of(pose.begin() + (pose.empty() ? 0 : 3), pose.end(), [](double x) { return x != 0; }))
      values.reject("relpose", "isn't known yet: draw the bodies as they are welded.");
  }
  reading.robot.loops.push_back(loop);
}

void readEquality(Reading& reading, const XmlElement& element) {
  if (!isActive(reading, element)) {
    reading.document.notes.add(fmt::format("{} that isn't active", element.tag), "It stays so here.", element.place());
  } else if (element.tag == "joint") {
    readCoupling(reading, element);
  } else {
    readLoop(reading, element);
  }
}

void readKey(Reading& reading, const XmlElement& element) {
  const Values values(element);
  RobotKeyframe key;
  key.name = values.text("name", fmt::format("key{}", reading.robot.keyframes.size()));
  key.time = values.number("time", 0);
  const auto q_count = static_cast<std::size_t>(reading.coordinates.back());
  if (values.has("qpos")) key.q = values.numbers("qpos", q_count, q_count);
  if (values.has("qvel")) key.v = values.numbers("qvel", 0, q_count);
  if (std::any_of(key.v.begin(), key.v.end(), [](double v) { return v != 0; }))
    reading.document.notes.add("key qvel", "Robots start at rest.", element.place());
  if (key.time != 0) reading.document.notes.add("key time", "Time begins at 0.", element.place());
  const std::size_t drives = reading.robot.drives.size();
  if (values.has("ctrl")) key.controls = values.numbers("ctrl", drives, drives);
  reading.robot.keyframes.push_back(std::move(key));
}

}  // namespace

void readRelations(Reading& reading) {
  forEach(reading, "contact", [&](const XmlElement& e) { readContact(reading, e); });
  forEach(reading, "tendon", [&](const XmlElement& e) { readTendon(reading, e); });
  forEach(reading, "equality", [&](const XmlElement& e) { readEquality(reading, e); });
}

void readKeyframes(Reading& reading) {
  forEach(reading, "keyframe", [&](const XmlElement& e) { readKey(reading, e); });
}

}  // namespace pincer::tasks::mjcf
