// observer_fields: the parameters of the simulated participants of the studies with one finger, each named once:
// written into the session and hashed before a study, never read. A list calls visit(key, field).
#pragma once
#include "pincer/tasks/lab/participants/place_observer.h"
#include "pincer/tasks/lab/participants/shape_explorer.h"
#include "pincer/tasks/lab/participants/stroke_observer.h"

namespace pincer::tasks {

template <class Visit>
void visitFields(const HandRanges& r, Visit&& visit) {
  visit("mass_min", r.mass_min);
  visit("mass_max", r.mass_max);
  visit("stiffness_min", r.stiffness_min);
  visit("stiffness_max", r.stiffness_max);
  visit("damping_min", r.damping_min);
  visit("damping_max", r.damping_max);
  visit("speed_min", r.speed_min);
  visit("speed_max", r.speed_max);
}

template <class Visit>
void visitFields(const SensingLimits& l, Visit&& visit) {
  visit("tactor_sd", l.tactor_sd);
  visit("tactor_bias", l.tactor_bias);
  visit("tactor_moves", l.tactor_moves);
  visit("orientation_sd", l.orientation_sd);
  visit("placement_sd", l.placement_sd);
  visit("placement_between_sd", l.placement_between_sd);
  visit("direction_sd", l.direction_sd);
  visit("force_sd", l.force_sd);
  visit("force_floor", l.force_floor);
  visit("force_lag", l.force_lag);
  visit("reflex_time", l.reflex_time);
  visit("reading_time", l.reading_time);
  visit("reaction_time", l.reaction_time);
}

template <class Visit>
void visitFields(const SkinLimits& l, Visit&& visit) {
  visit("stiffness", l.stiffness);
  visit("mass", l.mass);
  visit("damping", l.damping);
  visit("slow_threshold", l.slow_threshold);
  visit("quick_threshold", l.quick_threshold);
  visit("difference", l.difference);
}

template <class Visit>
void visitFields(const LagLimits& l, Visit&& visit) {
  visit("way_sd", l.way_sd);
  visit("place_sd", l.place_sd);
  visit("time_sd", l.time_sd);
  visit("difference", l.difference);
  visit("masking", l.masking);
  visit("tactor_moves", l.tactor_moves);
}

template <class Visit>
void visitFields(const StrokeLimits& l, Visit&& visit) {
  visit("skin", l.skin);
  visit("common", l.common);
  visit("tactor_weight", l.tactor_weight);
  visit("lag", l.lag);
  visit("sensitivity_spread", l.sensitivity_spread);
  visit("press", l.press);
  visit("press_time", l.press_time);
  visit("lower_time", l.lower_time);
  visit("raise_time", l.raise_time);
  visit("lift", l.lift);
  visit("ramp_time", l.ramp_time);
  visit("rest_time", l.rest_time);
  visit("probe_min", l.probe_min);
  visit("probe_max", l.probe_max);
  visit("roll_min", l.roll_min);
  visit("roll_max", l.roll_max);
}

template <class Visit>
void visitFields(const ShapeLimits& l, Visit&& visit) {
  visit("common", l.common);
  visit("place_sd", l.place_sd);
  visit("press", l.press);
  visit("sure", l.sure);
  visit("size_sd", l.size_sd);
  visit("most_rounds", l.most_rounds);
  visit("distance", l.distance);
  visit("approach_speed", l.approach_speed);
  visit("tilt_min", l.tilt_min);
  visit("tilt_max", l.tilt_max);
}

template <class Visit>
void visitFields(const PlaceLimits& l, Visit&& visit) {
  visit("common", l.common);
  visit("reading_sd", l.reading_sd);
  visit("memory_draw", l.memory_draw);
  visit("match_tolerance", l.match_tolerance);
  visit("correction_time", l.correction_time);
  visit("hold_time", l.hold_time);
  visit("press", l.press);
  visit("lower_time", l.lower_time);
  visit("raise_time", l.raise_time);
  visit("lift", l.lift);
}

}  // namespace pincer::tasks
