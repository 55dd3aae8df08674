// live_hands: the real arms and displays on a person's fingers, in a trial's loop.
//
// What the person means to do is read from what they do: who touches the object with both fingers wants to lift it.
#pragma once
#include <vector>

#include "tasks/experiments/hand_scene.h"
#include "tasks/servo/hand_devices.h"

namespace pincer::tasks {

class LiveHands {
 public:
  // Arms the devices: only after the operator said so.
  LiveHands(const HandScene& scene, HandDevices& devices);
  ~LiveHands();  // zero force
  LiveHands(const LiveHands&) = delete;
  LiveHands& operator=(const LiveHands&) = delete;

  // The latest samples at `now` [s of the servo].
  const std::vector<FingerInputs>& sample(double now);
  void apply(const std::vector<FingerOutputs>& outputs, Cue cue);
  HandIntent intent(const TickScratch& scratch, int object) const;
  void stop() noexcept;  // from any thread

 private:
  HandDevices& devices_;
  std::vector<Quat> q_DF_;  // of fingers whose arm doesn't measure it
  std::vector<FingerInputs> samples_;
  std::int64_t epoch_ns_ = 0;
  bool begun_ = false;
};

}  // namespace pincer::tasks
