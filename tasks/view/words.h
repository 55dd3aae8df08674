// words: things of a snapshot told in words, for the list of bodies and beside the pointer.
#pragma once
#include <string>

#include "pincer/tasks/run/tick/snapshot.h"

namespace pincer::tasks {

// A line of the list of bodies.
struct BodyRow {
  std::string name;
  Vec3 p_W = Vec3::Zero();  // of its frame [m]
  double speed = 0;         // of it [m/s]
  double turn = 0;          // since the start [rad]
  bool selected = false;
  std::string contacts;  // a line each; empty: not asked for, or none
};

// "(0.1, 2.0, 30.5) mm  0.0 mm/s  turned 3.1°".
std::string motionWords(const BodyRow& row);
// "1.60 N, sticks; on the pad 1.2 mm distal, 0.3 mm radial".
std::string fingerWords(const FingerSnapshot& finger);
// "index 1.60 N, sticks" and so on, a line per contact of `body`.
std::string contactWords(const Snapshot& snapshot, int body, const std::vector<std::string>& fingers,
                         const std::vector<std::string>& bodies);

}  // namespace pincer::tasks
