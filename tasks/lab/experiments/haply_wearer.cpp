#include "pincer/tasks/lab/experiments/haply_wearer.h"

#include "pincer/devices/haply/haply_session.h"
#include "pincer/tasks/lab/experiments/pickup_object.h"
#include "pincer/tasks/lab/experiments/pickup_scene.h"

namespace pincer::tasks {
namespace {

constexpr double kStartsAfter = 2.2;  // after the test force [s]: the gate's ramp, and the start tone
constexpr double kSameForce = 1e-5;   // of single precision [N]

bool isTestForce(devices::emulate::HaplyPlant& plant) {
  return (plant.force_H() - Vec3(0, 0, devices::haply::kEchoForce)).norm() < kSameForce;
}

}  // namespace

HaplyWearer::HaplyWearer(devices::emulate::HaplyService& service) {
  const SpherePickupOptions options;
  const HandScene scene = makePickupScene(options, makePickupObject(options), PickupTrialSpec{});
  cues_ = scene.cues;
  for (std::size_t i = 0; i < kHandFingers; ++i) service.plant(i).arm().setGimbal(scene.q_DF[i]);
  participant_.begin(cues_);
}

void HaplyWearer::act(devices::emulate::HaplyService& service) {
  time_ += 1e-3;
  const bool tested = isTestForce(service.plant(0)) && isTestForce(service.plant(1));
  if (tested && !tested_) {
    participant_.begin(cues_);
    starts_ = time_ + kStartsAfter;
  }
  tested_ = tested;
  Percept percept;
  percept.time = time_;
  for (std::size_t i = 0; i < kHandFingers; ++i)
    percept.fingers[i] = {service.plant(i).arm().sample(), service.plant(i).force_D(), devices::TactileSample{}};
  if (starts_ > 0 && time_ >= starts_) {
    percept.cue = Cue::kStart;
    starts_ = -1;
  }
  const HandAction action = participant_.act(percept);
  for (std::size_t i = 0; i < kHandFingers; ++i) service.plant(i).arm().setHand(action.pulls[i]);
}

}  // namespace pincer::tasks
