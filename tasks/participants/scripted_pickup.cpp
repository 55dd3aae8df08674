#include "tasks/participants/scripted_pickup.h"

#include <algorithm>
#include <cmath>

namespace pincer::tasks {
namespace {

constexpr double kNotHeard = -1;

}  // namespace

const char* nameOf(PickupPhase phase) {
  constexpr std::array names = {"listen", "reach", "close", "read", "squeeze", "lift", "hold", "return", "rest"};
  return names[static_cast<std::size_t>(phase)];
}

ScriptedPickup::ScriptedPickup(std::uint64_t seed, const ScriptedPickupOptions& options, const SensingLimits& limits,
                               const HandRanges& ranges)
    : options_(options), limits_(limits), body_(drawBody(ranges, seed)), random_(seed) {}

void ScriptedPickup::begin(const TrialCues& cues) {
  cues_ = cues;
  random_ = Random(cues.seed);
  sense_ = drawBodySense(limits_, random_);
  touch_.begin(limits_, cues, sense_);
  const Vec3 span_W = cues.fingers[1].home_W - cues.fingers[0].home_W;
  axis_W_ = span_W.normalized();
  home_ = {0.5 * (cues.fingers[0].home_W + cues.fingers[1].home_W), 0.5 * span_W.norm()};
  posture_ = home_;
  place_W_ = cues.place_W;
  lowest_z_ = cues.lowest_z;
  wanted_grip_ = options_.grip_safety * cues.mass * options_.gravity / (2 * options_.expected_mu);
  shifts_ = 0;
  now_ = dt_ = contact_time_ = 0;
  heard_ = kNotHeard;
  enter(PickupPhase::kListen);
}

HandAction ScriptedPickup::act(const Percept& percept) {
  dt_ = std::max(percept.time - now_, 0.0);
  now_ = percept.time;
  cue_ = percept.cue;
  touch_.feel(percept);
  if (cue_ == Cue::kSuccess || cue_ == Cue::kEnd) enterReach(home_, PickupPhase::kReturn);
  switch (phase_) {
    case PickupPhase::kListen:
      listen();
      break;
    case PickupPhase::kReach:
    case PickupPhase::kReturn:
      goAlong();
      break;
    case PickupPhase::kClose:
      close();
      break;
    case PickupPhase::kRead:
      read();
      break;
    case PickupPhase::kSqueeze:
      squeeze();
      break;
    case PickupPhase::kLift:
      lift();
      break;
    case PickupPhase::kHold:
      hold();
      break;
    case PickupPhase::kRest:
      break;
  }
  HandAction action;
  for (int i = 0; i < kHandFingers; ++i) action.pulls[static_cast<std::size_t>(i)] = pullOf(i);
  action.phase = phase_;
  action.wants_lift = phase_ == PickupPhase::kSqueeze || phase_ == PickupPhase::kLift || phase_ == PickupPhase::kHold;
  return action;
}

void ScriptedPickup::listen() {
  if (cue_ == Cue::kStart) heard_ = now_;
  if (heard_ != kNotHeard && now_ >= heard_ + limits_.reaction_time) enterReach(aboveThePinch(), PickupPhase::kReach);
}

void ScriptedPickup::goAlong() {
  if (phase_ == PickupPhase::kReach && standsOnDish()) return;
  posture_ = reach_.at(now_);
  if (reach_.over(now_)) enter(phase_ == PickupPhase::kReach ? PickupPhase::kClose : PickupPhase::kRest);
}

// Inwards and down to the believed place, then straight inwards; a finger that touches alone waits for the other. Fingertips that meet have
// found nothing between them.
void ScriptedPickup::close() {
  if (standsOnDish()) return;
  const double step = options_.close_speed * dt_;
  posture_.half -= step;
  if (touch_.feels(0) != touch_.feels(1)) place_W_ += (touch_.feels(0) ? -step : step) * axis_W_;
  const double above = std::max(posture_.half - touchingHalf(), 0.0) / options_.clearance;
  posture_.centre_W = place_W_ + above * options_.approach_height * Vec3::UnitZ();
  contact_time_ = touch_.feelsBoth() ? contact_time_ + dt_ : 0;
  if (contact_time_ >= options_.contact_time) return enter(PickupPhase::kRead);
  if (posture_.half <= cues_.fingers[0].tip_radius) retry(false);
}

void ScriptedPickup::read() {
  if (now_ < entered_ + limits_.reading_time) return;
  const auto offset_W = touch_.readPlace(random_);
  const bool worth_a_shift = offset_W && offset_W->norm() > options_.shift_threshold;
  if (worth_a_shift && shifts_ < options_.max_shifts) {
    ++shifts_;
    shiftPinch(options_.shift_gain * *offset_W);
    return enterReach(aboveThePinch(), PickupPhase::kReach);
  }
  felt_factor_ = 1 + limits_.force_sd * random_.normal();
  enter(PickupPhase::kSqueeze);
}

void ScriptedPickup::squeeze() {
  if (lostIt()) return;
  const double stiffness = 0.5 * (body_.hands[0].stiffness + body_.hands[1].stiffness);
  posture_.half = std::max(posture_.half - options_.squeeze_rate / stiffness * dt_, 0.0);
  if (felt_factor_ * touch_.grip() < wanted_grip_ && posture_.half > 0) return;  // at 0 the hand can't close any further
  raise(cues_.lift_height + options_.lift_margin);
}

void ScriptedPickup::lift() {
  if (lostIt()) return;
  posture_ = reach_.at(now_);
  if (reach_.over(now_)) enter(PickupPhase::kHold);
}

void ScriptedPickup::hold() {
  if (lostIt() || now_ < entered_ + options_.patience) return;
  raise(options_.lift_more);
}

void ScriptedPickup::enter(PickupPhase phase) {
  phase_ = phase;
  entered_ = now_;
  contact_time_ = 0;
}

void ScriptedPickup::enterReach(const Posture& goal, PickupPhase phase) {
  reach_ = reach(posture_, goal, now_, body_.speed);
  enter(phase);
}

void ScriptedPickup::raise(double height) { enterReach({posture_.centre_W + height * Vec3::UnitZ(), posture_.half}, PickupPhase::kLift); }

bool ScriptedPickup::lostIt() {
  if (touch_.lossTime() < limits_.reflex_time) return false;
  retry(true);
  return true;
}

bool ScriptedPickup::standsOnDish() {
  const auto finger = touch_.pushedFromBelow(random_);
  if (!finger) return false;
  const double height = touch_.feltTip_W(*finger).z();
  if (height > cues_.lowest_z + options_.farthest_shift) return false;  // the dish can't be so high: it is the object
  lowest_z_ = height;
  shiftPinch((lowest_z_ + cues_.place_W.z() - cues_.lowest_z - place_W_.z()) * Vec3::UnitZ());
  enterReach(aboveThePinch(), PickupPhase::kReach);
  return true;
}

void ScriptedPickup::retry(bool harder) {
  if (harder) wanted_grip_ = std::min(wanted_grip_ * options_.grip_growth, options_.grip_max);
  shifts_ = 0;
  shiftPinch(options_.random_shift_sd * random_.normal3());
  enterReach(aboveThePinch(), PickupPhase::kReach);
}

// Only across the pinch, no further from the place first believed than one's own placement can be wrong, and not into the table.
void ScriptedPickup::shiftPinch(const Vec3& shift_W) {
  const Vec3 across_W = shift_W - shift_W.dot(axis_W_) * axis_W_;
  const double limit = options_.farthest_shift;
  for (int i = 0; i < 3; ++i) place_W_[i] = std::clamp(place_W_[i] + across_W[i], cues_.place_W[i] - limit, cues_.place_W[i] + limit);
  place_W_.z() = std::max(place_W_.z(), lowest_z_);
}

Posture ScriptedPickup::aboveThePinch() const {
  return {place_W_ + options_.approach_height * Vec3::UnitZ(), touchingHalf() + options_.clearance};
}

double ScriptedPickup::touchingHalf() const { return cues_.fingers[0].tip_radius + cues_.half_width; }

devices::HandPull ScriptedPickup::pullOf(int finger) const {
  const auto k = static_cast<std::size_t>(finger);
  const double side = finger == 0 ? -1 : 1;
  const Vec3 felt_W = posture_.centre_W + side * posture_.half * axis_W_;
  devices::HandPull pull = body_.hands[k];
  pull.p_D = cues_.fingers[k].q_WD.conjugate() * (felt_W + sense_.misplacement_W[k] - cues_.fingers[k].p_WD);
  return pull;
}

}  // namespace pincer::tasks
