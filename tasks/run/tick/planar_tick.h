// planar_tick: the tick of the experiments in the plane: one round fingertip on a curve. A
// pure function, as tasks/run/tick/tick.h.
//
//   arm's sample -> p_BC -> contact with the force curve -> f_W = k max(0, -phi) n ->
//   passivity, last gate -> force for the arm
//                        -> contact with the tactile curve -> place s = r (a - pitch), |s| <= largest place -> tactor
//
//   B    the plane x = 0 of W along the finger, (y, z), its origin the curve's;  C  the fingertip's
//        centre;  r  its radius [m];  k  stiffness [N/m]
//   phi  gap [m];  n  outward normal;  a  angle of the contact on the fingertip [rad]
//   s    place on the pad [m of arc, distal positive]
// Force and place may follow two different curves (contact/curve/curve.h): shading is a property of what is
// shown, per sense. The surface has no friction. The place is shown before contact too: on an open curve
// the nearest point is where contact will begin. Source of the set-up: A. J. Doxon, D. E. Johnson, H. Z.
// Tan, W. R. Provancher, Presence 20(6), 2011.
#pragma once
#include <memory>

#include "pincer/contact/curve/curve.h"
#include "pincer/devices/arm/arm.h"
#include "pincer/devices/cld/tactile_display.h"
#include "pincer/devices/gate/force_gate.h"
#include "pincer/grasp/passivity.h"

namespace pincer::tasks {

// The stimulus that is shown; exchanged between two intervals of a trial.
struct PlanarStimulus {
  std::shared_ptr<const contact::Curve> force;    // never null
  std::shared_ptr<const contact::Curve> tactile;  // null: the tactor is parked
  double largest_place = 8e-3;                    // of the tactor, either way [m]
};

struct PlanarTickModel {
  Pose X_WD;                    // arm base in the world (calibration data)
  double finger_radius = 0.02;  // r [m]
  double stiffness = 1000;      // k [N/m]
  double velocity_cutoff = 20;  // of the low-pass on the finger's speed [Hz]
  devices::GateLimits gate;
  grasp::PassivityOptions passivity;  // off unless switched on: simulated arms need none, motors do
};

struct PlanarTickState {
  bool seen = false;  // a valid sample has come
  Vec3 p_WF = Vec3::Zero(), v_WF = Vec3::Zero();
  double pitch = 0;  // of the finger about W's x axis, tip up, by the gimbal [rad]; 0 where the arm tells none
  double sample_time = 0;
  contact::CurveTracker force_tracker, tactile_tracker;
  devices::GateState gate;
  grasp::PassivityState passivity;  // with one port; empty: nobody watches
};

struct PlanarTickOutput {
  contact::CurveContact contact;  // with the force curve
  double normal_force = 0;        // wanted [N]
  Vec3 f_W = Vec3::Zero();        // wanted [N]
  Vec3 f_D = Vec3::Zero();        // gated force for the arm [N]
  devices::TactileCommand tactile;
  bool ok = true;  // false: the contact isn't finite; the gate has tripped
};

// One tick of `dt` seconds at time `now` [s, the clock of the samples]. Allocates nothing, throws nothing.
PlanarTickOutput planarTick(const PlanarTickModel& model, const PlanarStimulus& stimulus, PlanarTickState& state,
                            const devices::ArmSample& sample, double now, double dt);

}  // namespace pincer::tasks
