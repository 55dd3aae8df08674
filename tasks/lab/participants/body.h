// body: what a hand is made of and what it can't feel exactly. Every figure says where it comes from: a source, the
// design of the tasks, or a choice of ours.
#pragma once
#include <array>
#include <cstdint>

#include "pincer/devices/arm/sim_arm.h"
#include "pincer/tasks/lab/participants/participant.h"
#include "pincer/tasks/lab/participants/random.h"

namespace pincer::tasks {

// Hands differ; each finger's impedance is drawn once per participant, uniformly between these.
// The ranges of mass, stiffness and damping are the design's (no source checked yet).
struct HandRanges {
  double mass_min = 0.05, mass_max = 0.10;          // [kg]
  double stiffness_min = 200, stiffness_max = 600;  // [N/m]
  double damping_min = 2, damping_max = 5;          // [N s/m]
  // mean speed of a reach [m/s]; A. J. Doxon, dissertation, Univ. of Utah, 2014
  double speed_min = 0.032, speed_max = 0.074;
};

// The use of the tactors: where the fingers are touched; only that the contact runs over the pad while something is
// held, which is a cue of slip; nothing. The latter two are controls.
enum class TactorUse : std::uint8_t { kPlace, kSlip, kNothing };

// Sensing limits. Noise is drawn once per deliberate reading, never per tick; what
// is "constant in a trial" once per trial.
struct SensingLimits {
  TactorUse tactor_use = TactorUse::kPlace;
  double tactor_sd = 1.63e-3;  // place on the pad, per axis [m]: 1.3 mm mean absolute error x sqrt(pi/2) (Doxon 2014)
  double tactor_bias = 0.9;  // felt place over true place, towards the centre [-] (Doxon 2014, direction; size: choice)
  double tactor_moves = 0.2e-3;  // a tactor that has moved less than this since the start is felt as still [m] (choice)
  double orientation_sd = 0.0524;  // felt finger orientation, per axis, constant in a trial [rad], 3 degrees (choice)
  double placement_sd = 7e-3;      // of the pinch line, per axis, constant in a trial [m] (choice)
  double placement_between_sd = 4e-3;  // between the fingers, per axis, constant in a trial [m] (choice)
  double direction_sd = 0.349;  // of a felt force's direction, per axis [rad], 20 degrees (design: 28.4 / sqrt 2)
  double force_sd = 0.10;       // of a felt magnitude, relative [-] (design; no source checked yet)
  double force_floor = 0.1;     // a lighter touch isn't felt [N] (choice)
  double force_lag = 0.02;      // time constant of felt force [s] (choice)
  // of a felt fingertip against the other, per axis of a reading [m]: 1.5 mm over sqrt 2, the difference limen of
  // finger span at 40 mm (N. I. Durlach et al., Percept. Psychophys. 46(1), 1989; cited from memory)
  double span_sd = 1.06e-3;
  double target_shared_sd = 0.14;  // of where the monitor is felt to be, constant in a person [rad], 8 degrees (choice)
  double target_trial_sd = 0.09;   // likewise, constant in a trial [rad], 5 degrees (choice)
  double reflex_time = 0.07;       // from a loss of force to its effect [s] (design; no source checked yet)
  double reading_time = 0.35;      // a deliberate reading [s] (choice)
  double reaction_time = 0.25;     // to a tone [s] (choice)
};

// One participant's constants.
struct Body {
  std::array<devices::HandPull, kHandFingers> hands;  // p_D unused
  double speed = 0.05;                                // mean speed of a reach [m/s]
};
// A small rotation whose components are independent with standard deviation `sd` [rad].
Quat drawRotation(double sd, Random& random);

Body drawBody(const HandRanges& ranges, std::uint64_t seed);

// Errors of the body's sense of itself in one trial.
struct BodySense {
  std::array<Vec3, kHandFingers> misplacement_W;  // true minus felt place of a fingertip [m]
  std::array<Quat, kHandFingers> q_felt_true;     // felt minus true orientation, in W
};
BodySense drawBodySense(const SensingLimits& limits, Random& random);

}  // namespace pincer::tasks
