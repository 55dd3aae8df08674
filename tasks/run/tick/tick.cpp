#include "pincer/tasks/run/tick/tick.h"

#include <algorithm>
#include <cmath>
#include <numbers>

#include "pincer/contact/functions/invariants.h"
#include "pincer/grasp/energy_ledger.h"

namespace pincer::tasks {
namespace {

// Low-pass of the measured or differenced velocity; first order, so that it never overshoots.
Vec3 filteredVelocity(const TickModel& model, const MountState& mount, const devices::ArmSample& sample,
                      const Vec3& p_WF, const Mat3& R_WD) {
  const double dt = sample.time - mount.sample_time;
  if (!mount.seen || !(dt > 0)) return mount.v_WF;
  const Vec3 raw_W = sample.v_DF ? Vec3(R_WD * *sample.v_DF) : Vec3((p_WF - mount.p_WF) / dt);
  PINCER_ASSERT(model.velocity_cutoff > 0);
  const double share = -math::expm1(-2 * std::numbers::pi * model.velocity_cutoff * dt);
  return mount.v_WF + share * (raw_W - mount.v_WF);
}

// D -> W. A sample that can't be used leaves the finger where it was; the gate trips on it.
void locateFinger(const TickModel& model, TickState& state, int i, const devices::ArmSample& sample, double now,
                  grasp::FingerInput& input) {
  MountState& mount = state.mounts[i];
  const Pose& X_WD = model.mounts[i].X_WD;
  PINCER_ASSERT(X_WD.p.allFinite() && isUnit(X_WD.q));
  const bool usable = sample.valid && devices::isFinite(sample);
  if (usable) {
    const Vec3 p_WF = X_WD * sample.p_DF;
    mount.v_WF = filteredVelocity(model, mount, sample, p_WF, X_WD.q.toRotationMatrix());
    if (!mount.seen) {  // the proxy starts where the finger is
      engine::PointState& proxy = state.grasp.world.points[i];
      proxy.p_W = proxy.p_target_W = p_WF;
      state.grasp.fingers[i].seen = false;  // nor has it turned there
    }
    mount.p_WF = p_WF;
    mount.sample_time = sample.time;
    mount.seen = true;
    // A gimbal that says nothing for a tick hasn't turned back: that would drag along whatever the finger touches.
    if (sample.q_DF) mount.q_DF = *sample.q_DF;
  } else {
    mount.v_WF.setZero();
    if (!mount.seen) mount.p_WF = state.grasp.world.points[i].p_W;
  }
  const double lead =
      model.pose_hold == PoseHold::kFirst ? std::clamp(now - mount.sample_time, 0.0, model.most_lead) : 0;
  input = {mount.p_WF + lead * mount.v_WF, mount.v_WF, X_WD.q * mount.q_DF, Vec3::Zero()};
}

Vec3 gatedForce(const TickModel& model, MountState& mount, const FingerMount& config, const devices::ArmSample& sample,
                const Vec3& f_user_W, double now, std::uint32_t status) {
  devices::GateInput in;
  in.f_D = config.X_WD.q.conjugate() * f_user_W;
  in.sample = sample;
  in.v_DF = config.X_WD.q.conjugate() * mount.v_WF;
  in.now = now;
  in.dt = model.grasp.world.options.h;
  // Impulses that didn't converge are still energy-safe; only what makes the numbers meaningless is a fault.
  in.physics_ok = (status & (engine::kStateNotFinite | engine::kInputNotFinite)) == 0;
  return devices::gateForce(config.gate, in, mount.gate);
}

// Before the gate: what it changes in the wanted forces is limited like they are.
void keepPassive(const TickModel& model, TickState& state, TickScratch& scratch) {
  if (state.passivity.ports.size() != model.mounts.size()) return;
  const double h = model.grasp.world.options.h;
  for (std::size_t i = 0; i < model.mounts.size(); ++i) scratch.p_WF[i] = state.mounts[i].p_WF;
  grasp::observePorts(model.passivity, scratch.p_WF, grasp::storedEnergy(model.grasp, state.grasp), h, state.passivity);
  grasp::controlPorts(model.passivity, h, state.passivity, scratch.f_user_W);
}

// After it: what the motors will hold is what counts.
void watchPorts(const TickModel& model, TickState& state, TickScratch& scratch) {
  if (state.passivity.ports.size() != model.mounts.size()) return;
  for (std::size_t i = 0; i < model.mounts.size(); ++i)
    scratch.f_user_W[i] = model.mounts[i].X_WD.q * scratch.outputs[i].f_D;
  grasp::holdPorts(scratch.f_user_W, state.passivity);
}

devices::TactileCommand tactorTarget(const TickModel& model, MountState& mount, const FingerMount& config,
                                     const grasp::FingerModel& shape, const grasp::FingerReport& finger) {
  devices::PadInput in;
  in.parked = !config.display_tactile;
  if (finger.touching) {
    in.contacts[0] = {grasp::placeOnPad(shape, finger.touch), finger.normal_force};
    in.contact_count = 1;
  }
  in.nearest = devices::NearestPoint{grasp::placeOnPad(shape, finger.nearest), finger.gap};
  return devices::padCommand(config.pad, in, model.grasp.world.options.h, mount.pad);
}

}  // namespace

TickScratch::TickScratch(const TickModel& model)
    : grasp(grasp::makeScratch(model.grasp)),
      inputs(model.mounts.size()),
      p_WF(model.mounts.size()),
      f_user_W(model.mounts.size()),
      outputs(model.mounts.size()),
      fingers(grasp::fingersOf(*grasp)) {}

engine::StepReport tick(const TickModel& model, TickState& state, TickScratch& scratch,
                        const std::vector<FingerInputs>& inputs, double now) {
  PINCER_DEMAND(model.mounts.size() == model.grasp.fingers.size(), "tick: one mount per finger");
  PINCER_DEMAND(inputs.size() == model.mounts.size(), "tick: one pair of samples per finger");
  PINCER_DEMAND(state.mounts.size() == model.mounts.size() && scratch.outputs.size() == model.mounts.size(),
                "tick: state and scratch are those of this model");
  const int n = static_cast<int>(model.mounts.size());
  for (int i = 0; i < n; ++i) locateFinger(model, state, i, inputs[i].arm, now, scratch.inputs[i]);
  const grasp::GraspReport report = grasp::step(model.grasp, state.grasp, *scratch.grasp, scratch.inputs);
  scratch.fingers = report.fingers;
  for (int i = 0; i < n; ++i) scratch.f_user_W[i] = scratch.fingers[i].f_user_W;
  keepPassive(model, state, scratch);
  for (int i = 0; i < n; ++i) {
    const grasp::FingerReport& finger = scratch.fingers[i];
    scratch.outputs[i].f_D = gatedForce(model, state.mounts[i], model.mounts[i], inputs[i].arm,
                                        scratch.f_user_W[i] + state.mounts[i].f_lead_W, now, report.status);
    scratch.outputs[i].tactile = tactorTarget(model, state.mounts[i], model.mounts[i], model.grasp.fingers[i], finger);
  }
  watchPorts(model, state, scratch);
  return report;
}

}  // namespace pincer::tasks
