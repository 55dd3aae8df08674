#include "pincer/tasks/run/robot/import_report.h"

#include <fmt/format.h>

#include "pincer/contact/io/printable.h"
#include "pincer/tasks/run/files/json_writer.h"
#include "pincer/tasks/run/robot/robot_pose.h"

namespace pincer::tasks {
namespace {

double massOf(const Robot& robot) {
  double sum = 0;
  for (const RobotBody& body : robot.bodies) sum += body.inertia.mass;
  return sum;
}

std::size_t jointCount(const Robot& robot) {
  std::size_t count = 0;
  for (const RobotBody& body : robot.bodies) count += body.joints.size();
  return count;
}

std::size_t touchingGeoms(const Robot& robot) {
  std::size_t count = 0;
  for (const RobotBody& body : robot.bodies) {
    for (const RobotGeom& geom : body.geoms) count += !geom.isOnlySeen();
  }
  return count;
}

std::string counted(std::size_t count, std::string_view one, std::string_view many) {
  return fmt::format("{} {}", count, count == 1 ? one : many);
}

void addPose(const Pose& X, JsonWriter& json) { json.key("position").value(X.p).key("quaternion").value(X.q); }

void writeBody(const RobotBody& body, const Pose& X_WB, JsonWriter& json) {
  const Mat3 R = X_WB.q.toRotationMatrix(), I = R * body.inertia.I_BBcm * R.transpose();
  json.beginObject().key("name").value(body.name).key("mass").value(body.inertia.mass);
  json.key("center").value(Vec3(X_WB * body.inertia.p_BBcm)).key("moments").value(Vec3(I.diagonal()));
  json.key("products").value(Vec3(I(0, 1), I(0, 2), I(1, 2)));
  addPose(X_WB, json);
  json.endObject();
}

void writeJoints(const Robot& robot, JsonWriter& json) {
  json.key("joints").beginArray();
  for (const RobotBody& body : robot.bodies) {
    for (const RobotJoint& joint : body.joints)
      json.beginObject().key("name").value(joint.name).key("body").value(body.name).endObject();
  }
  json.endArray().key("drives").beginArray();
  for (const RobotDrive& drive : robot.drives) json.value(drive.name);
  json.endArray();
}

void writeKeyframes(const Robot& robot, JsonWriter& json) {
  json.key("keyframes").beginArray();
  for (const RobotKeyframe& key : robot.keyframes) {
    json.beginObject().key("name").value(key.name).key("bodies").beginArray();
    for (const Pose& X : bodyPoses(robot, key.q.empty() ? drawnCoordinates(robot) : key.q)) {
      json.beginObject();
      addPose(X, json);
      json.endObject();
    }
    json.endArray().endObject();
  }
  json.endArray();
}

}  // namespace

std::string importText(const RobotImport& import) {
  const Robot& robot = import.robot;
  std::string text = fmt::format(
      "{}: {}, {:.4g} kg, {}, {}, {}, {}.\n", printable(robot.name), counted(robot.bodies.size(), "body", "bodies"),
      massOf(robot), counted(jointCount(robot), "joint", "joints"),
      counted(robot.couplings.size(), "coupling", "couplings"), counted(robot.drives.size(), "drive", "drives"),
      counted(touchingGeoms(robot), "shape that touches", "shapes that touch"));
  if (!import.notes.all().empty()) text += "Without effect here:\n";
  for (const ImportNote& note : import.notes.all()) {
    text += fmt::format("  {:<28} {:>4} x, first at {}{}{}\n", printable(note.what), note.count, printable(note.place),
                        note.why.empty() ? "" : ". ", note.why);
  }
  return text;
}

std::string importJson(const RobotImport& import) {
  const Robot& robot = import.robot;
  const std::vector<Pose> poses = bodyPoses(robot, drawnCoordinates(robot));
  JsonWriter json;
  json.beginObject().key("robot").value(robot.name).key("file").value(robot.file).key("bodies").beginArray();
  for (std::size_t i = 0; i < robot.bodies.size(); ++i) writeBody(robot.bodies[i], poses[i], json);
  json.endArray();
  writeJoints(robot, json);
  writeKeyframes(robot, json);
  json.key("notes").beginArray();
  for (const ImportNote& note : import.notes.all()) {
    json.beginObject().key("what").value(note.what).key("why").value(note.why).key("count").value(note.count);
    json.key("place").value(note.place).endObject();
  }
  json.endArray().endObject();
  return json.text() + "\n";
}

}  // namespace pincer::tasks
