// step: one tick of fingers and bodies. The engine's stages with the fingers' contacts added to the one coupled solve.
#pragma once
#include <memory>
#include <span>
#include <vector>

#include "pincer/contact/finger_query.h"
#include "pincer/engine/step.h"
#include "pincer/grasp/model.h"
#include "pincer/grasp/pad_place.h"

namespace pincer::grasp {

// Device pose of a finger at the end of the tick.
struct FingerInput {
  Vec3 p_WF = Vec3::Zero();      // fingertip centre [m]
  Vec3 v_WF = Vec3::Zero();      // its velocity [m/s]
  Quat q_WF = Quat::Identity();  // orientation of the finger frame F
  Vec3 f_W = Vec3::Zero();       // force on the proxy besides the coupling [N]
};

// A finger's memory besides its proxy.
struct FingerState {
  bool seen = false;             // a tick has been
  Quat q_WF = Quat::Identity();  // orientation at the end of the last tick
  PadTouch touch;                // of the last tick
  Vec3 n_W = Vec3::UnitZ();      // normal of the body where it last touched
  double normal_force = 0;       // of the last tick [N]
};

// Fingers' memory of the shapes near them, each of as many as it has places for: a thousand
// fingers among a thousand bodies have room.
struct FollowedShapes {
  static constexpr int kMost = 8;  // places of a finger; of more shapes that are near the nearest have them
  int per_finger = 0;              // 0 where all fingers are spheres and there is no mesh
  std::vector<int> colliders;      // finger-major: of model.world.colliders; -1: a free place
  std::vector<double> gaps;        // of the last look [m]
  std::vector<contact::FingerTracker> trackers;
};

struct GraspState {
  engine::WorldState world;
  FollowedShapes followed;
  std::vector<FingerState> fingers;
};

// The force on one place of a finger's skin: into the skin, and along it in the directions (distal, radial). [N]
struct Taxel {
  double normal = 0;
  Vec2 tangential = Vec2::Zero();
};

// A finger's report after a tick.
struct FingerReport {
  bool touching = false;
  int body = -1;             // that carries the largest force, -1 if none
  Vec3 p_WC = Vec3::Zero();  // contact point (force-weighted mean of this finger's contacts) [m]
  Vec3 n_W = Vec3::UnitZ();  // outward normal of the body there
  // sum of the contact forces on the finger; the bodies feel exactly the negative of each [N]
  Vec3 f_contact_W = Vec3::Zero();
  // to render on the user's finger: the coupling's reaction (equal to f_contact_W for a massless proxy) [N]
  Vec3 f_user_W = Vec3::Zero();
  double normal_force = 0;      // [N], >= 0
  double tangential_force = 0;  // [N]
  bool sliding = false;
  double torsion = 0;          // moment of the contacts on the finger, about n_W [N m]
  double patch_radius = 0;     // of a soft pad [m]
  PadTouch touch, last_touch;  // where on the pad, now and in the tick before: placeOnPad, placeRateOnPad (pad_place.h)
  double gap = 0;              // to the nearest body [m]; larger than `reach`: a lower bound
  // row by row, valid until the next step; empty unless FingerModel::taxels asks for it (pressure_map.h)
  std::span<const Taxel> pressure;
  double off_grid = 0;  // normal force of `pressure` that belongs beyond its rim, and is on the taxels there [N]
  PadTouch nearest;     // where the nearest point would touch the pad, while nothing does
};

// State with every body at `starts` and every finger's device at `fingers` [m].
GraspState makeState(const GraspModel& model, const std::vector<engine::BodyStart>& starts,
                     const std::vector<Vec3>& fingers);

// Working memory of a step, as engine::WorldScratch. It keeps the last tick's reports.
struct GraspScratch;
struct DeleteScratch {
  void operator()(GraspScratch* scratch) const;
};
using ScratchHandle = std::unique_ptr<GraspScratch, DeleteScratch>;

ScratchHandle makeScratch(const GraspModel& model);

struct GraspReport : engine::StepReport {
  std::span<const FingerReport> fingers;  // one per finger; valid until the next step
};

// One tick. `inputs` has one entry per finger. Allocates nothing, throws nothing.
GraspReport step(const GraspModel& model, GraspState& state, GraspScratch& scratch, std::span<const FingerInput> inputs,
                 std::span<const engine::MotionInput> motions = {}, const engine::AppliedForces& applied = {},
                 std::span<const engine::DriveInput> controls = {});

// The fingers' reports of the last tick, those of its GraspReport; before the first one none touches.
std::span<const FingerReport> fingersOf(const GraspScratch& scratch);
// The world's part, for the contacts of the last tick (engine::contactAt).
engine::WorldScratch& worldOf(GraspScratch& scratch);
const engine::WorldScratch& worldOf(const GraspScratch& scratch);

}  // namespace pincer::grasp
