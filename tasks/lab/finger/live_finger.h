// live_finger: a real arm and display on a person's finger, in a trial with one finger; the
// keys are the window's or the terminal's.
#pragma once
#include "pincer/tasks/lab/finger/answer_box.h"
#include "pincer/tasks/lab/finger/worn_finger.h"
#include "pincer/tasks/run/servo/hand_devices.h"

namespace pincer::tasks {

class LiveFinger final : public WornFinger {
 public:
  // Both must outlive it. Arms the device, only after the operator said so. `oldest_sample` is still trusted [s].
  LiveFinger(const FingerPlace& place, HandDevices& devices, AnswerBox& keys, double oldest_sample);
  ~LiveFinger() override;  // zero force
  LiveFinger(const LiveFinger&) = delete;
  LiveFinger& operator=(const LiveFinger&) = delete;

  const FingerWear& wear() const override { return wear_; }
  void advanceTo(double now) override;
  const FingerInputs& sample() override;
  FingerDeed apply(const FingerOutputs& outputs, Cue cue, double now) override;
  void setTransmission(const devices::VirtualTransmission& transmission) override { transmission_ = transmission; }
  double tactorPlace() const override { return tactor_place_; }
  void stop() noexcept override;

 private:
  HandDevices& devices_;
  AnswerBox& keys_;
  FingerWear wear_;
  std::optional<Quat> q_DF_;  // of an arm that doesn't measure it
  FingerInputs inputs_;
  devices::VirtualTransmission transmission_;
  devices::TransmissionState transmission_state_;
  double tactor_place_ = 0;  // [m]
  std::int64_t epoch_ns_ = 0;
  bool begun_ = false;
};

}  // namespace pincer::tasks
