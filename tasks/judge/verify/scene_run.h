// scene_run: what the cases of the accuracy suite do with a scene: open, change, run through, bisect.
#pragma once
#include <algorithm>
#include <cmath>
#include <functional>
#include <numbers>
#include <string_view>

#include "pincer/tasks/run/measure/measurement.h"
#include "pincer/tasks/run/scene/builtin_scenes.h"
#include "pincer/tasks/run/simulation.h"

namespace pincer::tasks {

constexpr double kVerifyG = 9.81;  // of every scene of the suite [m/s^2]

inline void setFriction(Scene& scene, double mu) {
  for (engine::BodySpec& body : scene.bodies) body.material.mu_s = body.material.mu_d = mu;
}

// Gravity of a slope of angle `theta` whose downhill direction has the heading `heading` about z [rad].
inline Vec3 tiltedGravity(double theta, double heading) {
  return kVerifyG *
         Vec3(math::sin(theta) * math::cos(heading), math::sin(theta) * math::sin(heading), -math::cos(theta));
}

// Ticks that weren't clean. A case that promises exactness adds this to its records.
struct RunCount {
  std::int64_t ticks = 0, flagged = 0;
};

// The whole scene, tick by tick; `look` is called after each. Ends early when the user interrupts.
template <typename Look>
RunCount runThrough(Simulation& simulation, MeasureContext& context, const Look& look) {
  RunCount count;
  const std::int64_t ticks = simulation.scene().ticks();
  while (simulation.ticks() < ticks) {
    count.flagged += simulation.tick().status != engine::kStepOk;
    look();
    if (++count.ticks % 4096 != 0) continue;
    context.progress(static_cast<double>(count.ticks) / static_cast<double>(ticks));
    if (context.interrupted()) break;
  }
  return count;
}

// Tells when a world has come to rest for good: a tick follows from the last state and its inputs alone, so that where
// a second of ticks has changed no bit but the clock's, the rest of a minute need not be computed.
class Standstill {
 public:
  // After each tick whose inputs are those of the last one.
  bool noted(const engine::WorldState& state) {
    but_the_clock_ = state;
    but_the_clock_.time = 0;
    but_the_clock_.tick = 0;
    const std::uint64_t hash = engine::hashOf(but_the_clock_);
    same_ = hash == last_ ? same_ + 1 : 0;
    last_ = hash;
    return same_ >= kForGood;
  }

 private:
  static constexpr int kForGood = 1000;  // ticks, more than any memory of fingers' looks counts
  engine::WorldState but_the_clock_;
  std::uint64_t last_ = 0;
  int same_ = 0;
};

// The value between `low`, where holds() is false, and `high`, where it is true, at which
// it changes, to 2^-steps of the distance.
inline double threshold(double low, double high, int steps, const std::function<bool(double)>& holds) {
  for (int i = 0; i < steps; ++i) {
    const double middle = 0.5 * (low + high);
    (holds(middle) ? high : low) = middle;
  }
  return 0.5 * (low + high);
}

}  // namespace pincer::tasks
