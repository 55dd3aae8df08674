// mjcf_parts: what the readers of an MJCF file's sections share.
#pragma once
#include <map>
#include <string>
#include <utility>
#include <vector>

#include "pincer/tasks/run/robot/mjcf_document.h"
#include "pincer/tasks/run/robot/mjcf_values.h"
#include "pincer/tasks/run/robot/robot.h"

namespace pincer::tasks::mjcf {

// A robot while it is read.
struct Reading {
  Document& document;
  Robot& robot;
  std::map<std::string, int, std::less<>> meshes, bodies;  // by name
  std::map<std::string, int, std::less<>> geom_bodies;     // the body of each geom that has a name; -1: the world
  std::map<std::string, const RobotJoint*, std::less<>> joints = {};  // once all bodies are there
  std::vector<std::pair<double, Place>> frictionless = {};  // geoms of condim 1: the friction that they have for others
  std::vector<int> coordinates = {};  // of a keyframe: by body, the first coordinate; the last entry counts all

  const Compiler& compiler() const { return document.compiler; }
};

// asset: every mesh.
void readMeshes(Reading& reading);

// From one end of a geom or site to the other: the middle, z from the second end to the first, and the half length.
struct Ends {
  Pose X;
  double half = 0;
};
Ends readEnds(const Values& values);

// Throws InputError at a condim that MJCF doesn't have.
void requireDimensions(const Values& values, int dimensions);
// Of sliding, turning about the normal, rolling, as far as condim has them. Radii are over the sliding one.
RobotFriction frictionOf(int dimensions, const Vec3& coefficients);

// A geom or joint within frames that move and turn it: X_BR is the pose of the innermost frame in the body's.
RobotGeom readGeom(Reading& reading, const Values& values, const Pose& X_BR);
RobotJoint readJoint(Reading& reading, const Values& values, const Pose& X_BR);
// True if the geom's group lies within inertiagrouprange.
bool addsMass(const Reading& reading, const Values& values);

// worldbody: bodies, joints, geoms, sites, masses.
void readBodies(Reading& reading);
// Stiffness and damping of joints that say "springdamper".
void tuneSprings(Robot& robot);
// A pair of contact.
void readPair(Reading& reading, const XmlElement& element);
// contact, equality, tendon; after the bodies.
void readRelations(Reading& reading);
// A geom of condim 1 has no friction here; notes those whose friction would count where others have less.
void noteFrictionless(const Reading& reading);
// actuator; after the tendons.
void readActuators(Reading& reading);
// keyframe; after the actuators.
void readKeyframes(Reading& reading);

// The element's reference to a body or joint of that name. Throws InputError at the element, with a did-you-mean.
int bodyNamed(const Reading& reading, const Values& values, std::string_view attribute);  // "world" is -1
const RobotJoint& jointNamed(const Reading& reading, const Values& values, std::string_view attribute);

}  // namespace pincer::tasks::mjcf
