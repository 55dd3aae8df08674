// records: what a session keeps. Plain values; SI units; times on the session's clock, from its start.
#pragma once
#include <array>
#include <cstdint>
#include <limits>
#include <string>

namespace pincer::tasks {

constexpr int kRecordedFingers = 2;  // index finger and thumb; sessions have columns for two

// Bytes that are no text.
struct Bytes {
  std::string value;
};

// One finger in one tick.
struct FingerRecord {
  std::array<double, 3> p_WF{};            // device fingertip [m]
  std::array<double, 3> p_WP{};            // proxy [m]
  std::array<double, 3> f_contact_W{};     // sum of contact forces on the finger [N]
  std::array<double, 3> f_arm_D{};         // force let through to the arm [N]
  double normal_force = 0;                 // [N]
  double tangential_force = 0;             // [N]
  double gap = 0;                          // to the nearest body [m]
  std::array<double, 2> place_wanted_L{};  // tactor command on the pad [m]
  std::array<double, 2> place_shown_L{};   // measured tactor place [m]; NaN where the device doesn't measure it
  std::int32_t flags = 0;                  // 1 touching, 2 sliding, 4 gate tripped, 8 tactor parked
};

struct SampleRecord {
  std::int64_t trial = 0;  // trial id within the session
  std::int64_t tick = 0;
  double time = 0;               // [s]
  std::array<double, 3> p_WB{};  // object [m]
  std::array<double, 4> q_WB{};  // object, (w, x, y, z)
  std::array<double, 3> v_WB{};  // object's centre of mass [m/s]
  std::array<FingerRecord, kRecordedFingers> fingers{};
  double tick_us = 0;        // time that the tick took [us]
  std::uint32_t status = 0;  // engine::StepStatus bits
};

struct EventRecord {
  std::int64_t trial = 0;
  double time = 0;
  // "phase", "tone", "squeeze", "lift", "try_5mm", "slip", "drop", "failure", "success", "timeout", "gate_trip", ...
  std::string kind;
  std::string detail;  // one line, may be empty
};

// Settings that a trial was given by whoever's hands did it, before its first tick: all that a tick
// depends on besides its inputs and the protocol.
struct HandsRecord {
  static constexpr double kNone = std::numeric_limits<double>::quiet_NaN();  // NaN: it doesn't tell
  struct Finger {
    std::array<double, 3> base_offset_W{};        // of the arm's base from its place in the scene [m]
    double base_turn = kNone;                     // about W's z axis [rad]; NaN: nobody said where the base stands
    double peak_force = 0, continuous_force = 0;  // that the arm can bear [N]; 0: it doesn't tell
    std::array<double, 3> peak_torque{kNone, kNone, kNone};  // of its joints [N m]; NaN: it doesn't tell
    // of the arm, as passivity took them [kg, N s/m]; NaN: it doesn't tell
    double tip_mass = kNone, tip_damping = kNone;
  };

  std::int64_t trial = 0;
  std::array<Finger, kRecordedFingers> fingers{};
  double oldest_sample = kNone;  // that was still trusted [s]; NaN: as in the protocol
  std::int64_t passive = 0;      // 1: the fingers were kept passive (grasp/passivity)
};

// Samples of one finger's devices at one tick (devices/arm/arm.h), and what they were told. All bits are kept; what a
// device doesn't measure is 0, with its flag unset.
struct FingerInputRecord {
  enum Flag : std::uint32_t {
    kValid = 1,
    kGaveUp = 2,
    kVelocity = 4,
    kOrientation = 8,
    kSwitches = 16,
    kJacobian = 32,
    kTactileValid = 64,
    kTactilePlace = 128
  };
  std::uint32_t flags = 0;
  std::uint32_t switches = 0;
  double arm_time = 0;                     // device clock [s]
  std::array<double, 3> p_DF{}, v_DF{};    // [m], [m/s]
  std::array<double, 4> q_DF{};            // (w, x, y, z)
  std::array<double, 9> J{};               // by columns [m/rad]
  double tactile_time = 0;                 // device clock [s]
  std::array<double, 2> place_shown_L{};   // [m]
  std::array<double, 3> f_arm_D{};         // let through to the arm by the tick [N]
  std::array<double, 2> place_wanted_L{};  // that it asked of the tactor [m]
};

// A tick of a person's trial: everything that came in, and where it led, so that the trial can
// be done again and compared tick by tick.
struct InputRecord {
  enum Flag : std::uint32_t { kWantsLift = 1, kAnswers = 2 };
  static constexpr std::uint32_t kKeyShift =
      8;  // from this bit of `flags` on: the key that a person pressed, its character or devices::Key
  std::int64_t trial = 0;
  std::int64_t tick = 0;
  double time = 0;          // that the tick was given [s]
  std::uint32_t cut = 0;    // devices::Trip that cut the forces from outside before this tick; 0: none did
  std::uint32_t phase = 0;  // HandPhase of the hand's intent
  std::uint32_t flags = 0;
  std::array<FingerInputRecord, kRecordedFingers> fingers{};
  std::array<double, 3> p_WB{};  // object [m]
  std::array<double, 4> q_WB{};  // object, (w, x, y, z)
  std::array<double, 3> v_WB{};  // object's centre of mass [m/s]
  std::uint32_t status = 0;      // engine::StepStatus bits
};

// Ticks that follow each other, packed (input_codec.h).
struct InputChunk {
  std::int64_t trial = 0, first_tick = 0, ticks = 0;
  std::int64_t check = 0;  // of the bytes
  Bytes data;
};

// A participant's reading from its senses, and what there was to read (participants/participant.h, HandReading).
struct ReadingRecord {
  std::int64_t trial = 0;
  double time = 0;
  std::string kind;  // "place" [m], "flat" [rad], "grip" [N]
  std::array<double, 3> truth{}, percept{}, estimate{};
  std::string decision;
};

// One row per trial, written when it ends and durable before the next begins. What a task
// doesn't measure is 0, or NaN for a real number.
struct TrialRecord {
  static constexpr double kNone = std::numeric_limits<double>::quiet_NaN();  // NaN: not measured

