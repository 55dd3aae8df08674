// tick: where devices and physics meet. A pure function: the same model, state and samples give the same bits, in a
// live session, in a batch and in a replay.
//
//   device samples -> finger poses -> grasp step -> passivity -> last gate -> forces for the arms, places for the CLDs
//
// Passivity works on all fingers together, so it stands here and not in the gate of one
// arm; it watches what the gate let through.
#pragma once
#include <array>
#include <cstdint>
#include <vector>

#include "pincer/devices/arm/arm.h"
#include "pincer/devices/cld/pad_policy.h"
#include "pincer/devices/cld/tactile_display.h"
#include "pincer/devices/gate/force_gate.h"
#include "pincer/grasp/passivity.h"
#include "pincer/grasp/step.h"

namespace pincer::tasks {

// One hand's finger on its arm.
struct FingerMount {
  Pose X_WD;  // arm base in the world (calibration data)
  devices::GateLimits gate;
  devices::PadPolicy pad;
  bool display_tactile = true;  // false: the force-only condition, the tactor stays parked
};

// Stands for a device's pose at a tick whose sample is older than the tick: the sample (zero-order hold), or the sample
// led on with its velocity (first-order hold), for `most_lead` at the most.
enum class PoseHold : std::uint8_t { kZero, kFirst };

struct TickModel {
  grasp::GraspModel grasp;
  std::vector<FingerMount> mounts;  // one per finger
  double velocity_cutoff = 60;      // of the low-pass on finger velocity [Hz]
  PoseHold pose_hold = PoseHold::kZero;
  double most_lead = 3e-3;            // [s]
  grasp::PassivityOptions passivity;  // off unless switched on: simulated arms need none, motors do
};

struct FingerInputs {
  devices::ArmSample arm;
  devices::TactileSample tactile;
};

// Per finger: what the device side of the tick remembers.
struct MountState {
  bool seen = false;                              // a valid sample has come
  Vec3 p_WF = Vec3::Zero(), v_WF = Vec3::Zero();  // last finger pose, filtered velocity
  Quat q_DF = Quat::Identity();                   // last orientation on the arm
  double sample_time = 0;
  Vec3 f_lead_W = Vec3::Zero();  // what leads the hand somewhere, besides what it touches; set by the experiment [N]
  devices::GateState gate;
  devices::PadState pad;
};

struct TickState {
  grasp::GraspState grasp;
  std::vector<MountState> mounts;
  grasp::PassivityState passivity;  // with one port per finger; empty: nobody watches
};

struct FingerOutputs {
  Vec3 f_D = Vec3::Zero();  // gated force for the arm [N]
  devices::TactileCommand tactile;
};

struct TickScratch {
  explicit TickScratch(const TickModel& model);
  grasp::ScratchHandle grasp;
  std::vector<grasp::FingerInput> inputs;
  std::vector<Vec3> p_WF, f_user_W;  // of the fingers, for passivity
  // The tick's results, one per finger.
  std::vector<FingerOutputs> outputs;
  std::span<const grasp::FingerReport> fingers;  // what they felt, and still do where nothing changed
};

// One tick at time `now` [s, the clock of the samples]. Results in scratch.outputs and
// scratch.fingers. Allocates nothing, throws nothing.
engine::StepReport tick(const TickModel& model, TickState& state, TickScratch& scratch,
                        const std::vector<FingerInputs>& inputs, double now);

}  // namespace pincer::tasks
