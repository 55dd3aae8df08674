#include "pincer/tasks/lab/experiments/mouse_hands.h"

#include "pincer/devices/window/input.h"

namespace pincer::tasks {
namespace {

std::vector<devices::MouseMount> mountsIn(const HandScene& scene) {
  std::vector<devices::MouseMount> mounts;
  for (std::size_t i = 0; i < kHandFingers; ++i) {
    const Pose& X_WD = scene.model.mounts[i].X_WD;
    mounts.push_back({X_WD.q, X_WD.p, scene.homes_W[i], scene.q_DF[i]});
  }
  return mounts;
}

}  // namespace

MouseHands::MouseHands(const HandScene& scene, AnswerBox* keys)
    : hand_(mountsIn(scene)), displays_(kHandFingers), samples_(kHandFingers), keys_(keys) {
  intent_.phase = HandPhase::kReach;
}

void MouseHands::advanceTo(double now) {
  const double dt = now - time_;
  if (!(dt > 0)) return;
  time_ = now;
  hand_.advance(dt);
  for (auto& display : displays_) display.advance(dt);
}

const std::vector<FingerInputs>& MouseHands::sample() {
  for (std::size_t i = 0; i < samples_.size(); ++i)
    samples_[i] = {hand_.arm(static_cast<int>(i)).sample(), displays_[i].sample()};
  intent_.wants_lift = hand_.squeezing();
  intent_.answers = keys_ && keys_->take() == devices::kKeyEnter;
  intent_.phase = intent_.wants_lift ? HandPhase::kSqueeze : HandPhase::kReach;
  return samples_;
}

void MouseHands::apply(const std::vector<FingerOutputs>& outputs, Cue cue, double) {
  for (std::size_t i = 0; i < samples_.size(); ++i) {
    hand_.arm(static_cast<int>(i)).commandForce(outputs[i].f_D);
    displays_[i].command(outputs[i].tactile);
  }
  if (cue == Cue::kSuccess || cue == Cue::kEnd) hand_.goHome();
}

}  // namespace pincer::tasks
