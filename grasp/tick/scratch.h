// scratch: working memory of a grasp step, sized once from the model. What the next tick needs of this one is in the
// state; `fingers` and `orientations` stay, to be read, and to be the reports of a tick that repeats the last one.
#pragma once
#include <vector>

#include "pincer/engine/world/scratch.h"
#include "pincer/grasp/step.h"

namespace pincer::grasp {

// A finger's way to the nearest body, in the middle of the tick.
struct NearestBody {
  double gap;  // as FingerReport::gap [m]
  Vec3 n_W;    // towards the finger, of any length; zero: none is near
  Vec3 d_W;    // from the finger's centre to its own point that is nearest [m]
};

struct GraspScratch {
  explicit GraspScratch(const GraspModel& model);
  engine::WorldScratch world;
  std::vector<engine::PointInput> inputs;
  std::vector<Quat> q_mid_WF;            // of the fingers in the middle of the tick
  std::vector<NearestBody> nearest;      // per finger; apart from its report, which is written when the tick is done
  std::vector<FingerReport> fingers;     // of the last tick that was computed
  std::vector<Quat> orientations;        // of the fingers at its end
  contact::FingerTracker spare_tracker;  // of shapes for which a finger has no place (FollowedShapes)
  // per finger, of the last tick that was computed; empty where no map is asked for
  std::vector<std::vector<Taxel>> taxels;
};

}  // namespace pincer::grasp
