#include "tasks/bench/finger_scene.h"

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
      scratch_(model_),
      device_(p_WF) {}

const grasp::FingerReport& FingerScene::tick(const Vec3& p_WF) {
  grasp::FingerInput input;
  input.p_WF = p_WF;
  input.v_WF = (p_WF - device_) / model_.world.options.h;
  device_ = p_WF;
  flagged_ += grasp::step(model_, state_, scratch_, std::array{input}).status != engine::kStepOk;
  return scratch_.fingers.front();
}

bool FingerScene::isLocked() const {
  const std::vector<engine::Contact>& contacts = scratch_.world.contacts;
  for (auto x = contacts.begin(); x != contacts.end(); ++x) {
    for (auto y = x + 1; y != contacts.end(); ++y) {
      if (!x->active() || !y->active()) continue;
      const double tan_alpha = (x->n_W() + y->n_W()).norm() / (x->n_W() - y->n_W()).norm();
      if (std::min(x->material.mu_s, y->material.mu_s) > tan_alpha) return true;
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
