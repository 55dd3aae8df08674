#include "pincer/tasks/lab/participants/scripted_alignment.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <numbers>

namespace pincer::tasks {
namespace {

constexpr int kFirstProbes = 3;      // from one end of the hand's reach to the other
constexpr int kSimpleTurns = 2;      // of the simple strategy
constexpr double kSimpleSd = 0.3;    // what the simple strategy holds its direction to be known to [rad]
constexpr double kLongestReach = 2;  // a reach of the pinch ends there at the latest, its sizes being small [s]
constexpr double kNothingFelt = std::numeric_limits<double>::quiet_NaN();  // NaN: no reading yet

double wrapToPi(double angle) { return std::remainder(angle, 2 * std::numbers::pi); }
double aboutZ(const Vec3& v_W) { return math::atan2(v_W.y(), v_W.x()); }

FlatModel flatModelOf(const TrialCues& cues, const SensingLimits& limits) {
  FlatModel model;
  model.radius = cues.half_width;
  model.flat_distance = cues.flat_distance;
  model.tip_radius = cues.fingers[0].tip_radius;
  model.placement_sd = std::max(limits.placement_sd, 1e-4);
  model.placement_between_sd = std::max(limits.placement_between_sd, 1e-4);
  model.span_sd = std::max(limits.span_sd, 3e-4);
  const double cone = 0.31;  // SD of a direction anywhere within a friction cone of 31 degrees [rad]
  model.push_sd = math::hypot(limits.direction_sd, cone);
  model.place_sd = std::max(math::hypot(limits.tactor_sd / model.tip_radius, limits.orientation_sd), 0.02);
  model.place_gain = limits.tactor_bias;
  return model;
}

}  // namespace

ScriptedAlignment::ScriptedAlignment(std::uint64_t seed, bool simple, const ScriptedAlignmentOptions& options,
                                     const SensingLimits& limits, const HandRanges& ranges)
    : ScriptedHand(seed, limits, ranges, options.settle_time), simple_(simple), options_(options) {
  Random person(seedFor(seed, 0x6d6f6e69746f72));  // "monitor": not the stream that made the hands
  target_shared_ = limits.target_shared_sd * person.normal();
}

void ScriptedAlignment::begin(const TrialCues& cues) {
  beginHand(cues);
  belief_.begin(flatModelOf(cues, limits_), random_);
  target_ = cues.target_angle + target_shared_ + limits_.target_trial_sd * random_.normal();
  opening_ = answers_ = turning_ = false;
  probes_ = turns_ = 0;
  simple_best_ = std::numeric_limits<double>::infinity();
}

void ScriptedAlignment::ended() { opening_ = false; }

void ScriptedAlignment::mean(HandIntent& intent) const { intent.answers = answers_; }

void ScriptedAlignment::listen() {
  if (heardStart()) probe(-options_.reach_angle, "first");
}

void ScriptedAlignment::goAlong() {
  posture_ = reach_.at(now_);
  if (!reach_.over(now_)) return;
  if (opening_) {
    opening_ = false;
    return enterReach({centre_W(), openHalf(), next_angle_}, HandPhase::kReach);
  }
  enter(phase_ == HandPhase::kReach ? HandPhase::kClose : HandPhase::kRest);
}

// Inwards; a finger that touches alone waits for the other.
void ScriptedAlignment::close() {
  const double step = options_.close_speed * dt_;
  posture_.half = std::max(posture_.half - step, 0.5 * cues_.fingers[0].tip_radius);
  if (touch_.feels(0) != touch_.feels(1)) {
    const Vec3 u_W(math::cos(posture_.angle), math::sin(posture_.angle), 0);
    posture_.centre_W += (touch_.feels(0) ? -step : step) * u_W;
  }
  contact_time_ = touch_.feelsBoth() ? contact_time_ + dt_ : 0;
  if (contact_time_ >= options_.contact_time) return enter(turning_ ? HandPhase::kSqueeze : HandPhase::kRead);
  if (now_ > entered_ + options_.patience) openThenReach(posture_.angle);
}

void ScriptedAlignment::read() {
  if (now_ < entered_ + limits_.reading_time) return;
  ++probes_;
  observe();
  decide();
}

void ScriptedAlignment::observe() {
  std::array<FlatPercept, 2> pinch;
  std::array<double, 2> push{kNothingFelt, kNothingFelt}, place{kNothingFelt, kNothingFelt};
  for (int i = 0; i < kHandFingers; ++i) {
    const auto k = static_cast<std::size_t>(i);
    const Vec3 noise = limits_.span_sd * random_.normal3();
    const Vec3 tip_W = touch_.feltTip_W(i) + noise - cues_.place_W;
    pinch[k].p_felt = tip_W.head<2>();
    pinch[k].pressed = touch_.push(i) / cues_.surface_stiffness;
    pinch[k].pad = i == 0 ? aboutZ(-axis_W_) : aboutZ(axis_W_);
    if (const auto felt = touch_.readPush(i, random_)) pinch[k].push = push[k] = aboutZ(*felt);
    if (const auto felt = touch_.readContact(i, random_)) pinch[k].place = place[k] = aboutZ(-*felt);
    const double direction = pinch[k].place.value_or(aboutZ(tip_W));
    if (pinch[k].p_felt.norm() >= simple_best_) continue;
    simple_best_ = pinch[k].p_felt.norm();
    simple_direction_ = direction;
  }
  belief_.observe(pinch, random_);
  belief_.turned(0, options_.probe_sd, random_);
  // the one that is more likely on the flat
  const std::size_t finger = pinch[0].p_felt.norm() < pinch[1].p_felt.norm() ? 0 : 1;
  reading_ =
      HandReading{"flat", Vec3(place[finger], push[finger], 0), Vec3(believedDirection(), believedSpread(), 0), ""};
}

double ScriptedAlignment::believedDirection() const { return simple_ ? simple_direction_ : belief_.direction(); }
double ScriptedAlignment::believedSpread() const { return simple_ ? kSimpleSd : belief_.spread(); }

void ScriptedAlignment::decide() {
  if (probes_ < kFirstProbes) return probe((probes_ - 1) * options_.reach_angle, "sweep");
  const double spread = believedSpread();
  const bool known = simple_ || spread <= options_.sure || probes_ >= options_.most_probes;
  if (!known) return probe(anglesFacing(believedDirection()), "unsure");
  const double missing = wrapToPi(target_ - believedDirection());
  const int most_turns = simple_ ? kSimpleTurns : options_.most_turns;
  if (std::abs(missing) <= std::max(options_.close_enough, simple_ ? 0.0 : spread) || turns_ >= most_turns) {
    reading_->decision = "answer";
    answers_ = true;
    return enter(HandPhase::kRest);
  }
  reading_->decision = "turn";
  turning_ = true;
  turn_by_ = std::clamp(missing, -2 * options_.reach_angle, 2 * options_.reach_angle);
  openThenReach(-0.5 * turn_by_);
}

// The angle of the pinch that brings a finger nearest to where a normal of direction `direction` points.
double ScriptedAlignment::anglesFacing(double direction) {
  const double thumb = wrapToPi(direction), index = wrapToPi(direction - std::numbers::pi);
  const double nearer = std::abs(thumb) < std::abs(index) ? thumb : index;
  const double spread_out = options_.reach_angle * random_.uniform(-0.4, 0.4);  // not twice the same pinch
  return std::clamp(nearer + spread_out, -options_.reach_angle, options_.reach_angle);
}

void ScriptedAlignment::probe(double angle, const char* why) {
  if (reading_) reading_->decision = why;
  turning_ = false;
  openThenReach(angle);
}

void ScriptedAlignment::squeeze() {
  posture_.half = std::max(posture_.half - options_.squeeze_rate / meanStiffness() * dt_, 0.0);
  if (touch_.grip() < options_.turn_grip && posture_.half > 0 && now_ < entered_ + options_.patience) return;
  Posture goal = posture_;
  goal.angle += turn_by_;
  const double way = (cues_.half_width + cues_.fingers[0].tip_radius) * std::abs(turn_by_);
  reach_ = {posture_, goal, now_, way / body_.speed};
  enter(HandPhase::kTurn);
}

void ScriptedAlignment::turn() {
  posture_ = reach_.at(now_);
  if (!reach_.over(now_)) return;
  ++turns_;
  probes_ = 0;
  belief_.turned(turn_by_, options_.turn_error * std::abs(turn_by_), random_);
  simple_direction_ += turn_by_;
  simple_best_ = std::numeric_limits<double>::infinity();
  probe(-options_.reach_angle, "turned");
}

void ScriptedAlignment::openThenReach(double angle) {
  next_angle_ = angle;
  opening_ = true;
  enterReach({posture_.centre_W, openHalf(), posture_.angle}, HandPhase::kReach);
  reach_.duration = std::min(reach_.duration, kLongestReach);
}

Vec3 ScriptedAlignment::centre_W() const {
  if (simple_) return cues_.place_W;
  const Vec2 axis = belief_.axis();
  return cues_.place_W + Vec3(axis.x(), axis.y(), 0);
}

double ScriptedAlignment::openHalf() const {
  return cues_.fingers[0].tip_radius + cues_.half_width + options_.clearance;
}

}  // namespace pincer::tasks
