#include "pincer/tasks/lab/participants/scripted_hand.h"

#include <algorithm>

namespace pincer::tasks {

ScriptedHand::ScriptedHand(std::uint64_t seed, const SensingLimits& limits, const HandRanges& ranges,
                           double settle_time)
    : limits_(limits), body_(drawBody(ranges, seed)), random_(seed), settle_time_(settle_time) {}

void ScriptedHand::beginHand(const TrialCues& cues) {
  cues_ = cues;
  random_ = Random(cues.seed);
  sense_ = drawBodySense(limits_, random_);
  touch_.begin(limits_, cues, sense_);
  const Vec3 span_W = cues.fingers[1].home_W - cues.fingers[0].home_W;
  axis_W_ = span_W.normalized();
  home_ = {0.5 * (cues.fingers[0].home_W + cues.fingers[1].home_W), 0.5 * span_W.norm(), 0};
  posture_ = home_;
  now_ = dt_ = contact_time_ = 0;
  heard_ = -1;
  enter(HandPhase::kListen);
}

HandAction ScriptedHand::act(const Percept& percept) {
  dt_ = std::max(percept.time - now_, 0.0);
  now_ = percept.time;
  cue_ = percept.cue;
  reading_.reset();
  touch_.feel(percept);
  if (cue_ == Cue::kStart && phase_ == HandPhase::kListen) heard_ = now_;
  if (cue_ == Cue::kSuccess || cue_ == Cue::kEnd) {
    ended();
    enterReach(home_, HandPhase::kReturn);
  }
  doPhase();
  HandAction action;
  for (int i = 0; i < kHandFingers; ++i) action.pulls[static_cast<std::size_t>(i)] = pullOf(i);
  action.intent.phase = phase_;
  action.intent.reading = reading_;
  mean(action.intent);
  return action;
}

void ScriptedHand::doPhase() {
  switch (phase_) {
    case HandPhase::kListen:
      return listen();
    case HandPhase::kReach:
    case HandPhase::kReturn:
      return goAlong();
    case HandPhase::kClose:
      return close();
    case HandPhase::kRead:
      return read();
    case HandPhase::kSqueeze:
      return squeeze();
    case HandPhase::kLift:
      return lift();
    case HandPhase::kHold:
      return hold();
    case HandPhase::kTurn:
      return turn();
    case HandPhase::kRest:
      return;
  }
}

void ScriptedHand::enter(HandPhase phase) {
  phase_ = phase;
  entered_ = now_;
  contact_time_ = 0;
}

void ScriptedHand::enterReach(const Posture& goal, HandPhase phase) {
  reach_ = reach(posture_, goal, now_, body_.speed);
  enter(phase);
}

double ScriptedHand::meanStiffness() const { return 0.5 * (body_.hands[0].stiffness + body_.hands[1].stiffness); }

devices::HandPull ScriptedHand::pullOf(int finger) const {
  const auto k = static_cast<std::size_t>(finger);
  const double side = finger == 0 ? -1 : 1;
  const Vec3 misplacement_W = minimumJerk(now_, settle_time_) * sense_.misplacement_W[k];
  const auto [s, c] = math::sinCos(posture_.angle);
  const Vec3 u_W(c * axis_W_.x() - s * axis_W_.y(), s * axis_W_.x() + c * axis_W_.y(), axis_W_.z());
  const Vec3 felt_W = posture_.centre_W + side * posture_.half * u_W;
  devices::HandPull pull = body_.hands[k];
  pull.p_D = cues_.fingers[k].q_WD.conjugate() * (felt_W + misplacement_W - cues_.fingers[k].p_WD);
  return pull;
}

}  // namespace pincer::tasks
