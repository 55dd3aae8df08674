// simulation: a scene in motion, one tick at a time.
#pragma once
#include <cstdint>
#include <optional>
#include <span>
#include <vector>

#include "pincer/tasks/run/scene.h"

namespace pincer::tasks {

class Simulation {
 public:
  // Builds the world. Throws InputError.
  explicit Simulation(Scene scene);

  // Fingers to where their trajectories are at the tick's end, then one step. Allocates nothing, throws nothing.
  engine::StepReport tick();
  // The same with the fingers' devices where the caller says, one entry per finger, and pushes on bodies; where fingers
  // are rendered by a published method (SceneFinger::method), these do nothing.
  engine::StepReport tick(std::span<const grasp::FingerInput> fingers, const engine::AppliedForces& applied = {});
  // Targets of the fingers' trajectories for the next tick.
  std::span<const grasp::FingerInput> nextFingers();

  std::int64_t ticks() const { return ticks_; }                                   // done so far
  double time() const { return static_cast<double>(ticks_) * scene_.options.h; }  // [s]
  const Scene& scene() const { return scene_; }
  const grasp::GraspModel& model() const { return model_; }
  const grasp::GraspState& state() const { return state_; }
  grasp::GraspScratch& scratch() { return *scratch_; }
  const grasp::GraspScratch& scratch() const { return *scratch_; }  // as the last tick left it
  std::span<const grasp::FingerReport> fingers() const { return grasp::fingersOf(*scratch_); }  // of the last tick
  Moment moment() const { return {model_, state_, fingers(), scene_.starts, *scratch_, scene_.frames}; }
  Pose bodyPose(int body) const { return engine::bodyPose(model_.world, state_.world, body); }  // X_WB

 private:
  Scene scene_;
  grasp::GraspModel model_;
  grasp::GraspState state_;
  grasp::ScratchHandle scratch_;
  std::optional<grasp::BaselineFingers> baselines_;  // where some finger is rendered as published
  std::vector<grasp::FingerInput> inputs_;
  std::vector<engine::MotionInput> motions_;
  std::vector<engine::DriveInput> controls_;
  std::int64_t ticks_ = 0;
};

}  // namespace pincer::tasks
