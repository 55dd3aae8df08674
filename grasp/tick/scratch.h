// scratch: working memory of a grasp step, sized once from the model. What the next tick needs of this one is in the
// state; `fingers` and `orientations` stay, to be read, and to be the reports of a tick that repeats the last one.
#pragma once
#include <vector>

#include "pincer/engine/world/scratch.h"
#include "pincer/grasp/step.h"

namespace pincer::grasp {

struct GraspScratch {
  explicit GraspScratch(const GraspModel& model);
  engine::WorldScratch world;
  std::vector<engine::PointInput> inputs;
  std::vector<Quat> q_mid_WF;         // of the fingers in the middle of the tick
  std::vector<Vec3> nearest_n_W;      // per finger, towards it from the nearest body, of any length; zero: none is near
  std::vector<Vec3> nearest_d_W;      // per finger, from its centre to its own point nearest to the nearest body [m]
  std::vector<FingerReport> fingers;  // of the last tick that was computed
  std::vector<Quat> orientations;     // of the fingers at its end
  contact::FingerTracker spare_tracker;  // of shapes for which a finger has no place (FollowedShapes)
  // per finger, of the last tick that was computed; empty where no map is asked for
  std::vector<std::vector<Taxel>> taxels;
};

}  // namespace pincer::grasp
