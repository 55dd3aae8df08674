// finger_path: ways of a fingertip's centre over an object, tick by tick, as a hand would lead
// it; and one finger that queries along them.
#pragma once
#include <cstdint>
#include <vector>

#include "pincer/contact/smooth_mesh.h"
#include "pincer/tasks/lab/participants/random.h"
#include "pincer/tasks/run/measure/measurement.h"

namespace pincer::tasks {

constexpr double kBenchFinger = 8e-3;  // radius r [m]
constexpr double kBenchTick = 1e-3;    // [s]
// further contacts nearer than this are reported, as a world's default asks for [m]
constexpr double kBenchMargin = 1e-3;

// The state of one finger, and the memory that its queries use.
struct BenchFinger {
  contact::SurfaceTracker tracker;
  contact::PatchCacheHandle cache = contact::makePatchCache();

  contact::SurfaceContacts on(const contact::SmoothMesh& mesh, const Vec3& p_BC, double margin = kBenchMargin) {
    return mesh.querySphere(p_BC, kBenchFinger, margin, tracker, *cache);
  }
};

struct FingerPath {
  std::vector<Vec3> centres;  // p_BC at each tick [m]
  int restart_every;  // ticks after which the finger leaves and comes down elsewhere, as a finger without memory
};

// A hand that strokes: heading and speed wander, depth sways between 0 and `depth`; every
// `restart_every` ticks it comes down at another place.
struct Stroke {
  std::int64_t ticks = 100000;
  double slowest = 0.03, fastest = 0.2;  // [m/s]
  double depth = 0.005;                  // [m], < r
  int restart_every = 1000;
  std::uint64_t seed = 1;
};
FingerPath strokeOver(const contact::SmoothMesh& mesh, const Stroke& stroke, MeasureContext& context);

Vec3 randomDirection(Random& random);

}  // namespace pincer::tasks
