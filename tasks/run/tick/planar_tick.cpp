#include "pincer/tasks/run/tick/planar_tick.h"

#include <algorithm>
#include <cmath>
#include <numbers>

#include "pincer/contact/functions/invariants.h"

namespace pincer::tasks {
namespace {

// Of a rotation about the x axis.
double pitchOf(const Quat& q_WF) { return 2 * math::atan2(q_WF.x(), q_WF.w()); }

// A sample that can't be used leaves the finger where it was; the gate trips on it.
void locatePlanarFinger(const PlanarTickModel& model, PlanarTickState& state, const devices::ArmSample& sample) {
  if (!sample.valid || !devices::isFinite(sample)) return;
  const Vec3 p_WF = model.X_WD * sample.p_DF;
  const double dt = sample.time - state.sample_time;
  if (state.seen && dt > 0) {
    const double share = -math::expm1(-2 * std::numbers::pi * model.velocity_cutoff * dt);
    state.v_WF += share * ((p_WF - state.p_WF) / dt - state.v_WF);
  }
  state.p_WF = p_WF;
  state.pitch = sample.q_DF ? pitchOf(model.X_WD.q * *sample.q_DF) : 0;
  state.sample_time = sample.time;
  state.seen = true;
}

devices::TactileCommand tactorPlace(const PlanarTickModel& model, const PlanarStimulus& stimulus,
                                    PlanarTickState& state, const Vec2& p_BC, double felt_angle) {
  if (!stimulus.tactile) return {true, Vec2::Zero()};
  const bool same = stimulus.tactile == stimulus.force;
  const double angle =
      same ? felt_angle : stimulus.tactile->queryCircle(p_BC, model.finger_radius, state.tactile_tracker).finger_angle;
  return {
      false,
      {std::clamp(model.finger_radius * (angle - state.pitch), -stimulus.largest_place, stimulus.largest_place), 0}};
}

Vec3 gatedPlanarForce(const PlanarTickModel& model, PlanarTickState& state, const devices::ArmSample& sample,
                      const PlanarTickOutput& out, double now, double dt) {
  devices::GateInput in;
  in.f_D = model.X_WD.q.conjugate() * out.f_W;
  in.sample = sample;
  in.v_DF = model.X_WD.q.conjugate() * state.v_WF;
  in.now = now;
  in.dt = dt;
  in.physics_ok = out.ok;
  return devices::gateForce(model.gate, in, state.gate);
}

// As the tick of tasks/run/tick/tick.cpp does it: before the gate the wanted
// force, the wall's spring being what is stored.
void keepPlanarPassive(const PlanarTickModel& model, PlanarTickState& state, double depth, double dt, Vec3& f_W) {
  if (state.passivity.ports.empty()) return;
  const double stored = 0.5 * model.stiffness * depth * depth;
  grasp::observePorts(model.passivity, std::span(&state.p_WF, 1), stored, dt, state.passivity);
  grasp::controlPorts(model.passivity, dt, state.passivity, std::span(&f_W, 1));
}

// And behind it the force that the motors will hold.
void watchPlanarPort(const PlanarTickModel& model, PlanarTickState& state, const Vec3& f_D) {
  if (state.passivity.ports.empty()) return;
  const Vec3 held_W = model.X_WD.q * f_D;
  grasp::holdPorts(std::span(&held_W, 1), state.passivity);
}

}  // namespace

PlanarTickOutput planarTick(const PlanarTickModel& model, const PlanarStimulus& stimulus, PlanarTickState& state,
                            const devices::ArmSample& sample, double now, double dt) {
  PINCER_DEMAND(stimulus.force, "planarTick: the stimulus has a curve to feel");
  PINCER_DEMAND(dt > 0, "planarTick: the tick's length is positive");
  locatePlanarFinger(model, state, sample);
  const Vec2 p_BC(state.p_WF.y(), state.p_WF.z());
  PlanarTickOutput out;
  out.contact = stimulus.force->queryCircle(p_BC, model.finger_radius, state.force_tracker);
  out.normal_force = model.stiffness * std::max(0.0, -out.contact.phi);
  out.f_W = out.normal_force * Vec3(0, out.contact.n_B.x(), out.contact.n_B.y());
  keepPlanarPassive(model, state, std::max(0.0, -out.contact.phi), dt, out.f_W);
  out.ok = out.f_W.allFinite();
  out.tactile = tactorPlace(model, stimulus, state, p_BC, out.contact.finger_angle);
  out.f_D = gatedPlanarForce(model, state, sample, out, now, dt);
  watchPlanarPort(model, state, out.f_D);
  return out;
}

}  // namespace pincer::tasks
