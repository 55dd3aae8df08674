// pincer as a contestant: fingertips are its driven points, pads bodies on sliders that
// massless points push, hinges its pivots.
#include <fmt/format.h>

#include "pincer/grasp/step.h"
#include "pincer/tasks/judge/bench/engine/bench_world.h"

namespace pincer::tasks {
namespace {

bool isFingertip(const BenchBody& body) {
  return body.kind == BenchKind::kGuided && std::holds_alternative<contact::Sphere>(body.shape);
}
bool isPad(const BenchBody& body) { return body.kind == BenchKind::kGuided && !isFingertip(body); }

int freeAxisOf(const BenchBody& body) {
  int axis = 0;
  while (axis < 2 && body.locked[static_cast<std::size_t>(axis)]) ++axis;
  return axis;
}

constexpr std::size_t kMostWithin = 12;  // bodies of a world that is run with a tolerance
// of the point that pushes a pad: what it presses with is what counts
constexpr double kPusherRadius = 0.008, kPusherMass = 1e-3;

class PincerEngine : public BenchEngine {
 public:
  PincerEngine(const BenchWorld& world, const BenchStep& step) : world_(world), h_(step.h) {
    engine::WorldBuilder builder(optionsOf(world, step));
    std::vector<grasp::FingerModel> fingers;
    std::vector<engine::BodyStart> starts;
    std::vector<Vec3> places;
    for (const BenchBody& body : world_.bodies) {
      const int index = isFingertip(body) ? -1 : addBody(builder, body, starts);
      body_of_.push_back(index);
      if (body.kind != BenchKind::kGuided) continue;
      finger_of_.push_back(static_cast<int>(body_of_.size()) - 1);
      fingers.push_back(fingerOf(body));
      places.push_back(isPad(body) ? pusherPlace(body) : body.X_WB.p);
    }
    model_ = grasp::buildGrasp(builder, fingers);
    state_ = grasp::makeState(model_, starts, places);
    scratch_ = grasp::makeScratch(model_);
    for (const Vec3& p : places) {
      inputs_.emplace_back();
      inputs_.back().p_WF = p;
    }
  }

  void step() override {
    if (inputs_.empty()) return count(engine::step(model_.world, state_.world, grasp::worldOf(*scratch_)));
    const double t = h_ * static_cast<double>(++steps_);
    for (std::size_t i = 0; i < inputs_.size(); ++i) {
      const BenchBody& body = world_.bodies[static_cast<std::size_t>(finger_of_[i])];
      const BenchAim aim = body.aim(t);
      inputs_[i].f_W = aim.f_W;
      if (isPad(body)) continue;
      inputs_[i].p_WF = aim.p_W;
      inputs_[i].v_WF = aim.v_W;
    }
    count(grasp::step(model_, state_, *scratch_, inputs_));
  }

  BenchMotion motion(int i) override {
    const int body = body_of_[static_cast<std::size_t>(i)];
    if (body >= 0) {
      return {engine::bodyPose(model_.world, state_.world, body),
              state_.world.bodies[static_cast<std::size_t>(body)].v_W,
              engine::bodyAngularVelocity(model_.world, state_.world, body)};
    }
    for (std::size_t k = 0; k < finger_of_.size(); ++k) {
      if (finger_of_[k] == i)
        return {{Quat::Identity(), state_.world.points[k].p_W}, state_.world.points[k].v_W, Vec3::Zero()};
    }
    return {};
  }

  std::string complaint() override {
    if (status_ == engine::kStepOk) return {};
    return fmt::format("{} of its steps were flagged (status bits {:#x})", flagged_, status_);
  }

 private:
  static engine::WorldOptions optionsOf(const BenchWorld& world, const BenchStep& step) {
    engine::WorldOptions options;
    options.h = step.h;
    options.gravity_W = world.gravity_W;
    options.position_tolerance = step.tolerance;
    options.max_parts = 64;
    options.sleep = false;  // as with the others
    return options;
  }

