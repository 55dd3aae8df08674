#include "pincer/tasks/judge/bench/finger_scene.h"

#include <array>

namespace pincer::tasks {
namespace {

grasp::GraspModel buildModel(contact::Shape shape, const engine::Material& material) {
  engine::WorldOptions options;
  options.gravity_W = Vec3::Zero();
  engine::WorldBuilder builder(options);
  builder.addBody({"object", std::move(shape), false, 0, material});
  grasp::FingerModel finger;
  finger.name = "finger";
  finger.coupling.stiffness = Vec3::Constant(FingerScene::kStiffness);
  finger.coupling.damping = Vec3::Zero();
  return grasp::buildGrasp(std::move(builder), {finger});
}

}  // namespace

FingerScene::FingerScene(contact::Shape shape, const engine::Material& material, const Vec3& p_WF)
    : model_(buildModel(std::move(shape), material)),
      state_(grasp::makeState(model_, {engine::BodyStart{}}, {p_WF})),
      scratch_(grasp::makeScratch(model_)),
      device_(p_WF) {}

const grasp::FingerReport& FingerScene::tick(const Vec3& p_WF) {
  grasp::FingerInput input;
  input.p_WF = p_WF;
  input.v_WF = (p_WF - device_) / model_.world.options.h;
  device_ = p_WF;
  const grasp::GraspReport report = grasp::step(model_, state_, *scratch_, std::array{input});
  flagged_ += report.status != engine::kStepOk;
  return report.fingers.front();
}

bool FingerScene::isLocked() const {
  const engine::WorldScratch& world = grasp::worldOf(*scratch_);
  const double mu_s = model_.world.colliders.front().material.mu_s;
  for (int i = 0; i < engine::contactCount(world); ++i) {
    const engine::ContactReport x = engine::contactAt(world, i);
    for (int j = 0; j < i; ++j) {
      const engine::ContactReport y = engine::contactAt(world, j);
      if (x.pushes && y.pushes && mu_s > (x.n_W + y.n_W).norm() / (x.n_W - y.n_W).norm()) return true;
    }
  }
  return false;
}

void FingerScene::leadTo(const Vec3& p_WF) {
  constexpr double kStep = 1e-4;  // [m] per tick
  const Vec3 from = device_;
  const int ticks = static_cast<int>((p_WF - from).norm() / kStep) + 1;
  for (int i = 1; i <= ticks; ++i) tick(from + (p_WF - from) * i / ticks);
}

}  // namespace pincer::tasks
