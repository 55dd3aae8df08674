// study_fields: each parameter of a study named once; reading and writing its JSON both follow these lists. A list calls visit(key, field).
#pragma once
#include "tasks/experiments/arc_study.h"
#include "tasks/experiments/localisation.h"
#include "tasks/experiments/shape_study.h"
#include "tasks/participants/place_observer.h"

namespace pincer::tasks {

template <class Rule, class Visit>
requires std::same_as<std::remove_const_t<Rule>, StaircaseRule>
void visitFields(Rule& r, Visit&& visit) {
  visit("up", r.up);
  visit("down", r.down);
  visit("start", r.start);
  visit("large_step", r.large_step);
  visit("small_step", r.small_step);
  visit("steps_are_ratios", r.steps_are_ratios);
  visit("large_reversals", r.large_reversals);
  visit("reversals", r.reversals);
  visit("averaged", r.averaged);
  visit("lowest", r.lowest);
  visit("highest", r.highest);
  visit("most_trials", r.most_trials);
}

template <class Condition, class Visit>
requires std::same_as<std::remove_const_t<Condition>, ArcCondition>
void visitFields(Condition& c, Visit&& visit) {
  visit("name", c.name);
  visit("label", c.label);
  visit("force", c.force);
  visit("tactile", c.tactile);
  visit("edge", c.edge);
  visit("travel_share", c.travel_share);
  visit("staircase", c.staircase);
  visit("published", c.published);
}

template <class Study, class Visit>
requires std::same_as<std::remove_const_t<Study>, ArcStudy>
void visitFields(Study& s, Visit&& visit) {
  visit("participants", s.participants);
  visit("seed", s.seed);
  visit("finger_radius", s.finger_radius);
  visit("arc_radius", s.arc_radius);
  visit("edge_angle", s.edge_angle);
  visit("edge_radius", s.edge_radius);
  visit("tactor_reach", s.tactor_reach);
  visit("reference_turn", s.reference_turn);
  visit("stiffness", s.stiffness);
  visit("strokes", s.strokes);
  visit("conditions", s.conditions);
}

template <class Study, class Visit>
requires std::same_as<std::remove_const_t<Study>, LocalisationStudy>
void visitFields(Study& s, Visit&& visit) {
  visit("participants", s.participants);
  visit("seed", s.seed);
  visit("places", s.places);
  visit("spacing", s.spacing);
  visit("repetitions", s.repetitions);
  visit("least_travel", s.least_travel);
  visit("radius_min", s.radius_min);
  visit("radius_max", s.radius_max);
  visit("finger_radius", s.finger_radius);
  visit("stiffness", s.stiffness);
  visit("published_error", s.published_error);
}

template <class Sizes, class Visit>
requires std::same_as<std::remove_const_t<Sizes>, SolidSizes>
void visitFields(Sizes& s, Visit&& visit) {
  visit("radius", s.radius);
  visit("length", s.length);
  visit("edge_radius", s.edge_radius);
  visit("sides", s.sides);
}

template <class Condition, class Visit>
requires std::same_as<std::remove_const_t<Condition>, ShapeCondition>
void visitFields(Condition& c, Visit&& visit) {
  visit("name", c.name);
  visit("label", c.label);
  visit("shaded", c.shaded);
  visit("display_tactile", c.display_tactile);
  visit("published", c.published);
}

template <class Study, class Visit>
requires std::same_as<std::remove_const_t<Study>, ShapeStudy>
void visitFields(Study& s, Visit&& visit) {
  visit("participants", s.participants);
  visit("seed", s.seed);
  visit("runs", s.runs);
  visit("sizes", s.sizes);
  visit("friction", s.friction);
  visit("finger_radius", s.finger_radius);
  visit("stiffness", s.stiffness);
  visit("conditions", s.conditions);
}

// The simulated participants' parameters: written, never read, since they are frozen before a study.
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
void visitFields(const StrokeLimits& l, Visit&& visit) {
  visit("skin", l.skin);
  visit("common", l.common);
  visit("lag_sigma", l.lag_sigma);
  visit("lag_difference", l.lag_difference);
  visit("sensitivity_spread", l.sensitivity_spread);
  visit("press", l.press);
  visit("press_time", l.press_time);
  visit("lower_time", l.lower_time);
  visit("raise_time", l.raise_time);
  visit("lift", l.lift);
}

template <class Visit>
void visitFields(const ShapeLimits& l, Visit&& visit) {
  visit("common", l.common);
  visit("place_sd", l.place_sd);
  visit("press", l.press);
  visit("sure", l.sure);
  visit("most_passes", l.most_passes);
  visit("distance", l.distance);
  visit("approach_speed", l.approach_speed);
}

template <class Visit>
void visitFields(const PlaceLimits& l, Visit&& visit) {
  visit("common", l.common);
  visit("press", l.press);
  visit("lower_time", l.lower_time);
  visit("raise_time", l.raise_time);
  visit("lift", l.lift);
}

}  // namespace pincer::tasks
