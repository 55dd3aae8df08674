// pad_run: an object between two fingertips, for the cases of the accuracy suite.
#pragma once
#include <array>
#include <optional>
#include <string>
#include <vector>

#include "pincer/contact/triangle_mesh.h"
#include "pincer/grasp/step.h"
#include "pincer/tasks/judge/verify/scene_run.h"

namespace pincer::tasks {

constexpr double kHalfThickness = 2e-3;  // of a pad, along x [m]
constexpr double kRounding = 5e-4;       // of its edges [m]
constexpr double kUp = 0.1;              // height of the object's centre [m]

contact::PadTip flatPad(double width);
contact::PadTip roundPad(double width);  // a prism of 24 sides, as a pad whose face is round
contact::Shape smooth(const contact::TriangleMesh& mesh);

// Meshes 40 mm long along x: a torus, a spool, a cube with round edges, a grooved block, hills, a scan with its noise.
struct HeldMesh {
  std::string name;
  contact::Shape shape;
};
std::vector<HeldMesh> heldMeshes();

struct PadGrip {
  contact::Shape shape;
  double half = 0.015;  // of the object along x [m]
  double mass = 0.1, mu = 0.6;
  double width = 0.02;                                     // of the pads [m]
  std::optional<contact::FingerShape> tip = std::nullopt;  // in their place
  double tip_reach = kHalfThickness;                       // of the tip from its centre along x [m]
  double patch_radius = 0;                                 // [m]
  double turn_stiffness = 0;                               // [N m/rad]
  double beside = 0;                                       // the object's centre of mass from its middle along y [m]
  Vec3 off = Vec3::Zero();                                 // of the pads from the object's middle [m]
  double press = 15;                                       // N [N]
  double seconds = 60;                                     // held for
  Vec3 stiffness = Vec3::Constant(5000);                   // along x: 0 presses with a force, else with a spring [N/m]
  Eigen::Array<bool, 3, 1> locked{false, false, false};
  Vec3 gravity_W{0, 0, -kVerifyG};
  Vec3 w_W = Vec3::Zero();                        // of the object at the start [rad/s]
  Quat q_WB = Quat::Identity();                   // the same
  std::vector<engine::ColliderSpec> shapes = {};  // of the object, in place of `shape`
  double along = 0;                               // the object's frame from its middle, along x [m]
};

// Motion of the hand that carries both tips, about the object's place at the start.
struct HandMotion {
  Quat q = Quat::Identity();
  Vec3 d = Vec3::Zero();                    // [m]
  Vec3 v = Vec3::Zero(), w = Vec3::Zero();  // [m/s], [rad/s]
};

// An object between two pads at -x and +x, which just touch it.
class PadRun {
 public:
  explicit PadRun(const PadGrip& grip);

  // One tick to where the left pad is displaced by `d`, the right one by `sign` d, at the velocity `v` and `sign` v.
  void tick(const Vec3& d = Vec3::Zero(), const Vec3& v = Vec3::Zero(), double sign = 1);
  void tick(const HandMotion& hand);
  double time() const { return static_cast<double>(ticks) * model.world.options.h; }
  const Vec3& place() const { return state.world.bodies[0].X_WI.p; }
  const Quat& turned() const { return state.world.bodies[0].X_WI.q; }
  Vec3 padsPlace() const { return 0.5 * (state.world.points[0].p_W + state.world.points[1].p_W); }
  Pose inHand(const Quat& q) const { return {q.conjugate() * turned(), q.conjugate() * (place() - padsPlace())}; }

  grasp::GraspModel model;
  grasp::GraspState state;
  std::int64_t ticks = 0, flagged = 0;

 private:
  Vec3 startOf(int finger, double deep) const;  // from the object's middle
  void step();

  PadGrip grip_;
  grasp::ScratchHandle scratch_;
  std::array<grasp::FingerInput, 2> inputs_;
};

}  // namespace pincer::tasks
