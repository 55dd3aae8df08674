// bench_grasp: fingers on bodies, led tick by tick, with what every tick must keep to watched in every tick.
#pragma once
#include <optional>
#include <vector>

#include "pincer/grasp/baseline.h"
#include "pincer/grasp/step.h"

namespace pincer::tasks {

inline constexpr double kBenchTip = 8e-3;   // radius of a fingertip [m]
inline constexpr double kGraspTick = 1e-3;  // [s]

// A massless tip behind 1000 N/m and 5 N s/m.
grasp::FingerModel benchFinger(const char* name, double stiffness = 1000, double damping = 5);

class BenchGrasp {
 public:
  // No methods: all are ours.
  BenchGrasp(engine::WorldBuilder builder, const std::vector<engine::BodyStart>& bodies,
             std::vector<grasp::FingerModel> fingers, const std::vector<Vec3>& devices,
             const std::vector<grasp::FingerMethod>& methods = {});

  // One tick, each device where leadFinger put it.
  engine::StepReport tick();
  // The device of a finger at the end of the next tick; its velocity follows from where it was.
  void leadFinger(int finger, const Vec3& p_WF);
  // All devices straight from where they are to `p_WF` in `ticks` ticks.
  void leadAll(const std::vector<Vec3>& p_WF, int ticks);

  std::vector<grasp::FingerInput> inputs;
  grasp::GraspModel model;
  grasp::GraspState state;
  grasp::ScratchHandle scratch;

  const grasp::FingerReport& felt(int finger) const {
    return grasp::fingersOf(*scratch)[static_cast<std::size_t>(finger)];
  }
  Pose body(int i) const { return engine::bodyPose(model.world, state.world, i); }

  double coneExcess() const { return cone_excess_; }  // largest |f_t| / (mu f_n) - 1 of any contact in any tick [-]
  // ticks in which a body's impulse wasn't the fingers' negative, to the bit
  int reactionErrors() const { return reaction_errors_; }
  int flagged() const { return flagged_; }  // ticks that the step complained of

 private:
  void watch();
  std::optional<grasp::BaselineFingers> baselines_;
  double cone_excess_ = -1;
  int reaction_errors_ = 0, flagged_ = 0;
};

// World without gravity, or with it.
engine::WorldOptions benchWorld(bool gravity, bool sleep = false);

}  // namespace pincer::tasks
