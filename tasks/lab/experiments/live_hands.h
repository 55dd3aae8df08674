// live_hands: the real arms and displays on a person's fingers, in a trial.
//
// Intents are read from what the person does: who touches the object with both fingers wants to lift it.
#pragma once
#include <vector>

#include "pincer/tasks/lab/experiments/hand_trial.h"
#include "pincer/tasks/lab/experiments/hands.h"
#include "pincer/tasks/lab/finger/answer_box.h"
#include "pincer/tasks/run/servo/hand_devices.h"

namespace pincer::tasks {

class LiveHands final : public Hands {
 public:
  // Both must outlive it. Arms the devices, only after the operator said so, puts their bases where the calibration
  // says, and has the trial keep to what the arms can do and their user's fingers passive (grasp/passivity).
  // `oldest_sample` is still trusted [s]. `keys`: Enter answers; null: nobody answers.
  LiveHands(HandTrial& trial, HandDevices& devices, double oldest_sample = devices::GateLimits{}.watchdog_time,
            AnswerBox* keys = nullptr);
  ~LiveHands() override;  // zero force
  LiveHands(const LiveHands&) = delete;
  LiveHands& operator=(const LiveHands&) = delete;

  void advanceTo(double now) override;
  const std::vector<FingerInputs>& sample() override;
  void apply(const std::vector<FingerOutputs>& outputs, Cue cue, double now) override;
  const HandIntent& intent() const override { return intent_; }
  void stop() noexcept override;

 private:
  void readIntent();

  const HandTrial& trial_;
  HandDevices& devices_;
  AnswerBox* keys_;
  std::vector<Quat> q_DF_;  // of fingers whose arm doesn't measure it
  std::vector<FingerInputs> samples_;
  HandIntent intent_;
  std::int64_t epoch_ns_ = 0;
  bool begun_ = false;
};

}  // namespace pincer::tasks
