// bench_world: a scene as `pincer bench engine` tells it to every engine, and
// the little that it asks of one: step, read.
//
// World frame W, z up; a body's frame B is its shape's, at the centre of mass. Every two bodies
// have the friction `mu` and the restitution.
#pragma once
#include <array>
#include <functional>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "pincer/contact/shape.h"

namespace pincer::tasks {

// Where a guided body is pulled to, and what pushes it:  f + k (p - p_WB) + d (v - v_WB),
//                                                        along each axis that it may move on.
struct BenchAim {
  Vec3 p_W = Vec3::Zero(), v_W = Vec3::Zero(), f_W = Vec3::Zero();
};

enum class BenchKind {
  kFixed,
  kFree,
  kGuided,  // never turns; moves along the axes of W that aren't locked, weightless: a fingertip, a pad on a slider
  kHinged,  // turns about the line through hinge_W along y
};

struct BenchBody {
  contact::Shape shape = contact::Sphere{1};  // sphere, box, capsule; half-space if fixed; families: cylinder, hull
  BenchKind kind = BenchKind::kFree;
  double mass = 0;  // [kg]
  Pose X_WB = {};
  Vec3 v_W = Vec3::Zero(), w_W = Vec3::Zero();            // at the start, of free bodies [m/s, rad/s]
  std::array<bool, 3> locked = {false, false, false};     // of guided bodies
  Vec3 stiffness = Vec3::Zero(), damping = Vec3::Zero();  // k [N/m], d [N s/m]
  std::function<BenchAim(double t)> aim = {};             // of guided bodies
  Vec3 hinge_W = Vec3::Zero();                            // [m]
};

// A robot with all that it touches, from one MJCF file that engines read themselves.
struct BenchRobot {
  std::string file;                 // a path, or that of a file that the program carries (run/files/builtin_files.h)
  std::string keyframe;             // its pose at the start, its controls for good; empty: as drawn, 0
  std::vector<std::string> bodies;  // motion(i) is that of the i-th: X_WB, B as the file has it
};

struct BenchWorld {
  Vec3 gravity_W = Vec3(0, 0, -9.81);  // [m/s^2]
  double mu = 0.5;
  double restitution = 0;
  std::vector<BenchBody> bodies = {};
  std::optional<BenchRobot> robot = {};  // in place of all of the above
};

struct BenchMotion {
  Pose X_WB = {};
  Vec3 v_W = Vec3::Zero(), w_W = Vec3::Zero();  // of the centre of mass
};

// A world in an engine.
class BenchEngine {
 public:
  virtual ~BenchEngine() = default;
  virtual void step() = 0;
  virtual BenchMotion motion(int body) = 0;
  virtual std::string complaint() { return {}; }  // of the engine about its own steps so far; empty: none
};

// How finely it steps.
struct BenchStep {
  double h = 1e-3;       // [s]
  double tolerance = 0;  // pincer's position_tolerance [m]; 0: off
};

// An engine with one of its settings.
struct Contestant {
  std::string engine = {}, setting = {};
  std::vector<BenchStep> ladder = {};                        // empty: the scene's
  bool reads_robots = false;                                 // else it is left out of worlds with one
  std::function<bool(const BenchWorld&)> meant = {};         // for which worlds; null: all. Left out elsewhere
  std::function<std::string(const BenchWorld&)> lacks = {};  // why it takes no part in this world; empty: it does
  std::function<std::unique_ptr<BenchEngine>(const BenchWorld&, const BenchStep&)> make = {};

  std::string name() const { return setting.empty() ? engine : engine + " " + setting; }
};

// pincer itself: at the scene's steps, and at 1 ms with its tolerance from coarse to fine.
std::vector<Contestant> pincerContestants();

// A robot in pincer. Throws InputError.
std::unique_ptr<BenchEngine> pincerRobot(const BenchRobot& robot, const BenchStep& step);

// Other engines, each at its documented best (tasks/judge/peers); none in a build without -DPINCER_PEERS=ON.
std::vector<Contestant> enginePeers();

// Bullet with ten iterations, as games run it, for families of worlds (family_worlds.h);
// none without -DPINCER_PEERS=ON.
std::vector<Contestant> familyPeers();

// The force on a guided body along its free axes at time t, where its engine has no spring of its own: the damper as it
// is at the end of a step of h, so that it is stable.
Vec3 guidingForce(const BenchBody& body, const BenchMotion& motion, double t, double h);

}  // namespace pincer::tasks
