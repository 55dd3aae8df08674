// scripted_hand: what the scripted participants share: a hand of two fingers that goes through phases, pulled by its
// muscles towards places, which feels with the limits of body.h.
//
// Each millisecond: feel, then what the phase does (a script overrides what it has of them), then pulls
//
//   p_i = centre + m_i (t) -+ half u(angle)
//   m_i  misplacement of the finger, come to within `settle_time`;  u  the pinch's axis, turned about z
#pragma once
#include "pincer/tasks/lab/participants/body.h"
#include "pincer/tasks/lab/participants/participant.h"
#include "pincer/tasks/lab/participants/random.h"
#include "pincer/tasks/lab/participants/reach.h"
#include "pincer/tasks/lab/participants/touch.h"

namespace pincer::tasks {

class ScriptedHand : public Participant {
 public:
  HandAction act(const Percept& percept) final;

 protected:
  // `seed` makes the participant: hands and speed. What varies between trials comes from the trial's own seed.
  ScriptedHand(std::uint64_t seed, const SensingLimits& limits, const HandRanges& ranges, double settle_time);

  // The hand at home, listening; what it feels drawn anew.
  void beginHand(const TrialCues& cues);
  bool heardStart() const { return heard_ >= 0 && now_ >= heard_ + limits_.reaction_time; }
  void enter(HandPhase phase);
  void enterReach(const Posture& goal, HandPhase phase);
  double meanStiffness() const;  // of the two hands [N/m]

  // Does a phase's share of a millisecond; kReach and kReturn go along.
  virtual void listen() = 0;
  virtual void goAlong() = 0;
  virtual void close() = 0;
  virtual void read() = 0;
  virtual void squeeze() = 0;
  virtual void lift() {}
  virtual void hold() {}
  virtual void turn() {}
  // The tone that ends the trial sounded, before the hand returns.
  virtual void ended() {}
  // Intents of the hand, besides phase and reading.
  virtual void mean(HandIntent& intent) const = 0;

  SensingLimits limits_;
  Body body_;
  Random random_;
  TrialCues cues_;
  BodySense sense_;
  Touch touch_;
  std::optional<HandReading> reading_;

  HandPhase phase_ = HandPhase::kListen;
  Cue cue_ = Cue::kNone;
  double now_ = 0, dt_ = 0;      // [s]
  double entered_ = 0;           // when the phase began [s]
  double heard_ = -1;            // when the start tone sounded [s], negative before
  double contact_time_ = 0;      // how long both fingers have felt something [s]
  Vec3 axis_W_ = Vec3::UnitX();  // of the pinch at angle 0, from finger 0 to finger 1
  Posture home_, posture_;       // of the equilibria
  Reach reach_;

 private:
  void doPhase();
  devices::HandPull pullOf(int finger) const;

  // in which the hand, put to its place by the arms, drifts to where it believes that place to be [s]
  double settle_time_;
};

}  // namespace pincer::tasks
