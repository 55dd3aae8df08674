// joint_drawing: joints of a snapshot as things to draw: axes, stops, and how hard drives push.
//
//   axis     a rod along a pivot's or slider's axis, where the joint is on its body
//   stops    of a slider balls where it would be at them, of a pivot spokes; the thin one is where it is
//   drive    an arrow along the axis of each joint that it moves: its force, or its torque over the size of marks
#pragma once
#include <vector>

#include "pincer/tasks/run/tick/snapshot.h"
#include "pincer/tasks/view/draw_list.h"

namespace pincer::tasks {

// Meshes of marks (scene_drawing.cpp) and how large they are [m].
struct MarkMeshes {
  int ball = 0, rod = 0, head = 0;
  double size = 0.05;
};

class JointDrawing {
 public:
  explicit JointDrawing(const engine::WorldModel& model);
  void add(const Snapshot& snapshot, const MarkMeshes& marks, double metres_per_newton, DrawList& list) const;

 private:
  struct Look {
    engine::JointKind kind;
    int a, b;         // bodies, -1: the world
    Pose X_AJ, X_BJ;  // in the bodies' own frames
    double lower, upper;
    std::vector<std::pair<int, double>> drives;  // that move it, with its factor
  };
  void addStops(const Look& look, const Pose& X_WJ, const Pose& X_WK, const MarkMeshes& marks, DrawList& list) const;

  std::vector<Look> joints_;
};

// The pose of a mark that begins at a point and lies along a vector of any length but 0.
inline Pose pointing(const Vec3& from_W, const Vec3& along_W) {
  return {Quat(frameFromNormal(along_W.normalized())), from_W};
}

// An arrow of marks' meshes.
void addMarkArrow(const MarkMeshes& marks, const Vec3& from_W, const Vec3& along_W, double thickness,
                  const Paint& paint, DrawList& list);

}  // namespace pincer::tasks
