// linkage: a world of a few bodies on joints, for the cases of the accuracy suite.
#pragma once
#include <string>
#include <vector>

#include "pincer/engine/step.h"
#include "pincer/tasks/judge/verify/scene_run.h"

namespace pincer::tasks {

// A world of joints alone, or nearly.
class Linkage {
 public:
  explicit Linkage(double h = 1e-3, const Vec3& gravity_W = {0, 0, -kVerifyG}) {
    options_.h = h;
    options_.gravity_W = gravity_W;
  }

  int body(const engine::BodySpec& spec, const engine::BodyStart& start) {
    bodies_.push_back(spec);
    starts_.push_back(start);
    return static_cast<int>(bodies_.size()) - 1;
  }
  // A small ball with this inertia about all axes, at `p`.
  int ball(double mass, double inertia, const Vec3& p, double radius = 0.001) {
    engine::BodySpec spec{"ball" + std::to_string(bodies_.size()), contact::Sphere{radius}, true, mass, {}};
    spec.inertia = engine::GivenInertia{Vec3::Zero(), inertia * Mat3::Identity()};
    return body(spec, {Pose{Quat::Identity(), p}});
  }
  int joint(const engine::JointModel& joint) {
    joints_.push_back(joint);
    return static_cast<int>(joints_.size()) - 1;
  }
  void couple(const engine::CouplingModel& coupling) { couplings_.push_back(coupling); }
  void drive(const engine::DriveModel& drive) { drives_.push_back(drive); }
  void exclude(int a, int b) { excluded_.emplace_back(a, b); }  // these two never touch

  void build() {
    engine::WorldBuilder builder{options_};
    for (const auto& spec : bodies_) builder.addBody(spec);
    for (const auto& joint : joints_) builder.addJoint(joint);
    for (const auto& coupling : couplings_) builder.addCoupling(coupling);
    for (const auto& drive : drives_) builder.addDrive(drive);
    for (const auto& [a, b] : excluded_) builder.excludePair(a, b);
    model_ = builder.build();
    state_ = engine::makeState(model_, starts_, {});
    scratch_ = engine::makeScratch(model_);
    controls.resize(drives_.size());
  }
  // Counts ticks that weren't clean.
  void tick() { flagged += engine::step(model_, state_, *scratch_, {{}, {}, {}, controls}).status != engine::kStepOk; }
  void run(double seconds) {
    for (std::int64_t n = wholeTicks(seconds, options_.h); n > 0; --n) tick();
  }
  double position(int joint) const { return engine::jointPosition(model_, state_, joint); }
  double velocity(int joint) const { return engine::jointVelocity(model_, state_, joint); }
  void set(int joint, double position, double velocity = 0) {
    engine::setJoint(model_, state_, joint, position, velocity);
  }
  double energy() const { return engine::kineticEnergy(model_, state_) + engine::potentialEnergy(model_, state_); }
  const engine::WorldState& state() const { return state_; }
  double time() const { return state_.time; }
  double tickLength() const { return options_.h; }
  int contactCount() const { return engine::contactCount(*scratch_); }  // in the last tick
  engine::ContactReport contact(int k) const { return engine::contactAt(*scratch_, k); }

  std::vector<engine::DriveInput> controls;
  int flagged = 0;

 private:
  engine::WorldOptions options_;
  std::vector<engine::BodySpec> bodies_;
  std::vector<engine::BodyStart> starts_;
  std::vector<engine::JointModel> joints_;
  std::vector<engine::CouplingModel> couplings_;
  std::vector<engine::DriveModel> drives_;
  std::vector<std::pair<int, int>> excluded_;
  engine::WorldModel model_;
  engine::WorldState state_;
  engine::ScratchHandle scratch_;
};

inline Record unflagged(const Linkage& world) { return exactly("flagged ticks", world.flagged, "-", 0); }

// The joint's frames: z along `axis`, at p_A in body a, at p_B in b or the world.
inline engine::JointModel jointAlong(engine::JointKind kind, const Vec3& axis, int a, const Vec3& p_A, int b,
                                     const Vec3& p_B) {
  const Quat q(frameFromNormal(axis));
  return {kind, a, b, Pose{q, p_A}, Pose{q, p_B}};
}
inline engine::DriveModel motorOn(int joint) {
  engine::DriveModel drive;
  drive.name = "motor";
  drive.terms = {{joint, 1}};
  return drive;
}

}  // namespace pincer::tasks
