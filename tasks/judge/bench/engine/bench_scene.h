// bench_scene: a world, how long it runs, and what its error is: the distance from an exact
// answer (tasks/judge/exact), in one number.
//
// A judge also says whether the scene moved as it should at all: a box that sticks where it should
// slide has no error worth a plot, it failed.
#pragma once
#include <limits>
#include <string>
#include <vector>

#include "pincer/tasks/judge/bench/engine/bench_world.h"

namespace pincer::tasks {

constexpr double kBenchG = 9.81;  // [m/s^2]

struct BenchVerdict {
  double error = std::numeric_limits<double>::quiet_NaN();  // in the scene's unit
  std::string failure = {};                                 // why it didn't move as it should; empty: it did
};

struct BenchJudge {
  // after each step; false ends the run. Null: nothing to look at
  std::function<bool(double t, BenchEngine&)> look = {};
  std::function<BenchVerdict(BenchEngine&)> verdict;  // at the end
};

struct BenchScene {
  std::string name;    // "s2/slide-to-roll"
  std::string metric;  // "position at 1 s, error"
  std::string unit;
  double duration = 1;             // [s], a whole number of the longest steps
  double floor = 0;                // errors below are round-off and count as this, in `unit`
  double error_bound = kInfinity;  // what pincer promises at a step of 1 ms, in `unit`
  double cost_bound = kInfinity;   // [us] per step of 1 ms
  std::vector<double> steps = {8e-3, 4e-3, 2e-3, 1e-3, 5e-4, 2.5e-4};
  BenchWorld world = {};
  std::function<BenchJudge()> judge = {};
  bool even = true;     // its steps cost the same all along: timed on the first of them
  double patience = 6;  // of processor time that one run may take [s]
};

// In the order of docs/benchmarks.md. `whole`: the scenes of a minute last a minute, and there are 1000 spheres.
// `models`: a directory of robots to run too (benchRobotScenes); empty: none. Throws InputError.
std::vector<BenchScene> benchScenes(bool whole, const std::string& models = {});

// Its parts, one source file each.
std::vector<BenchScene> benchFreeScenes(bool whole);
std::vector<BenchScene> benchSlidingScenes();
std::vector<BenchScene> benchPinchScenes(bool whole);
std::vector<BenchScene> benchImpactScenes(bool whole);
std::vector<BenchScene> benchRestingScenes(bool whole);
std::vector<BenchScene> benchTopplingScenes();
// Robots that the program carries, and each MJCF file of the directory `models` from its first keyframe on (or as
// drawn): what is free there is held, and where nothing is, the robot moves.
std::vector<BenchScene> benchRobotScenes(const std::string& models);

// Bodies that many scenes have.
BenchBody benchFloor();
BenchBody benchBall(double mass, double radius, const Vec3& p_W, const Vec3& v_W = Vec3::Zero(),
                    const Vec3& w_W = Vec3::Zero());
BenchBody benchBox(double mass, const Vec3& half, const Vec3& p_W, const Vec3& v_W = Vec3::Zero(),
                   const Vec3& w_W = Vec3::Zero());

// A fingertip of 8 mm and 50 g, free along `axis` (0: x, 1: y), which `force` [N] pushes, signed.
BenchBody benchFinger(const Vec3& p_W, int axis, const std::function<double(double t)>& force);

// A judge of the last moment alone.
BenchJudge judgeOfEnd(std::function<BenchVerdict(BenchEngine&)> verdict);

}  // namespace pincer::tasks
