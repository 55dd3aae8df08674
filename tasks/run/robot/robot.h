// robot: a robot as its file describes it: names, frames and numbers, without JSON and without an engine.
// robot_import.h reads one, robot_scene.h makes a scene of it.
//
// Lengths in metres, angles in radians, whatever the file's units. Frames: P of the
// parent body, B of the body, G of a geom.
#pragma once
#include <optional>
#include <string>
#include <vector>

#include "pincer/contact/math.h"
#include "pincer/contact/triangle_mesh.h"
#include "pincer/engine/motion/mass.h"

namespace pincer::tasks {

// Where something stands in a file, for messages: "hand.xml:31".
using Place = std::string;

enum class RobotShape { kPlane, kSphere, kCapsule, kEllipsoid, kCylinder, kBox, kMesh };

// How the mass of a mesh is spread.
enum class MeshInertia {
  kConvex,  // over its hull
  kLegacy,  // tetrahedra from the middle of its faces, all counted as positive: too much where it isn't convex
  kExact,   // over the solid that it bounds
  kShell,   // over its surface, by area
};

// A mesh as the robot uses it: scaled, and moved to the frame of its geoms.
struct RobotMesh {
  std::string name, file;  // the file's path as it can be opened; empty: the mesh's points stand in the robot's file
  contact::TriangleMesh triangles;
  MeshInertia inertia = MeshInertia::kLegacy;
  Place place;
};

// Friction of a geom, or of two.
struct RobotFriction {
  double mu = 1, torsion_radius = 0, rolling_radius = 0;  // [-], [m], [m]

  bool operator==(const RobotFriction&) const = default;
};

struct RobotGeom {
  std::string name;
  RobotShape shape = RobotShape::kSphere;
  // sphere: radius; capsule, cylinder: radius, half length along z; ellipsoid, box: half axes
  Vec3 half = Vec3::Zero();
  int mesh = -1;  // of Robot::meshes
  Pose X_BG;
  RobotFriction friction;
  int contype = 1, conaffinity = 1, priority = 0;
  double mass = 0;  // [kg]
  Place place;

  bool isOnlySeen() const { return contype == 0 && conaffinity == 0; }
};

// True if either of the two is something that the other touches.
inline bool canTouch(const RobotGeom& a, const RobotGeom& b) {
  return (a.contype & b.conaffinity) != 0 || (b.contype & a.conaffinity) != 0;
}

enum class RobotJointKind { kHinge, kSlide, kBall, kFree };

struct RobotJoint {
  std::string name;
  RobotJointKind kind = RobotJointKind::kHinge;
  Vec3 p_B = Vec3::Zero(), axis_B = Vec3::UnitZ();
  double reference = 0;                   // the coordinate in the pose that the file draws [rad, m]
  std::optional<Vec2> limits;             // least and most [rad, m]
  double stiffness = 0, spring_rest = 0;  // [N m/rad, N/m]; [rad, m]
  double damping = 0;                     // [N m s/rad, N s/m]
  double friction = 0;                    // dry [N m, N]
  double armature = 0;                    // [kg m^2, kg]
  Vec2 spring_damper = Vec2::Zero();      // time constant [s] and damping ratio; where both aren't 0, what the joint's
                                          // stiffness and damping are made from
  std::optional<Vec2> drive_forces;       // of all drives together [N m, N]
  Place place;
};

struct RobotBody {
  std::string name;
  int parent = -1;  // -1: the world; parents come first
  Pose X_PB;        // in the pose that the file draws
  std::vector<RobotJoint> joints;
  std::vector<RobotGeom> geoms;
  engine::MassProperties inertia;
  bool is_driven = false;           // mocap: goes where it is told
  double gravity_compensation = 0;  // share of its weight that is taken off
  Place place;
};

struct RobotFrame {
  std::string name;
  int body = -1;
  Pose X_BF;
};

// q(follower) = sum of polynomial[k] (q(leader) - its reference)^k + the follower's reference;
// without a leader the follower stands still.
struct RobotCoupling {
  std::string follower, leader;
  std::vector<double> polynomial;
  Place place;
};

// Two bodies that a point, or all of a pose, ties beside the tree.
struct RobotLoop {
  bool is_weld = false;
  int a = -1, b = -1;       // bodies; -1: the world
  Vec3 p_A = Vec3::Zero();  // the point on a
  std::optional<Vec3> p_B;  // on b; else where it is in the pose that the file draws
  Place place;
};

struct RobotTendon {
  std::string name;
  std::vector<std::pair<std::string, double>> joints;  // joint and coefficient
  std::optional<Vec2> limits;
  double stiffness = 0, damping = 0, friction = 0;
  std::optional<Vec2> rest;  // the spring's length: between the two it pulls nowhere; none: at the reference
  Place place;
};

// Force on its joint or tendon: gear times (gain u + bias[0] + bias[1] l + bias[2] l'), l =
// gear times the coordinate, within `forces`.
struct RobotDrive {
  std::string name, joint, tendon;  // one of the last two
  double gear = 1, gain = 1;
  Vec3 bias = Vec3::Zero();
  double damping_ratio = 0;  // where not 0: bias[2] = -2 ratio sqrt(gain m), m the inertia that l feels
  std::optional<Vec2> controls, forces;
  Place place;
};

// Two bodies that don't touch; -1: the world.
struct RobotExclusion {
  int a = -1, b = -1;
  Place place;
};

struct RobotGeomIndex {
  int body = -1, geom = 0;  // of that body's, or of the world's
};

// Two geoms that touch, and their friction for each other where they have one of their own.
struct RobotPair {
  RobotGeomIndex a, b;
  std::optional<RobotFriction> friction;
  Place place;
};

struct RobotKeyframe {
  std::string name;
  double time = 0;
  std::vector<double> q, v, controls;  // as many as the robot has, or empty
};

struct Robot {
  std::string name, file;
  double tick = 0.002;  // [s]
  Vec3 gravity_W = Vec3(0, 0, -9.81);
  std::vector<RobotMesh> meshes;
  std::vector<RobotBody> bodies;
  std::vector<RobotGeom> world_geoms;  // fixed to the world
  std::vector<RobotFrame> frames;      // body -1: fixed to the world
  std::vector<RobotExclusion> excluded;
  std::vector<RobotPair> pairs;
  std::vector<RobotCoupling> couplings;
  std::vector<RobotLoop> loops;
  std::vector<RobotTendon> tendons;
  std::vector<RobotDrive> drives;
  std::vector<RobotKeyframe> keyframes;
};

}  // namespace pincer::tasks
