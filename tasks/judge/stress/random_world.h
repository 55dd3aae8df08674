// random_world: worlds of a class of difficulty, drawn from a seed.
//
// Ranges, all drawn evenly in the logarithm: masses 0.1 g to 100 kg, sizes 1 mm to 1 m (objects that fingers hold: 10
// to 100 mm), ticks 0.1 to 10 ms, stiffness 10 to 1e6 N/m; friction 0 to 5, one in eight exactly 0.
#pragma once
#include <span>
#include <string_view>
#include <vector>

#include "pincer/grasp/step.h"
#include "pincer/tasks/lab/participants/random.h"

namespace pincer::tasks {

enum class StressClass {
  kMassRatio,  // stacks, each body up to 1e6 times as heavy as the next
  kRedundant,  // boxes pressed into corners of half-spaces: up to 12 contacts on one body
  kOverlap,    // bodies begin up to half their size deep in the floor and in each other
  kSpin,       // bodies spin at up to 500 rad/s above and on a floor
  kTick,       // ticks from 0.1 to 10 ms
  kInertia,    // needles and sheets, 1000 : 1
  kHeap,       // six to twelve bodies fall on a heap
  kStiffness,  // two fingers close on an object, 10 to 1e6 N/m
  kTeleport,   // fingers jump by up to 50 mm now and then
  kNoise,      // fingers tremble by up to 1 mm from tick to tick
  kPads,       // two to four flat pads of 5 to 40 mm close on an object, 10 to 1e4 N/m
  kWalls,  // bricks of mixed lengths laid 0 to 0.1 mm off, in any heading, friction 0.3 to 0.9, masses up to 1e3 : 1
  kHulls,  // five to twelve hulls fall into a crate
  kHit,    // such a wall, of like masses, hit by a ball at up to 10 m/s
  kCompounds,  // three to six bodies of two to five shapes each fall on a heap
  kJoints,     // trees of joints with limits, drives, springs and dry friction, masses up to 1e4 : 1 (random_tree.h)
  kCoarse,     // as pads, half of them spheres, that tremble by up to 1 mm; ticks from 0.1 to 10 ms
};
// By StressClass.
constexpr std::string_view kStressClassNames[] = {"mass-ratio", "redundant", "overlap",   "spin",   "tick",  "inertia",
                                                  "heap",       "stiffness", "teleport",  "noise",  "pads",  "walls",
                                                  "hulls",      "hit",       "compounds", "joints", "coarse"};

struct StressWorld {
  // `threads` solve it (engine::WorldOptions).
  StressWorld(StressClass kind, std::uint64_t seed, int threads = 1);

  // Where the fingers' devices are at the end of the next tick.
  std::span<const grasp::FingerInput> nextInputs();
  // Controls of drives for it. After nextInputs.
  std::span<const engine::DriveInput> controls() const { return controls_; }

  const std::vector<Vec3>& startDevices() const { return devices_; }  // one per finger [m]
  bool hasFingers() const { return !model.fingers.empty(); }
  // The most that the fingers' couplings may have given to bodies so far [J]: k R^2 + d v R of each, R how far its
  // device has been from where it began, or a pad deep in the object, and v its fastest. A spring that is stretched by
  // R holds half of that; a damper takes the device along by R.
  double mostWork() const;

  grasp::GraspModel model;
  std::vector<engine::BodyStart> starts;
  double allowed_lift = 0;  // the energy that leaving the initial overlap may add [J]
  int ticks = 200;

 private:
  StressClass kind_;
  Random random_;
  std::vector<Vec3> devices_;  // [m]
  std::vector<grasp::FingerInput> inputs_;
  std::vector<double> reach_, fastest_;  // of each device until now [m, m/s]
  std::vector<engine::DriveInput> controls_;
  std::int64_t tick_ = 0;
};

}  // namespace pincer::tasks
