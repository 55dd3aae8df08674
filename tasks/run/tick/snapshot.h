// snapshot: what a tick left behind, for somebody who watches: the viewer. The servo publishes it through
// a buffer of three places (devices/triple_buffer.h), so that neither thread ever waits for the other.
// All memory is taken before the first tick.
#pragma once
#include <cstdint>
#include <optional>
#include <vector>

#include "pincer/devices/arm/arm.h"
#include "pincer/devices/gate/force_gate.h"
#include "pincer/devices/triple_buffer.h"
#include "pincer/grasp/step.h"

namespace pincer::tasks {

struct ContactSnapshot {
  int finger = -1;           // whose contact it is; -1: of two bodies
  int body = 0;              // that carries the normal
  int other_body = -1;       // that touches it; -1: a finger does
  Vec3 p_W = Vec3::Zero();   // [m]
  Vec3 n_W = Vec3::UnitZ();  // out of `body`
  Vec3 f_W = Vec3::Zero();   // on the other one: the finger, or the first body [N]
  double mu = 0;             // in force [-]
  bool sliding = false;
};

struct FingerSnapshot {
  Vec3 p_WF = Vec3::Zero();      // where the device is [m]
  Vec3 p_WP = Vec3::Zero();      // where the proxy is [m]
  std::optional<Quat> q_WF;      // absent: the device doesn't say, and the tip is a sphere
  Vec3 f_user_W = Vec3::Zero();  // that the finger is to feel [N]
  double normal_force = 0;       // [N]
  double patch_radius = 0;       // of a soft pad's contact [m]; 0: a point
  bool touching = false, sliding = false;
  std::optional<Vec2> place_L;  // of the contact on the pad [m]; absent: no contact, or no orientation
  // Of a finger on a device:
  bool has_device = false, has_display = false;
  bool tactor_parked = false;
  std::optional<Vec2> tactor_L;         // where it is [m]
  Vec2 tactor_wanted_L = Vec2::Zero();  // where it should be [m]
  devices::DeviceState device = devices::DeviceState::kClosed;
  devices::Trip trip = devices::Trip::kNone;
  bool armed = false;
};

// How a trial stands. Texts live as long as the trial.
struct TrialSnapshot {
  const char* instruction = "";  // what the person should do now
  const char* stage = "";
  const char* condition = "";
  std::int64_t trial = 0, trials = 0;  // from 1; 0: there are no trials
  bool blind = false;                  // the protocol shows nothing of the world
  bool shows_pads = true;              // blind or not: a screen, or a drawn pad that stands in for touch
  const char* hint = "";               // what helps somebody who can't feel
  double time_left = -1;               // of the trial [s]; negative: it doesn't run
  std::optional<double> goal_height;   // of the object's middle [m]
  std::optional<double> goal_heading;  // of the object's mark about W's z axis [rad]
  std::optional<double> target;        // on the pad, along the finger, where the tactor is to be [m]
};

struct Snapshot {
  std::int64_t tick = 0;
  double time = 0;           // of the simulation [s]
  double tick_seconds = 0;   // that the tick took
  std::uint32_t status = 0;  // engine::StepStatus
  bool asleep = false;
  std::vector<Pose> X_WB;  // of every body
  std::vector<FingerSnapshot> fingers;
  std::vector<ContactSnapshot> contacts;  // the first contact_count count
  int contact_count = 0;
  std::vector<double> drive_forces;      // of every drive of a joint [N, N m]
  static constexpr int kAllBodies = -2;  // bodies count from 0, and -1 means none
  int hidden_body = -1;                  // that isn't there at present, or kAllBodies; -1: all are there
  TrialSnapshot trial;

  // Sized for `model`.
  static Snapshot sizedFor(const grasp::GraspModel& model);
};

// Fills in what the grasp step knows: bodies, contacts, and of the fingers proxies and forces. Allocates nothing.
void captureGrasp(const grasp::GraspModel& model, const grasp::GraspState& state, const grasp::GraspScratch& scratch,
                  const engine::StepReport& report, Snapshot& snapshot);

using SnapshotChannel = devices::TripleBuffer<Snapshot>;

}  // namespace pincer::tasks
