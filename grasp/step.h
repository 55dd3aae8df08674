// step: one tick of fingers and bodies. The engine's stages with the fingers' contacts added to the one coupled solve.
#pragma once
#include <span>
#include <vector>

#include "contact/shape/finger_query.h"
#include "engine/world/step.h"
#include "grasp/model.h"

namespace pincer::grasp {

// Device pose of a finger at the end of the tick.
struct FingerInput {
  Vec3 p_WF = Vec3::Zero();      // fingertip centre [m]
  Vec3 v_WF = Vec3::Zero();      // its velocity [m/s]
  Quat q_WF = Quat::Identity();  // orientation of the finger frame F
  Vec3 f_W = Vec3::Zero();       // force on the proxy besides the coupling [N]
};

struct GraspState {
  engine::WorldState world;
  std::vector<contact::SurfaceTracker> trackers;  // finger-major: fingers x bodies
};

// What a finger feels after a tick.
struct FingerReport {
  bool touching = false;
  int body = -1;                    // that carries the largest force, -1 if none
  Vec3 p_WC = Vec3::Zero();         // contact point (force-weighted mean of this finger's contacts) [m]
  Vec3 n_W = Vec3::UnitZ();         // outward normal of the body there
  Vec3 f_contact_W = Vec3::Zero();  // sum of the contact forces on the finger; the bodies feel exactly the negative of each [N]
  Vec3 f_user_W = Vec3::Zero();  // to render on the user's finger: the coupling's reaction (equal to f_contact_W for a massless proxy) [N]
  double normal_force = 0;       // [N], >= 0
  double tangential_force = 0;   // [N]
  bool sliding = false;
  Vec2 place_L = Vec2::Zero();          // contact on the pad: arc length (distal, radial) from the pad's centre [m]
  double gap = 0;                       // to the nearest body [m]; larger than `reach`: a lower bound
  Vec2 nearest_place_L = Vec2::Zero();  // where the nearest point would touch the pad, while nothing does [m]
};

struct GraspScratch {
  explicit GraspScratch(const GraspModel& model);
  engine::WorldScratch world;
  std::vector<engine::PointInput> inputs;
  std::vector<Vec3> nearest_n_W;      // per finger, of the nearest body
  std::vector<FingerReport> fingers;  // the tick's result
  std::vector<Quat> orientations;     // of the fingers in it
};

// State with every body at `starts` and every finger's device at `fingers` [m].
GraspState makeState(const GraspModel& model, const std::vector<engine::BodyStart>& starts, const std::vector<Vec3>& fingers);

// One tick. `inputs` has one entry per finger. Results per finger in scratch.fingers. Allocates nothing, throws nothing.
engine::StepReport step(const GraspModel& model, GraspState& state, GraspScratch& scratch, std::span<const FingerInput> inputs,
                        std::span<const engine::MotionInput> motions = {});

// Arc-length place on the pad of the fingertip point in direction `d_F` (unit, from the centre): azimuthal equidistant about the pad normal.
Vec2 placeOnPad(const FingerModel& finger, const Vec3& d_F);

}  // namespace pincer::grasp
