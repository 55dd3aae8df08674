#include "pincer/tasks/lab/participants/scripted_pickup.h"

#include <algorithm>
#include <cmath>
#include <limits>

namespace pincer::tasks {
namespace {

constexpr double kNothingRead = std::numeric_limits<double>::quiet_NaN();  // NaN: no reading yet

PlaceModel placeModelOf(const TrialCues& cues, const SensingLimits& limits, const ScriptedPickupOptions& options) {
  constexpr double kBothFingers = 0.7071;  // the mean of two independent readings
  const double radius = cues.fingers[0].tip_radius;
  PlaceModel model;
  model.lever = radius + cues.half_width;
  model.weight = cues.mass * options.gravity;
  model.placement_sd = std::max(limits.placement_sd, 1e-3);
  model.place_sd =
      std::max(kBothFingers * model.lever * math::hypot(limits.tactor_sd / radius, limits.orientation_sd), 5e-4);
  model.place_gain = limits.tactor_bias;
  model.rolls_sd = options.object_rolls_sd;
  model.height_sd = std::max(limits.placement_between_sd, 1e-3);
  model.push_sd = std::max(kBothFingers * limits.direction_sd, 0.02);
  return model;
}

}  // namespace

ScriptedPickup::ScriptedPickup(std::uint64_t seed, const ScriptedPickupOptions& options, const SensingLimits& limits,
                               const HandRanges& ranges, bool rational)
    : ScriptedHand(seed, limits, ranges, options.settle_time), options_(options), rational_(rational) {}

void ScriptedPickup::begin(const TrialCues& cues) {
  beginHand(cues);
  side_W_ = Vec3::UnitZ().cross(axis_W_);
  believed_W_ = cues.place_W;
  step_W_.setZero();
  wanted_grip_ = options_.grip_safety * cues.mass * options_.gravity / (2 * options_.expected_mu);
  shifts_ = 0;
  if (rational_) belief_.begin(placeModelOf(cues, limits_, options_), random_);
}

void ScriptedPickup::mean(HandIntent& intent) const {
  intent.wants_lift = phase_ == HandPhase::kSqueeze || phase_ == HandPhase::kLift || phase_ == HandPhase::kHold;
}

void ScriptedPickup::listen() {
  if (heardStart()) enterReach(besideThePinch(), HandPhase::kReach);
}

void ScriptedPickup::goAlong() {
  if (phase_ == HandPhase::kReach && standsOnDish()) return;
  posture_ = reach_.at(now_);
  if (reach_.over(now_)) enter(phase_ == HandPhase::kReach ? HandPhase::kClose : HandPhase::kRest);
}

// Inwards; a finger that touches alone waits for the other. Fingertips that meet have found nothing between them.
void ScriptedPickup::close() {
  if (standsOnDish()) return;
  const double step = options_.close_speed * dt_;
  posture_.half -= step;
  if (touch_.feels(0) != touch_.feels(1)) {
    const Vec3 shift_W = (touch_.feels(0) ? -step : step) * axis_W_;
    posture_.centre_W += shift_W;
    believed_W_ += shift_W;
  }
  contact_time_ = touch_.feelsBoth() ? contact_time_ + dt_ : 0;
  if (contact_time_ >= options_.contact_time) return enter(HandPhase::kRead);
  if (posture_.half <= cues_.fingers[0].tip_radius) retry(options_.search_shift_sd);
}

void ScriptedPickup::read() {
  if (now_ < entered_ + limits_.reading_time) return;
  const auto offset_W = touch_.readPlace(random_);
  rational_ ? readRationally(offset_W) : readSimply(offset_W);
  if (phase_ != HandPhase::kRead) return;
  felt_factor_ = 1 + limits_.force_sd * random_.normal();
  enter(HandPhase::kSqueeze);
}

void ScriptedPickup::readSimply(const std::optional<Vec3>& offset_W) {
  const Vec3 percept_W = offset_W.value_or(Vec3::Constant(kNothingRead));
  const bool shift = offset_W && offset_W->norm() > options_.shift_threshold && shifts_ < options_.max_shifts;
  say("place", percept_W, offset_W ? Vec3(options_.shift_gain * percept_W) : Vec3::Zero(), shift ? "shift" : "squeeze");
  if (shift) shiftBy(options_.shift_gain * *offset_W);
}

// The mean push of both fingers, the thumb's turned round, tilts from the pinch line by what friction leaves over.
void ScriptedPickup::readRationally(const std::optional<Vec3>& offset_W) {
  const auto first_W = touch_.readPush(0, random_), second_W = touch_.readPush(1, random_);
  if (offset_W) belief_.placeRead(across(*offset_W), random_);
  if (first_W && second_W) belief_.pushRead(0.5 * (across(*first_W) + across(*second_W)), random_);
  const Vec2 shift = belief_.bestShift(wanted_grip_, options_.farthest_shift, random_);
  const bool shifts = shifts_ < options_.max_shifts && pays(shift);
  say("place", offset_W.value_or(Vec3::Constant(kNothingRead)), along(belief_.offset()), shifts ? "shift" : "squeeze");
  if (shifts) shiftBy(along(shift));
}

// Expected failures are (1 - P)/P when every attempt holds with chance P; each costs a squeeze, half a lift and back,
// the reflex, and the way to the next attempt.
bool ScriptedPickup::pays(const Vec2& shift) const {
  const double there = belief_.holds(shift, wanted_grip_), here = belief_.holds(Vec2::Zero(), wanted_grip_);
  const double shift_time = (options_.clearance + shift.norm()) / body_.speed +
                            options_.clearance / options_.close_speed + limits_.reading_time;
  const double failure_time =
      wanted_grip_ / options_.squeeze_rate + cues_.lift_height / body_.speed + limits_.reflex_time + shift_time;
  return ((1 - here) / here - (1 - there) / there) * failure_time > shift_time;
}

void ScriptedPickup::shiftBy(const Vec3& shift_W) {
  ++shifts_;
  const Vec3 before_W = believed_W_ + step_W_;
  believe(before_W + shift_W);
  step_W_.setZero();
  if (rational_) {
    belief_.moved(across(believed_W_ - before_W));  // not by `shift_W`: the hand goes no further than it can be wrong
    belief_.letGo(random_);
  }
  enterReach(besideThePinch(), HandPhase::kReach);
}

void ScriptedPickup::say(const char* kind, const Vec3& percept, const Vec3& estimate, const char* decision) {
  reading_ = HandReading{kind, percept, estimate, decision};
}

void ScriptedPickup::squeeze() {
  if (lostIt()) return;
  posture_.half = std::max(posture_.half - options_.squeeze_rate / meanStiffness() * dt_, 0.0);
  // at 0 the hand can't close any further
  if (felt_factor_ * touch_.grip() < wanted_grip_ && posture_.half > 0) return;
  say("grip", Vec3(felt_factor_ * touch_.grip(), 0, 0), Vec3(wanted_grip_, 0, 0), "lift");
  raise(cues_.lift_height + options_.lift_margin);
}

void ScriptedPickup::lift() {
  if (lostIt()) return;
  posture_ = reach_.at(now_);
  tightenWhereItSlips();
  if (reach_.over(now_)) enter(HandPhase::kHold);
}

void ScriptedPickup::hold() {
  if (lostIt()) return;
  tightenWhereItSlips();
  if (now_ >= entered_ + options_.patience) raise(options_.lift_more);
}

// Without leaving the way up.
void ScriptedPickup::tightenWhereItSlips() {
  if (!touch_.feelsSlip() || wanted_grip_ >= options_.grip_max) return;
  const double before = wanted_grip_;
  wanted_grip_ = std::min(wanted_grip_ * options_.grip_growth, options_.grip_max);
  const double closer = (wanted_grip_ - before) / meanStiffness();
  for (double* half : {&reach_.from.half, &reach_.to.half, &posture_.half}) *half = std::max(*half - closer, 0.0);
}

void ScriptedPickup::raise(double height) {
  enterReach({posture_.centre_W + height * Vec3::UnitZ(), posture_.half}, HandPhase::kLift);
}

bool ScriptedPickup::lostIt() {
  if (touch_.lossTime() < limits_.reflex_time) return false;
  if (rational_) belief_.failed(wanted_grip_, random_);
  wanted_grip_ = std::min(wanted_grip_ * options_.grip_growth, options_.grip_max);
  if (!rational_) return retry(options_.random_shift_sd), true;
  shiftBy(along(belief_.bestShift(wanted_grip_, options_.farthest_shift, random_)));
  shifts_ = 0;
  return true;
}

bool ScriptedPickup::standsOnDish() {
  const auto finger = touch_.pushedFromBelow(random_);
  if (!finger) return false;
  const Vec3 felt_W = touch_.feltTip_W(*finger);
  const double error = felt_W.z() - heightOnDish((felt_W - posture_.centre_W).norm());
  if (std::abs(error) > options_.farthest_shift) return false;  // the dish can't be there: it is the object
  believe({believed_W_.x(), believed_W_.y(), cues_.place_W.z() + error});
  if (rational_) belief_.heightFound(random_);
  step_W_.z() = std::max(step_W_.z(), 0.0);
  enterReach(besideThePinch(), HandPhase::kReach);
  return true;
}

// Where a fingertip's centre is when it stands on the dish so far beside the middle [m].
double ScriptedPickup::heightOnDish(double beside) const {
  const double inner = cues_.dish_radius - cues_.fingers[0].tip_radius;
  return cues_.dish_radius - std::sqrt(std::max(inner * inner - beside * beside, 0.0));
}

void ScriptedPickup::retry(double step_sd) {
  shifts_ = 0;
  step_W_ = step_sd * random_.normal3();
  step_W_ -= step_W_.dot(axis_W_) * axis_W_;
  enterReach(besideThePinch(), HandPhase::kReach);
}

// No further across the pinch from the place told than one's own placement can be wrong.
void ScriptedPickup::believe(const Vec3& place_W) {
  const Vec3 shift_W = place_W - cues_.place_W;
  const Vec3 along_W = shift_W.dot(axis_W_) * axis_W_;
  const Vec3 across_W = shift_W - along_W;
  believed_W_ =
      cues_.place_W + along_W + across_W * std::min(1.0, options_.farthest_shift / std::max(across_W.norm(), 1e-9));
}

Posture ScriptedPickup::besideThePinch() const { return {believed_W_ + step_W_, touchingHalf() + options_.clearance}; }

double ScriptedPickup::touchingHalf() const { return cues_.fingers[0].tip_radius + cues_.half_width; }

}  // namespace pincer::tasks
