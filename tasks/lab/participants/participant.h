// participant: somebody who does an experiment, simulated. A controller behind a wall: files of this folder see
// devices/, the standard library, and nothing else of pincer, so that no participant can look into the world
// (tests/unit/tasks/lab/participant_wall_test.cpp).
//
// Each millisecond a participant is given what its body can feel (a Percept) and answers where its
// fingers pull (a HandAction). Frames: W as the instructions describe the set-up; D_i the base of finger
// i's arm; F the finger; L its pad (devices/cld).
#pragma once
#include <array>
#include <cstdint>
#include <optional>

#include "pincer/devices/arm/arm.h"
#include "pincer/devices/arm/sim_arm.h"
#include "pincer/devices/cld/tactile_display.h"
#include "pincer/devices/math.h"

namespace pincer::tasks {

constexpr int kHandFingers = 2;  // index finger, thumb

// Tones that pace a trial. Each sounds for one tick.
enum class Cue : std::uint8_t { kNone, kStart, kSuccess, kEnd };

// Sensations of one finger in this tick.
struct FingerPercept {
  devices::ArmSample arm;          // where the arm (and so the finger) is
  Vec3 f_D = Vec3::Zero();         // the arm's push on the skin [N]
  devices::TactileSample tactile;  // where the tactor is on the pad
};

struct Percept {
  double time = 0;  // [s]
  std::array<FingerPercept, kHandFingers> fingers;
  Cue cue = Cue::kNone;
};

// Facts about one finger that a participant is told before a trial: how arm and pad sit, and where it rests.
struct FingerCue {
  Quat q_WD = Quat::Identity();
  Vec3 p_WD = Vec3::Zero();     // [m]
  Vec3 home_W = Vec3::Zero();   // where the finger waits for the start tone [m]
  double tip_radius = 8e-3;     // [m]
  Vec3 pad_normal_F{0, 0, -1};  // out of the pad
  Vec3 distal_F{1, 0, 0};       // first axis of L
  Vec3 radial_F{0, 1, 0};       // second axis of L
};

// Facts that a participant is told before a trial, the same in every condition: all of it is
// learnt in training, none of it is measured.
struct TrialCues {
  std::uint64_t seed = 0;  // of everything that varies from trial to trial within the participant
  std::array<FingerCue, kHandFingers> fingers;
  Vec3 place_W = Vec3::Zero();      // where the object is to be pinched [m]
  double half_width = 0.02;         // of the object between the fingers [m]
  double surface_stiffness = 1000;  // how far what is touched gives way: force over depth [N/m]
  double flat_distance = 0;         // of a cylinder's flat from its axis [m]; 0: it has none
  double target_angle = 0;          // where the flat is to face, about W's z axis [rad]
  double mass = 0.075;              // of the object [kg]
  double lift_height = 0.050;       // to lift it at least so high [m]
  double dish_radius = 0.15;  // of curvature of the dish that the object lies in, its lowest point at W's origin [m]
};

// The participant's present doing; for records and for the judge, who counts as squeezes only what was meant to lift.
enum class HandPhase : std::uint8_t { kListen, kReach, kClose, kRead, kSqueeze, kLift, kHold, kTurn, kReturn, kRest };
constexpr int kHandPhases = 10;  // of HandPhase
const char* nameOf(HandPhase phase);

// One deliberate reading of the senses, as the participant would report it: kept for the analysis
// beside the truth, which it doesn't know.
//   kind      what was read: "place" (offset of the object's centre from the middle of the fingertips, W [m]),
//             "flat" (direction of the flat about the axis: (angle, spread, 0) [rad]),
//             "grip" ((mean of the two pushes, 0, 0) [N])
//   percept   what the senses said; NaN where they said nothing
//   estimate  what the participant believes after it
struct HandReading {
  const char* kind = "";
  Vec3 percept = Vec3::Zero(), estimate = Vec3::Zero();
  const char* decision = "";
};

// Intents of a hand; a simulated participant says it, a person by keys or switches.
struct HandIntent {
  HandPhase phase = HandPhase::kListen;
  bool wants_lift = false;             // squeezing, lifting or holding
  bool answers = false;                // "this is my answer": ends a trial of alignment
  std::optional<HandReading> reading;  // made in this tick
};

struct HandAction {
  std::array<devices::HandPull, kHandFingers> pulls;
  HandIntent intent;
};

class Participant {
 public:
  virtual ~Participant() = default;
  virtual void begin(const TrialCues& cues) = 0;
  // One millisecond. Allocates nothing, throws nothing.
  virtual HandAction act(const Percept& percept) = 0;
};

}  // namespace pincer::tasks