  std::int64_t trial = 0;
  std::string task = "sphere-pickup";
  std::int64_t participant = 0;
  std::string condition;      // "force", "cld+force"
  std::int64_t training = 0;  // 1: before the counted ones, left out of every result
  std::int64_t index = 0;     // place in the participant's order
  double mu_s = 0, mu_d = 0;  // of the object
  std::string outcome;        // "success", "timeout", "fault"
  double duration = 0;        // [s]
  // sphere pickup
  std::int64_t squeezes = 0, lifts = 0, tries_5mm = 0, slips = 0, drops = 0;
  std::string cause;             // of the last failed squeeze: "not lifted", "slipped", "squeezed out", "dropped"
  double peak_grip = 0;          // largest mean normal force of the two fingers [N]
  double grip_ratio = 0;         // grip while held / smallest grip m g / (2 mu) [-]; NaN if never held
  double offset_at_squeeze = 0;  // contact offset from the antipodal line at the last squeeze [m]; NaN if none
  double felt_grip = kNone, true_grip = kNone;  // when the last squeeze seemed firm enough [N]
  // cylinder alignment
  double start_angle = kNone;  // of the flat from its target [rad]
  double error = kNone;        // the same at the end, within (-pi, pi] [rad]
  std::int64_t regrasps = 0;   // grips after the first
  double flat_time = 0;        // a finger was on the flat [s]

  std::string phase_times;  // JSON: seconds in each phase of the participant
  double tick_us_median = 0, tick_us_p999 = 0;
};

// Somebody's answer in one trial of a psychophysical experiment, written when the trial
// ends and durable before the next begins.
struct ResponseRecord {
  std::int64_t trial = 0;
  std::int64_t participant = 0;
  std::string condition;   // of the experiment
  std::int64_t run = 0;    // of the participant: one staircase, one list of trials
  std::int64_t index = 0;  // place within the run
  std::string stimulus;    // what was shown, where that has a name: "cone", "place 2"; else empty
  double level = 0;  // what was shown, as a number, in SI units: angle, backlash, delay, place; NaN if it has none
  std::int64_t interval = 0;  // 1 or 2: the interval asked for; 0 where there is one only
  std::string answer;         // in words: "2", "cylinder", "0.0014"
  double answer_value = 0;    // the same as a number, or how sure of it (shapes) [-]; NaN if it has none
  std::int64_t correct = 0;   // 1 right, 0 wrong
  std::int64_t reversal = 0;  // 1: the staircase turned at this level
  std::string outcome;        // "answered", "fault"
  double duration = 0;        // of the stimuli [s]
  double response_time = 0;   // from the last stimulus to the answer [s]
  double contact_share = 0;   // share of the duration in which the finger touched [-]
  double finger_speed = 0;    // mean over the time in which the finger touched and moved [m/s]; NaN if it didn't
  double tactor_speed = 0;    // mean over the time in which the tactor moved [m/s]; NaN if it didn't
};

// A person's answer to a question beside the trials (tasks/lab/study/survey.h).
struct SurveyRecord {
  std::int64_t participant = 0;
  std::string moment;                                              // "before", "after" the trials
  std::string item;                                                // its name: "did_well"
  std::string task, condition;                                     // that it was asked of; empty: of the whole session
  std::string question;                                            // in words
  std::string answer;                                              // in words; empty: none was given
  double answer_value = std::numeric_limits<double>::quiet_NaN();  // as a number; NaN if it has none
};

struct SessionInfo {
  std::string task;  // "sphere-pickup", "manipulation", ...
  std::uint64_t seed = 0;
  std::string version, build;  // of the program; compiler
  std::string scene_json, protocol_json, devices_json;
  // every parameter of simulated participants, frozen before the first trial
  std::string participants_json, participants_hash;
  // Everything else that bits may depend on (build_info.h); empty in sessions of before format 5.
  std::string commit{}, sources{}, flags{}, c_library{}, processor{};
};

// How far a session has come.
struct SessionProgress {
  std::string started_utc;  // ISO 8601
  std::string state;        // "running", "complete", "aborted: <why>"
  std::int64_t samples_dropped = 0;
};

}  // namespace pincer::tasks