  int addBody(engine::WorldBuilder& builder, const BenchBody& body, std::vector<engine::BodyStart>& starts) const {
    engine::BodySpec spec;
    spec.name = fmt::format("body {}", starts.size());
    spec.shape = body.shape;
    spec.dynamic = body.kind != BenchKind::kFixed;
    spec.mass = spec.dynamic ? body.mass : 0;
    spec.material = {world_.mu, world_.mu, world_.restitution, 0};
    starts.push_back({body.X_WB, body.v_W, body.w_W});
    const int index = builder.addBody(spec);
    if (body.kind == BenchKind::kHinged)
      builder.addJoint(jointOf(body, index, engine::JointKind::kPivot, body.hinge_W, Vec3::UnitY()));
    if (isPad(body)) {
      const int axis = freeAxisOf(body);
      engine::JointModel slider = jointOf(body, index, engine::JointKind::kSlider, body.X_WB.p, Vec3::Unit(axis));
      slider.damping = body.damping[axis];
      builder.addJoint(slider);
    }
    return index;
  }

  static engine::JointModel jointOf(const BenchBody& body, int index, engine::JointKind kind, const Vec3& p_W,
                                    const Vec3& axis_W) {
    const Pose X_WJ{Quat::FromTwoVectors(Vec3::UnitZ(), axis_W), p_W};
    return {kind, index, -1, body.X_WB.inverse() * X_WJ, X_WJ, 0};
  }

  // On the far side of the pad, in line with its middle.
  static Vec3 pusherPlace(const BenchBody& pad) {
    const int axis = freeAxisOf(pad);
    const double reach = std::get<contact::Box>(pad.shape).half[axis] + kPusherRadius;
    return pad.X_WB.p - std::copysign(reach, pad.aim(0).f_W[axis]) * Vec3::Unit(axis);
  }

  static grasp::FingerModel fingerOf(const BenchBody& body) {
    grasp::FingerModel finger;
    finger.name = "finger";
    finger.radius = isPad(body) ? kPusherRadius : std::get<contact::Sphere>(body.shape).radius;
    finger.coupling.mass = isPad(body) ? kPusherMass : body.mass;
    finger.coupling.stiffness = body.stiffness;
    finger.coupling.damping = isPad(body) ? Vec3(Vec3::Zero()) : body.damping;
    for (int k = 0; k < 3; ++k) finger.coupling.locked[k] = body.locked[static_cast<std::size_t>(k)];
    return finger;
  }

  void count(const engine::StepReport& report) {
    status_ |= report.status;
    flagged_ += report.status != engine::kStepOk;
  }

  BenchWorld world_;
  double h_;
  std::int64_t steps_ = 0, flagged_ = 0;
  std::uint32_t status_ = engine::kStepOk;
  std::vector<int> body_of_;    // per bench body: the engine's, -1 for fingertips
  std::vector<int> finger_of_;  // per finger: the bench body
  grasp::GraspModel model_;
  grasp::GraspState state_;
  grasp::ScratchHandle scratch_;
  std::vector<grasp::FingerInput> inputs_;
};

}  // namespace

std::vector<Contestant> pincerContestants() {
  const auto make = [](const BenchWorld& world, const BenchStep& step) -> std::unique_ptr<BenchEngine> {
    if (world.robot) return pincerRobot(*world.robot, step);
    return std::make_unique<PincerEngine>(world, step);
  };
  const auto always = [](const BenchWorld&) { return std::string(); };
  const auto if_small = [](const BenchWorld& world) {
    return world.bodies.size() > kMostWithin
               ? fmt::format("not run with more than {} bodies, for its cost", kMostWithin)
               : std::string();
  };
  Contestant plain{"pincer", "", {}, true, {}, always, make},
      within{"pincer", "with tolerance", {}, false, {}, if_small, make};
  for (const double tolerance : {1e-7, 1e-9, 1e-11}) within.ladder.push_back({1e-3, tolerance});
  return {plain, within};
}

}  // namespace pincer::tasks
