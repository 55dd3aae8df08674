// study_parameters: every parameter of every study, named once, with its meaning and range: reading, writing,
// checking and documenting a study file follow these lists. A list calls visit(key, field, Parameter) in the order
// of the file; a field that is an object or a list of objects has a list of its own. What two parameters demand of
// each other is in the studies' validate().
#pragma once
#include <array>
#include <cstdint>
#include <limits>

#include "pincer/tasks/lab/experiments/arc_study.h"
#include "pincer/tasks/lab/experiments/localisation.h"
#include "pincer/tasks/lab/experiments/manipulation_study.h"
#include "pincer/tasks/lab/experiments/shape_study.h"
#include "pincer/tasks/lab/study/parameter.h"
#include "pincer/tasks/lab/study/survey.h"

namespace pincer::tasks {

// Remedy of every number of a published design.
inline constexpr std::string_view kAsPublished = "Leave it out for the published design.";
// all 64 bits are read, kept and written
inline constexpr std::uint64_t kLargestSeed = std::numeric_limits<std::uint64_t>::max();

// Words of choices in study files, by the enum of each.
inline constexpr std::array<std::string_view, 6> kHandShadingNames = {"task",  "smooth",           "facet",
                                                                      "force", "smooth_published", "exactly"};
inline constexpr std::array<std::string_view, 2> kHandTaskNames = {"sphere-pickup", "cylinder-alignment"};
inline constexpr std::array<std::string_view, 2> kStrategyNames = {"rational", "simple"};
inline constexpr std::array<std::string_view, 3> kTactorUseNames = {"place", "slip", "nothing"};
inline constexpr std::span<const std::string_view> kCurveVariantNames =
    std::span(contact::kSurfaceVariantNames).first(3);

// Levels that a condition can show lie within half a radian, 50 mm, half a second (arc_study.cpp asks that of each).
inline constexpr NumberRule kLevel = {0, 1, false, kAsPublished};
inline constexpr NumberRule kStep = {1e-9, 1, false, kAsPublished};

template <class T, class Of>
concept FieldsOf = std::same_as<std::remove_const_t<T>, Of>;

// Words of a survey's and an order's choices, by the enum of each.
inline constexpr std::array<std::string_view, 4> kAnswerKindNames = {"scale", "number", "choice", "text"};
inline constexpr std::array<std::string_view, 3> kConditionOrderNames = {"balanced", "listed", "shuffled"};
inline constexpr std::array<std::string_view, 3> kAskedForNames = {"session", "condition", "task and condition"};

template <FieldsOf<SurveyItem> Item, class Visit>
void visitParameters(Item& i, Visit&& visit) {
  constexpr NumberRule kBound = {-1e9, 1e9, false, "Leave it out for 1 to 7."};  // in the question's unit; chosen
  visit("name", i.name, Parameter{"in tables"});
  visit("text", i.text, Parameter{"that the person reads"});
  visit("kind", i.kind, Parameter{"of answer", {}, kAnswerKindNames});
  visit("low", i.low, Parameter{"of a scale or a number", kBound});
  visit("high", i.high, Parameter{"likewise", kBound});
  visit("low_label", i.low_label, Parameter{"of a scale's lower end"});
  visit("high_label", i.high_label, Parameter{"of its upper end"});
  visit("choices", i.choices, Parameter{"of a choice; none: the study's conditions"});
  visit("per", i.per,
        Parameter{"asked once, of each condition, or of each task in each condition", {}, kAskedForNames});
  visit("required", i.required, Parameter{"false: an empty answer will do"});
}

template <FieldsOf<SurveyPlan> Plan, class Visit>
void visitParameters(Plan& p, Visit&& visit) {
  visit("order", p.order,
        Parameter{"of the conditions: balanced over participants, as listed, or shuffled by the seed",
                  {},
                  kConditionOrderNames});
  visit("blocks", p.blocks,
        Parameter{"how often a participant goes through all conditions", {1, 100, false, "1 is usual."}});
  visit("instructions", p.instructions, Parameter{"lines read before each condition, in place of the program's own"});
  visit("training", p.training,
        Parameter{"trials before each condition of an experiment with one finger", {0, 100, false, "1 is usual."}});
  visit("demographics", p.demographics, Parameter{"asked before the first trial"});
  visit("survey", p.survey, Parameter{"asked after the last"});
}

template <FieldsOf<StaircaseRule> Rule, class Visit>
void visitParameters(Rule& r, Visit&& visit) {
  visit("up", r.up, Parameter{"wrong answers in a row until the level rises", {1, 100}});
  visit("down", r.down, Parameter{"right answers in a row until it falls", {1, 100}});
  visit("start", r.start, Parameter{"first level, in the condition's unit [rad, m or s], as all levels", kLevel});
  visit("large_step", r.large_step, Parameter{"step at first", kStep});
  visit("small_step", r.small_step, Parameter{"step after `large_reversals`", kStep});
  visit("steps_are_ratios", r.steps_are_ratios, Parameter{"true: the level is multiplied or divided by 1 + step"});
  visit("large_reversals", r.large_reversals, Parameter{"reversals until steps are small", {0, 1000}});
  visit("reversals", r.reversals, Parameter{"then the staircase is over", {1, 1000}});
  visit("averaged", r.averaged,
        Parameter{"of them, the last, whose mean is the threshold; at most `reversals`", {1, 1000}});
  visit("lowest", r.lowest, Parameter{"level; below `highest`", kLevel});
  visit("highest", r.highest, Parameter{"level", kLevel});
  visit("most_trials", r.most_trials, Parameter{"then it is over in any case", {1, 100'000}});
}

template <FieldsOf<ArcCondition> Condition, class Visit>
void visitParameters(Condition& c, Visit&& visit) {
  visit("name", c.name,
        Parameter{"one of the published design begins with its values, a new one with those of the first"});
  visit("label", c.label, Parameter{"in the report"});
  visit("force", c.force, Parameter{"how the force feels the polygon", {}, kCurveVariantNames});
  visit("tactile", c.tactile, Parameter{"how the tactor does; null: it is parked", {}, kCurveVariantNames});
  visit("edge", c.edge, Parameter{"true: the edge in place of the arc"});
  visit("travel_share", c.travel_share,
        Parameter{"of a sweep's travel, after which the tactor freezes; 1: never", {0, 1, true}});
  visit("staircase", c.staircase, Parameter{"that chooses the levels"});
  visit("published", c.published,
        Parameter{"threshold, beside which the measured one is shown [segments, m or s]; null: none",
                  {0, 1e6, false, kAsPublished},
                  {},
                  true});
  visit("pilot", c.pilot, Parameter{"true: done after the other conditions"});
}

template <FieldsOf<ArcStudy> Study, class Visit>
void visitParameters(Study& s, Visit&& visit) {
  visit("participants", s.participants, Parameter{"how many", {1, 10'000, false, kAsPublished}});
  visit("seed", s.seed, Parameter{"of all that varies"});
  visit("finger_radius", s.finger_radius, Parameter{"[m]", {2e-3, 0.05, false, kAsPublished}});
  visit("arc_radius", s.arc_radius, Parameter{"of the curve that is stroked [m]", {0.01, 0.2, false, kAsPublished}});
  visit("edge_angle", s.edge_angle, Parameter{"of the edge, a blade [rad]", {0.0175, 3.14159, false, kAsPublished}});
  visit("tactor_reach", s.tactor_reach,
        Parameter{"either way, at most `finger_radius` [m]", {0, 8e-3, true, kAsPublished}});
  visit("reference_turn", s.reference_turn,
        Parameter{"from segment to segment of the reference [rad]", {1e-4, 0.1, false, kAsPublished}});
  visit("stiffness", s.stiffness, Parameter{"of the surface [N/m]", {0, 3500, true, kAsPublished}});
  visit("strokes", s.strokes, Parameter{"per interval, an even number", {2, 100, false, kAsPublished}});
  visit("frozen_tactor", s.frozen_tactor, Parameter{"true: the tactor is parked in every condition (a control)"});
  visit("conditions", s.conditions, Parameter{"a list replaces all of them"});
  visit("session", s.session, Parameter{"what people read, train and are asked; simulated participants none of it"});
}

template <FieldsOf<LocalisationCondition> Condition, class Visit>
void visitParameters(Condition& c, Visit&& visit) {
  visit("name", c.name,
        Parameter{"one of the published design begins with its values, a new one with those of the first"});
  visit("label", c.label, Parameter{"in the report"});
  visit("radius_min", c.radius_min,
        Parameter{"of the second cylinder [m]; at most `radius_max`", {0.02, 0.2, false, kAsPublished}});
  visit("radius_max", c.radius_max, Parameter{"[m]", {0.02, 0.2, false, kAsPublished}});
  visit("backlash", c.backlash, Parameter{"added to the display's own [m]", {0, 0.05, false, kAsPublished}});
  visit("delay", c.delay, Parameter{"likewise [s], in steps of 0.001", {0, 0.512, false, kAsPublished}});
  visit("published", c.published,
        Parameter{"mean absolute error, beside which the measured one is shown [m]; null: none",
                  {0, 0.1, false, kAsPublished},
                  {},
                  true});
}

template <FieldsOf<LocalisationStudy> Study, class Visit>
void visitParameters(Study& s, Visit&& visit) {
  visit("participants", s.participants, Parameter{"how many", {1, 10'000, false, kAsPublished}});
  visit("seed", s.seed, Parameter{"of all that varies"});
  visit("places", s.places, Parameter{"of the tactor, in a row", {2, 50, false, kAsPublished}});
  visit("spacing", s.spacing, Parameter{"from one to the next [m]; all within 0.016", {0, 0.016, true, kAsPublished}});
  visit("repetitions", s.repetitions, Parameter{"of each place", {1, 1000, false, kAsPublished}});
  visit("least_travel", s.least_travel, Parameter{"of the tactor to its place [m]", {0, 7.9e-3, false, kAsPublished}});
  visit("base_radius", s.base_radius, Parameter{"of the first cylinder [m]", {0.02, 0.2, false, kAsPublished}});
  visit("finger_radius", s.finger_radius, Parameter{"[m]", {8e-3, 0.05, false, kAsPublished}});
  visit("stiffness", s.stiffness, Parameter{"of the surface [N/m]", {0, 3500, true, kAsPublished}});
  visit("conditions", s.conditions, Parameter{"a list replaces all of them"});
  visit("session", s.session, Parameter{"what people read, train and are asked; simulated participants none of it"});
}

template <FieldsOf<SolidSizes> Sizes, class Visit>
void visitParameters(Sizes& s, Visit&& visit) {
  visit("radius", s.radius, Parameter{"of round ones [m]", {0.02, 0.045, false, kAsPublished}});
  visit("length", s.length, Parameter{"[m]", {0.04, 0.09, false, kAsPublished}});
  visit("edge_radius", s.edge_radius, Parameter{"of shaded ones' edges [m]", {0, 5e-3, true, kAsPublished}});
  visit("sides", s.sides, Parameter{"of shaded round ones, an even number", {12, 200, false, kAsPublished}});
  visit("facet_sides", s.facet_sides,
        Parameter{"of round ones that aren't shaded, an even number", {12, 360, false, kAsPublished}});
}

template <FieldsOf<ShapeCondition> Condition, class Visit>
void visitParameters(Condition& c, Visit&& visit) {
  visit("name", c.name,
        Parameter{"one of the published design begins with its values, a new one with those of the first"});
  visit("label", c.label, Parameter{"in the report"});
  visit("shaded", c.shaded, Parameter{"false: flat facets"});
  visit("display_tactile", c.display_tactile, Parameter{"false: the tactor is parked"});
  visit("group", c.group,
        Parameter{"conditions of one group are mixed trial by trial; `session.order` orders groups", {1, 100}});
  visit("published", c.published,
        Parameter{"share of right answers, beside which the measured one is shown; null: none", {0, 1}, {}, true});
}

template <FieldsOf<ShapeStudy> Study, class Visit>
void visitParameters(Study& s, Visit&& visit) {
  visit("participants", s.participants, Parameter{"how many", {1, 10'000, false, kAsPublished}});
  visit("seed", s.seed, Parameter{"of all that varies"});
  visit("sessions", s.sessions,
        Parameter{"per participant, of two runs of each group of conditions", {1, 100, false, kAsPublished}});
  visit("sizes", s.sizes, Parameter{"of the solids"});
  visit("friction", s.friction, Parameter{"of the solids", {0, 2, false, kAsPublished}});
  visit("finger_radius", s.finger_radius, Parameter{"[m]", {8e-3, 0.03, false, kAsPublished}});
  visit("stiffness", s.stiffness, Parameter{"of finger and proxy [N/m]", {0, 3500, true, kAsPublished}});
  visit("tactor_reach", s.tactor_reach, Parameter{"either way [m]", {0, 8e-3, true, kAsPublished}});
  visit("frozen_tactor", s.frozen_tactor, Parameter{"true: the tactor is parked in every condition (a control)"});
  visit("unrelated", s.unrelated, Parameter{"true: the model that is felt is drawn, whatever is asked (a control)"});
  visit("conditions", s.conditions, Parameter{"a list replaces all of them"});
  visit("session", s.session, Parameter{"what people read, train and are asked; simulated participants none of it"});
}

template <FieldsOf<HandSetup> Hand, class Visit>
void visitParameters(Hand& h, Visit&& visit) {
  visit("finger_radius", h.finger_radius,
        Parameter{"[m]", {0.002, 0.02, false, "It is in metres; a fingertip has 0.008."}});
  visit("coupling_stiffness", h.coupling_stiffness,
        Parameter{"of finger and proxy [N/m]",
                  {50, 3500, false, "More than 3500 the arm can't render stably; 1000 is usual."}});
  visit("coupling_damping", h.coupling_damping,
        Parameter{"[N s/m]", {0, 30, false, "More than 30 the arm can't render stably; 5 is usual."}});
  visit("twist_stiffness", h.twist_stiffness,
        Parameter{"of the pads about their contact normals [N m/rad]; 0 with no twist_damping: rigid",
                  {0, 10, false, "0.3 is usual."}});
  visit("twist_damping", h.twist_damping, Parameter{"[N m s/rad]", {0, 1, false, "0.001 is usual."}});
}

template <FieldsOf<HandCondition> Condition, class Visit>
void visitParameters(Condition& c, Visit&& visit) {
  visit("name", c.name,
        Parameter{"one of the published design begins with its values, a new one with those of the first"});
  visit("label", c.label, Parameter{"that people read"});
  visit("display_tactile", c.display_tactile, Parameter{"false: the tactors are parked"});
  visit("shading", c.shading,
        Parameter{
            "how fingers feel the objects; task: as the task says, exactly: by closed form", {}, kHandShadingNames});
  visit("mass_ratio", c.mass_ratio,
        Parameter{"mass of the objects over the task's", {0.01, 100, false, "1 leaves the task's mass."}});
}

template <FieldsOf<SpherePickupOptions> Options, class Visit>
void visitParameters(Options& o, Visit&& visit) {
  visit("radius", o.radius,
        Parameter{"of the sphere [m]", {0.005, 0.05, false, "It is in metres; the usual sphere has 0.02."}});
  visit("mass", o.mass,
        Parameter{"of the object [kg]", {0.001, 1, false, "It is in kilograms; the usual sphere has 0.075."}});
  visit("dynamic_ratio", o.dynamic_ratio,
        Parameter{"mu_d / mu_s",
                  {0.01, 1, false, "Dynamic friction is at most static friction; 0.85 is the usual ratio."}});
  visit("torsion_radius", o.torsion_radius,
        Parameter{"of a soft fingertip's patch [m]",
                  {0, 0.02, false, "It is in metres; a fingertip has 0.0033, a point contact 0."}});
  visit("dish_radius", o.dish_radius,
        Parameter{"of curvature [m]", {0.1, 10, false, "It is in metres; the usual dish has 0.15."}});
  visit("dish_friction", o.dish_friction,
        Parameter{"mu of the dish", {0, 5, false, "A friction coefficient; the usual dish has 0.5."}});
  visitParameters(o.hand, visit);
  visit("success_height", o.success_height,
        Parameter{"[m]", {0.005, 0.08, false, "It is in metres, within the arms' reach; 0.05 is the usual height."}});
  visit("hold_time", o.hold_time,
        Parameter{"at that height [s]", {0, 10, false, "It is in seconds; 1 is the usual time."}});
  visit("timeout", o.timeout,
        Parameter{"[s]; censored data", {1, 600, false, "It is in seconds; 60 is the usual time."}});
  visit("repetitions", o.repetitions,
        Parameter{"of every friction per condition",
                  {1, 1000, false, "Every friction is done so often in each condition; 5 is usual."}});
  visit("frictions", o.frictions,
        Parameter{"mu_s of the object",
                  {0.05, 5, false, "A static friction coefficient; skin on plastic has about 0.6."}});
  visit("object", o.object, Parameter{"a closed mesh in place of the sphere"});
  visit("shading", o.shading,
        Parameter{"how fingers feel the sphere, a mesh; null: its closed form", {}, contact::kSurfaceVariantNames});
}

template <FieldsOf<ObjectFile> Object, class Visit>
void visitParameters(Object& o, Visit&& visit) {
  visit("path", o.path, Parameter{"of the file: OBJ, STL, PLY or OFF"});
  visit("units", o.units, Parameter{"of the file: m, cm, mm, in; doesn't count where there is a `size`"});
  visit("size", o.size,
        Parameter{"of its largest dimension [m]",
                  {0.005, 0.2, false, "It is the object's largest dimension in metres; 0.06 suits a hand."}});
  visit("shading", o.shading, Parameter{"how fingers feel it", {}, contact::kSurfaceVariantNames});
}

template <FieldsOf<CylinderAlignmentOptions> Options, class Visit>
void visitParameters(Options& o, Visit&& visit) {
  visit("radius", o.radius,
        Parameter{"of the cylinder [m]", {0.01, 0.05, false, "It is in metres; the usual cylinder has 0.02."}});
  visit("length", o.length, Parameter{"[m]", {0.02, 0.2, false, "It is in metres; the usual cylinder has 0.08."}});
  visit("mass", o.mass, Parameter{"[kg]", {0.01, 1, false, "It is in kilograms; the usual cylinder has 0.15."}});
  visit("flat_half_angle", o.flat_half_angle,
        Parameter{"half of what the flat takes of the circle [rad]",
                  {0.2, 1.2, false, "It is in radians; the usual flat has 0.7854, 45 degrees."}});
  visit("friction", o.friction,
        Parameter{"mu_s of the cylinder",
                  {0.05, 5, false, "A static friction coefficient; skin on plastic has about 0.6."}});
  visit("dynamic_ratio", o.dynamic_ratio,
        Parameter{"mu_d / mu_s",
                  {0.01, 1, false, "Dynamic friction is at most static friction; 0.85 is the usual ratio."}});
  visit("torsion_radius", o.torsion_radius,
        Parameter{"of a soft fingertip's patch [m]",
                  {0, 0.02, false, "It is in metres; a fingertip has 0.0033, a point contact 0."}});
  visit("pivot", o.pivot, Parameter{"false: free on a table"});
  visit("pivot_damping", o.pivot_damping, Parameter{"[N m s/rad]", {0, 0.1, false, "The usual pivot has 0.01."}});
  visit("table_friction", o.table_friction,
        Parameter{"mu of the table under a free cylinder",
                  {0, 5, false, "A friction coefficient; the usual table has 0.5."}});
  visitParameters(o.hand, visit);
  visit("shading", o.shading,
        Parameter{"how fingers feel the cylinder, a mesh; null: its closed form", {}, contact::kSurfaceVariantNames});
  visit("start_min", o.start_min,
        Parameter{"of the flat's start from its target, either way [rad]",
                  {0, 3.1416, false, "It is in radians; 0.7854, 45 degrees, is usual."}});
  visit("start_max", o.start_max,
        Parameter{"[rad]; at least `start_min`",
                  {0, 3.1416, false, "It is in radians, at least start_min; 3.1416 is usual."}});
  visit("timeout", o.timeout,
        Parameter{"[s]; censored data", {1, 600, false, "It is in seconds; 120 is the usual time."}});
  visit("repetitions", o.repetitions,
        Parameter{"per condition", {1, 1000, false, "So many trials are done in each condition; 10 is usual."}});
}

template <FieldsOf<TrainingTrials> Training, class Visit>
void visitParameters(Training& t, Visit&& visit) {
  visit("pickups", t.pickups, Parameter{"per condition, before the counted ones", {0, 100, false, "2 is usual."}});
  visit("alignments", t.alignments, Parameter{"likewise", {0, 100, false, "1 is usual."}});
}

template <FieldsOf<ParticipantModel> Model, class Visit>
void visitParameters(Model& m, Visit&& visit) {
  visit("strategy", m.strategy, Parameter{"of simulated participants", {}, kStrategyNames});
  visit("tactor_use", m.limits.tactor_use,
        Parameter{
            "what tactors tell: where fingers are touched; only that something slips; nothing", {}, kTactorUseNames});
  forEachParameter(m, [&](std::string_view key, auto& value, double low, double high, std::string_view unit) {
    const std::string meaning = unit.empty() ? "" : fmt::format("[{}]", unit);
    visit(key, value, Parameter{meaning, {low, high, false, "Leave it out for the default."}});
  });
}

template <FieldsOf<ManipulationStudy> Study, class Visit>
void visitParameters(Study& s, Visit&& visit) {
  visit("participants", s.participants, Parameter{"how many", {1, 1000, false, "The published study had 12."}});
  visit("seed", s.seed, Parameter{"of all that varies"});
  visit("conditions", s.conditions,
        Parameter{"a list replaces all of them; by `session.order` each participant's order"});
  visit("tasks", s.tasks, Parameter{"in this order, in one condition, then in the other", {}, kHandTaskNames});
  visit("frozen_tactor", s.frozen_tactor, Parameter{"true: the tactors stay parked in every condition (a control)"});
  visit("training", s.training, Parameter{"trials that don't count"});
  visit("sphere_pickup", s.pickup, Parameter{"the one task"});
  visit("cylinder_alignment", s.alignment, Parameter{"the other"});
  visit("people", s.people, Parameter{"the simulated participants"});
  visit("session", s.session, Parameter{"what people read, train and are asked; simulated participants none of it"});
}

// True of fields that have a list of their own.
template <class Object>
concept HasParameters = std::is_class_v<Object> && requires(Object& object) {
  visitParameters(object, [](std::string_view, auto&, const Parameter&) {});
};

}  // namespace pincer::tasks
