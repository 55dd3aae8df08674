// sweep: a finger led once around an object in a plane, and what each variant of shading makes of it.
#pragma once
#include <vector>

#include "pincer/tasks/judge/bench/finger_path.h"

namespace pincer::tasks {

// The plane through B's origin with unit normal `axis`, offset by `offset` [m] along it.
struct SweepPlane {
  Vec3 axis = Vec3::UnitZ();
  double offset = 0;
};

// Counter-clockwise around `axis`, beginning over the place that a ray along `start` from outside meets, `length` [m]
// long, at 100 mm/s and the constant `depth` [m] under the mesh's surface as it is felt. Stays in the plane.
FingerPath sweepAround(const contact::SmoothMesh& mesh, const SweepPlane& plane, const Vec3& start, double length,
                       double depth);

// A circle about the axis of radius `R` [m] in the plane, at 100 mm/s, once around.
FingerPath circleAround(const SweepPlane& plane, double R);

struct SweepTrace {
  std::vector<Vec3> n;  // felt direction at each tick
  // on the finger within the plane, r times the direction's angle, unwrapped, 0 at the first tick [m]
  std::vector<double> place;
  std::vector<double> phi;  // of the main contact [m]
  int held = 0;             // ticks left without an answer
};
SweepTrace traceAlong(const contact::SmoothMesh& mesh, const FingerPath& path, const SweepPlane& plane);

// Largest change from one tick to the next.
double largestStep(const std::vector<double>& values);
// Largest minus smallest deviation of `values` from the straight line from first to last.
double rippleAboutLine(const std::vector<double>& values);

}  // namespace pincer::tasks
