#include "pincer/tasks/run/robot/robot_scene.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <set>

#include "pincer/contact/error.h"
#include "pincer/contact/io/printable.h"
#include "pincer/engine/motion/driven_motion.h"
#include "pincer/tasks/run/robot/robot_pose.h"
#include "pincer/tasks/run/robot/robot_scene_parts.h"

namespace pincer::tasks {
namespace {

// Of bodies between the joints of one body: the least that a scene takes.
constexpr double kNextToNothing = 1e-9;    // [kg]
constexpr double kNextToNoMoment = 1e-18;  // [kg m^2]
constexpr double kDotRadius = 1e-3;        // of what has no shape that touches [m]
constexpr double kRoundOff = 1e-6;         // of a tick, in a duration

// Words that a robot has and a scene doesn't.
void refuseTheRest(const Robot& robot) {
  for (const RobotTendon& tendon : robot.tendons) {
    if (tendon.limits || tendon.friction != 0)
      rejectAt(
          tendon.place,
          fmt::format("tendon \"{}\" has limits or friction of its own, which can't be had. Give them to its joints.",
                      tendon.name));
    if (tendon.stiffness > 0 && tendon.rest && (*tendon.rest)[0] != (*tendon.rest)[1])
      rejectAt(tendon.place,
               fmt::format("tendon \"{}\" has a spring that is slack between two lengths. Give it one springlength.",
                           tendon.name));
  }
  for (const RobotBody& body : robot.bodies) {
    if (body.is_driven)
      rejectAt(body.place,
               fmt::format("body \"{}\" is driven (mocap), which can't be had from a file yet.", body.name));
  }
}

// Springs, dampers and dry friction act along one axis here; a free body has no joint at all.
void noteForcesOfBalls(const RobotJoint& joint, ImportNotes& notes) {
  const bool is_free = joint.kind == RobotJointKind::kFree;
  if (!is_free && joint.kind != RobotJointKind::kBall) return;
  const std::pair<const char*, double> forces[] = {{"stiffness", joint.stiffness},
                                                   {"damping", joint.damping},
                                                   {"frictionloss", joint.friction},
                                                   {"armature", is_free ? joint.armature : 0}};
  for (const auto& [name, value] : forces) {
    if (value != 0)
      notes.add(fmt::format("{} joint {}", is_free ? "free" : "ball", name), "Hinges and slides have it.", joint.place);
  }
}

void noteTheRest(const Robot& robot, ImportNotes& notes) {
  for (const RobotBody& body : robot.bodies) {
    if (body.gravity_compensation != 0) notes.add("body gravcomp", "Bodies weigh what they weigh.", body.place);
    for (const RobotJoint& joint : body.joints) {
      noteForcesOfBalls(joint, notes);
      if (joint.drive_forces && !isOnlyDriveOf(robot, joint))
        notes.add("joint actuatorfrcrange", "It holds where one drive moves the joint alone.", joint.place);
    }
    for (const RobotGeom& geom : body.geoms) {
      if (geom.priority != 0) notes.add("geom priority", "The larger of two frictions counts.", geom.place);
    }
  }
}

void writePose(const Pose& X, JsonWriter& json) {
  json.key("position").value(X.p);
  const Vec3 turn = engine::rotationVectorOf(X.q);
  if (!turn.isZero(0)) json.key("rotation").value(turn);
}

void writeGeom(SceneWriting& w, const RobotGeom& geom, const Pose& X) {
  JsonWriter& json = w.json;
  json.beginObject().key("shape");
  writeRobotShape(geom, X, w.hulls, json);
  if (geom.shape != RobotShape::kPlane) writePose(X, json);
  writeFriction(geom.friction, json);
  json.key("collides")
      .beginObject()
      .key("as")
      .value(geom.contype)
      .key("with")
      .value(geom.conaffinity)
      .endObject()
      .endObject();
}

// Touchable shapes; a body that nothing touches is a dot that is only seen.
void writeShapes(SceneWriting& w, const std::vector<std::pair<const RobotGeom*, Pose>>& geoms) {
  JsonWriter& json = w.json;
  json.key("shapes").beginArray();
  bool is_empty = true;
  for (const auto& [geom, X] : geoms) {
    if (geom->isOnlySeen()) continue;
    writeGeom(w, *geom, X);
    is_empty = false;
  }
  if (is_empty) {
    json.beginObject()
        .key("shape")
        .beginObject()
        .key("type")
        .value("sphere")
        .key("radius")
        .value(kDotRadius)
        .endObject();
    json.key("collides").beginObject().key("as").value(0).key("with").value(0).endObject().endObject();
  }
  json.endArray();
}

void writeInertia(const engine::MassProperties& m, JsonWriter& json) {
  json.key("mass").value(std::max(m.mass, kNextToNothing)).key("inertia").beginObject().key("center").value(m.p_BBcm);
  json.key("moments").value(Vec3(m.I_BBcm.diagonal().cwiseMax(kNextToNoMoment)));
  json.key("products").value(Vec3(m.I_BBcm(0, 1), m.I_BBcm(0, 2), m.I_BBcm(1, 2))).endObject();
}

// The body that stands behind the `joint`th joint of a body of several.
const std::string& betweenName(SceneWriting& w, const RobotBody& body, std::size_t joint) {
  return w.names.of("between", body.name + "_" + body.joints[joint].name);
}

void writeBetween(SceneWriting& w, const std::string& name, const Pose& X_WB) {
  w.json.beginObject().key("name").value(name);
  writeShapes(w, {});
  writeInertia({kNextToNothing, Vec3::Zero(), kNextToNoMoment * Mat3::Identity()}, w.json);
  writePose(X_WB, w.json);
  w.json.endObject();
}

// True of a free body that carries others: trees hang on something, so three
// sliders and a ball joint hold it to the world.
bool isFloatingBase(const PosedRobot& posed, const RobotLink& link) {
  const RobotBody& body = posed.body(link.body);
  if (body.joints.empty() || body.joints[0].kind != RobotJointKind::kFree) return false;
  return std::any_of(posed.links.begin(), posed.links.end(), [&](const RobotLink& other) {
    const int parent = posed.body(other.body).parent;
    return parent >= 0 && posed.carrier(parent) == link.body;
  });
}

constexpr std::string_view kSlides[] = {"x", "y", "z"};  // by axis of W

// The body that the slider along an axis of W carries.
const std::string& slideName(SceneWriting& w, const RobotBody& body, int axis) {
  return w.names.of("between", fmt::format("{}_{}", body.name, kSlides[axis]));
}

void writeLink(SceneWriting& w, const RobotLink& link) {
  const RobotBody& body = w.posed.body(link.body);
  for (std::size_t k = 0; k + 1 < body.joints.size(); ++k) {
    w.notes.add("body of several joints", "A body of a microgram stands between two of them.", body.place);
    writeBetween(w, betweenName(w, body, k), w.posed.poseAfter(link.body, k + 1));
  }
  if (isFloatingBase(w.posed, link)) {
    w.notes.add("free body that carries others",
                "Three sliders and a ball joint hold it; bodies of a microgram stand between.", body.place);
    for (int k = 0; k < 3; ++k) writeBetween(w, slideName(w, body, k), {Quat::Identity(), w.posed.pose(link.body).p});
  }
  w.json.beginObject().key("name").value(w.bodyName(link.body));
  if (link.is_static) w.json.key("static").value(true);
  writeShapes(w, link.geoms);
  if (!link.is_static) writeInertia(link.inertia, w.json);
  writePose(w.posed.pose(link.body), w.json);
  w.json.endObject();
}

void writeBodies(SceneWriting& w) {
  const Robot& robot = w.posed.robot;
  w.json.key("bodies").beginArray();
  if (!robot.world_geoms.empty()) {
    std::vector<std::pair<const RobotGeom*, Pose>> geoms;
    for (const RobotGeom& geom : robot.world_geoms) geoms.emplace_back(&geom, w.posed.X_WR * geom.X_BG);
    w.json.beginObject().key("name").value(w.names.of("world", "world")).key("static").value(true);
    writeShapes(w, geoms);
    w.json.endObject();
  }
  for (const RobotLink& link : w.posed.links) writeLink(w, link);
  w.json.endArray();
}

void writeTraits(SceneWriting& w, const RobotJoint& joint, double start) {
  const auto unless0 = [&](std::string_view key, double value) {
    if (value != 0) w.json.key(key).value(value);
  };
  if (joint.limits) w.json.key("limits").beginArray().value((*joint.limits)[0]).value((*joint.limits)[1]).endArray();
  unless0("stiffness", joint.stiffness);
  if (joint.stiffness > 0) w.json.key("rest").value(joint.spring_rest);
  unless0("damping", joint.damping);
  unless0("friction", joint.friction);
  unless0("start", start);
}

void writeJoint(SceneWriting& w, int index, std::size_t k, double start) {
  constexpr std::string_view kTypes[] = {"pivot", "slider", "ball"};  // by kind of joint, as scenes call them
  const RobotBody& body = w.posed.body(index);
  const RobotJoint& joint = body.joints[k];
  const Pose X_WB = w.posed.poseAfter(index, k);
  w.json.beginObject()
      .key("name")
      .value(w.names.of("joint", joint.name))
      .key("type")
      .value(kTypes[static_cast<int>(joint.kind)]);
  w.json.key("body").value(k + 1 < body.joints.size() ? betweenName(w, body, k) : w.bodyName(index));
  if (k > 0) {
    w.json.key("to").value(betweenName(w, body, k - 1));
  } else if (body.parent >= 0) {
    w.json.key("to").value(w.bodyName(w.posed.carrier(body.parent)));
  }
  w.json.key("point").value(Vec3(X_WB * joint.p_B));
  if (joint.kind != RobotJointKind::kBall) {
    w.json.key("axis").value(Vec3(X_WB.q * joint.axis_B));
    writeTraits(w, joint, start);
  }
  if (joint.armature > 0) w.json.key("armature").value(joint.armature);
  w.json.endObject();
}

void writeFloatingBase(SceneWriting& w, const RobotLink& link) {
  const RobotBody& body = w.posed.body(link.body);
  const Vec3& p_W = w.posed.pose(link.body).p;
  for (int k = 0; k < 3; ++k) {
    w.json.beginObject().key("name").value(w.names.of("joint", fmt::format("{}_{}", body.joints[0].name, kSlides[k])));
    w.json.key("type").value("slider").key("body").value(slideName(w, body, k));
    if (k > 0) w.json.key("to").value(slideName(w, body, k - 1));
    w.json.key("point").value(p_W).key("axis").value(Vec3(Vec3::Unit(k))).endObject();
  }
  w.json.beginObject().key("name").value(w.names.of("joint", body.joints[0].name)).key("type").value("ball");
  w.json.key("body")
      .value(w.bodyName(link.body))
      .key("to")
      .value(slideName(w, body, 2))
      .key("point")
      .value(p_W)
      .endObject();
}

// The link of a body, that of the world or of what stands still: -1.
int movingLinkOf(const PosedRobot& posed, int body) {
  if (body < 0) return -1;
  const int link = posed.link_of[static_cast<std::size_t>(body)];
  return posed.links[static_cast<std::size_t>(link)].is_static ? -1 : link;
}

// The body that stands still and carries a link; -1: the world.
int baseOf(const PosedRobot& posed, int link) {
  for (;;) {
    const RobotLink& at = posed.links[static_cast<std::size_t>(link)];
    const int parent = posed.body(at.body).parent;
    if (at.is_static || parent < 0) return at.is_static ? at.body : -1;
    link = posed.link_of[static_cast<std::size_t>(parent)];
  }
}

void writeLoop(SceneWriting& w, const RobotLoop& loop, std::size_t number) {
  const int a = movingLinkOf(w.posed, loop.a), b = movingLinkOf(w.posed, loop.b);
  if (a == b) {
    w.notes.add(loop.is_weld ? "weld" : "connect", "It holds together what one link is already.", loop.place);
    return;
  }
  const int first = a < 0 ? b : a, second = a < 0 ? -1 : b;
  const int to = second >= 0 ? w.posed.links[static_cast<std::size_t>(second)].body : baseOf(w.posed, first);
  const Pose X_WA = loop.a < 0 ? w.posed.X_WR : w.posed.pose(loop.a);
  w.json.beginObject()
      .key("name")
      .value(w.names.of("loop", fmt::format("loop{}", number)))
      .key("type")
      .value(loop.is_weld ? "weld" : "ball");
  w.json.key("body").value(w.bodyName(w.posed.links[static_cast<std::size_t>(first)].body));
  if (to >= 0) w.json.key("to").value(w.bodyName(to));
  if (!loop.is_weld) w.json.key("point").value(Vec3(X_WA * loop.p_A));
  w.json.endObject();
}

void writeJoints(SceneWriting& w) {
  w.json.key("joints").beginArray();
  for (const RobotLink& link : w.posed.links) {
    if (isFloatingBase(w.posed, link)) writeFloatingBase(w, link);
    const double* q = w.posed.coordinatesOf(link.body);
    const auto& joints = w.posed.body(link.body).joints;
    for (std::size_t k = 0; k < joints.size(); ++k) {
      if (joints[k].kind != RobotJointKind::kFree) writeJoint(w, link.body, k, *q);
      q += coordinateCount(joints[k].kind);
    }
  }
  for (std::size_t i = 0; i < w.posed.robot.loops.size(); ++i) writeLoop(w, w.posed.robot.loops[i], i);
  w.json.endArray();
}

void writeFrame(SceneWriting& w, const std::string& name, int body, const Pose& X_BF) {
  const int carrier = w.posed.carrier(body);
  w.json.beginObject().key("name").value(name).key("body").value(w.bodyName(carrier));
  writePose(w.posed.pose(carrier).inverse() * w.posed.pose(body) * X_BF, w.json);
  w.json.endObject();
}

// Sites, and bodies that are part of another.
void writeFrames(SceneWriting& w) {
  w.json.key("frames").beginArray();
  for (const RobotFrame& frame : w.posed.robot.frames) {
    if (frame.body >= 0) {
      writeFrame(w, w.names.of("frame", frame.name), frame.body, frame.X_BF);
    } else {
      w.notes.add("site of the world", "Frames are on bodies.", w.posed.robot.file);
    }
  }
  for (int i = 0; i < static_cast<int>(w.posed.robot.bodies.size()); ++i) {
    if (w.posed.carrier(i) != i) writeFrame(w, w.bodyName(i), i, {});
  }
  w.json.endArray();
}

}  // namespace

void rejectAt(const Place& place, std::string_view problem) {
  throw InputError(printableMessage(fmt::format("{}: {}", place, problem)));
}

std::string sceneOfRobot(const Robot& robot, const RobotSceneOptions& options, ImportNotes& notes) {
  refuseTheRest(robot);
  noteTheRest(robot, notes);
  const PosedRobot posed = poseRobot(robot, options, notes);
  SceneWriting w{posed, notes, NamesOfRobot(options.prefix), RobotHulls(robot.meshes)};
  w.json.beginObject()
      .key("version")
      .value(1)
      .key("description")
      .value(robot.name)
      .key("gravity")
      .value(robot.gravity_W);
  w.json.key("tick")
      .value(robot.tick)
      .key("duration")
      .value(std::ceil(options.duration / robot.tick - kRoundOff) * robot.tick);
  w.json.key("combination").value("maximum");
  writeBodies(w);
  writeJoints(w);
  writeTies(w);
  writeFrames(w);
  writePairs(w);
  w.json.endObject();
  return w.json.text() + "\n";
}

}  // namespace pincer::tasks
