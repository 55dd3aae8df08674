// participant_model: everything that makes simulated participants what they are, in one value: frozen, written down and
// hashed before the first trial of a study. No parameter may be chosen for what comes out.
//
//   forEachParameter(model, visit)   calls visit(name, value, low, high, unit) for each number; the study
//                                    file, the session and the hash follow it
// Sources and choices: body.h and the strategies' headers.
#pragma once
#include <memory>
#include <string>

#include "pincer/tasks/lab/participants/body.h"
#include "pincer/tasks/lab/participants/scripted_alignment.h"
#include "pincer/tasks/lab/participants/scripted_pickup.h"

namespace pincer::tasks {

enum class Strategy : std::uint8_t { kRational, kSimple };

struct ParticipantModel {
  Strategy strategy = Strategy::kRational;
  double cld_speed = 1;  // speed with the contact location display over that without [-]: 1 is the primary analysis
  SensingLimits limits;
  HandRanges hands;
  ScriptedPickupOptions pickup;
  ScriptedAlignmentOptions alignment;
};

template <class Model, class Visit>
void forEachParameter(Model& m, Visit&& visit) {
  visit("cld_speed", m.cld_speed, 0.1, 10.0, "");
  auto& l = m.limits;
  visit("tactor_sd", l.tactor_sd, 0.0, 1e3, "m");
  visit("tactor_bias", l.tactor_bias, 0.1, 2.0, "");
  visit("tactor_moves", l.tactor_moves, 0.0, 1e3, "m");
  visit("orientation_sd", l.orientation_sd, 0.0, 1.0, "rad");
  visit("placement_sd", l.placement_sd, 0.0, 0.03, "m");
  visit("placement_between_sd", l.placement_between_sd, 0.0, 0.03, "m");
  visit("direction_sd", l.direction_sd, 0.0, 3.0, "rad");
  visit("force_sd", l.force_sd, 0.0, 0.5, "");
  visit("force_floor", l.force_floor, 0.01, 1.0, "N");
  visit("force_lag", l.force_lag, 0.0, 0.2, "s");
  visit("span_sd", l.span_sd, 0.0, 0.02, "m");
  visit("target_shared_sd", l.target_shared_sd, 0.0, 1.0, "rad");
  visit("target_trial_sd", l.target_trial_sd, 0.0, 1.0, "rad");
  visit("reflex_time", l.reflex_time, 0.01, 1.0, "s");
  visit("reading_time", l.reading_time, 0.0, 5.0, "s");
  visit("reaction_time", l.reaction_time, 0.0, 5.0, "s");
  auto& h = m.hands;
  visit("hand_mass_min", h.mass_min, 0.02, 0.3, "kg");
  visit("hand_mass_max", h.mass_max, 0.02, 0.3, "kg");
  visit("hand_stiffness_min", h.stiffness_min, 50.0, 2000.0, "N/m");
  visit("hand_stiffness_max", h.stiffness_max, 50.0, 2000.0, "N/m");
  visit("hand_damping_min", h.damping_min, 0.5, 20.0, "N s/m");
  visit("hand_damping_max", h.damping_max, 0.5, 20.0, "N s/m");
  visit("speed_min", h.speed_min, 0.005, 0.5, "m/s");
  visit("speed_max", h.speed_max, 0.005, 0.5, "m/s");
  auto& p = m.pickup;
  visit("pickup_shift_threshold", p.shift_threshold, 0.0, 0.05, "m");
  visit("pickup_shift_gain", p.shift_gain, 0.0, 2.0, "");
  visit("pickup_random_shift_sd", p.random_shift_sd, 0.0, 0.05, "m");
  visit("pickup_search_shift_sd", p.search_shift_sd, 0.0, 0.05, "m");
  visit("pickup_farthest_shift", p.farthest_shift, 0.0, 0.05, "m");
  visit("pickup_object_rolls_sd", p.object_rolls_sd, 0.0, 0.05, "m");
  visit("pickup_expected_mu", p.expected_mu, 0.05, 5.0, "");
  visit("pickup_grip_safety", p.grip_safety, 0.5, 10.0, "");
  visit("pickup_grip_growth", p.grip_growth, 1.0, 3.0, "");
  visit("pickup_grip_max", p.grip_max, 0.5, 8.0, "N");
  visit("pickup_squeeze_rate", p.squeeze_rate, 0.2, 50.0, "N/s");
  auto& a = m.alignment;
  visit("alignment_reach_angle", a.reach_angle, 0.3, 1.4, "rad");
  visit("alignment_sure", a.sure, 0.01, 1.0, "rad");
  visit("alignment_close_enough", a.close_enough, 0.0, 1.0, "rad");
  visit("alignment_turn_grip", a.turn_grip, 0.2, 8.0, "N");
  visit("alignment_turn_error", a.turn_error, 0.0, 1.0, "");
  visit("alignment_probe_sd", a.probe_sd, 0.0, 1.0, "rad");
}

const char* nameOf(Strategy strategy);  // "rational", "simple"
const char* nameOf(TactorUse use);      // "place", "slip", "nothing"

// Every parameter with its value, as one JSON object, and its FNV-1a hash: equal models, equal hashes.
std::string describe(const ParticipantModel& model);
std::string hashOf(const ParticipantModel& model);

enum class HandTask : std::uint8_t { kPickup, kAlignment };

// The person of `seed`, for a trial of a task. `with_cld`: only what the person
// knows anyway, whether the tactors are on.
std::unique_ptr<Participant> makeParticipant(const ParticipantModel& model, HandTask task, std::uint64_t seed,
                                             bool with_cld);

}  // namespace pincer::tasks
