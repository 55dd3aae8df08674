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
