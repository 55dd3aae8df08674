#include "pincer/tasks/judge/bench/finger_path.h"

#include <algorithm>
#include <cmath>

namespace pincer::tasks {
namespace {

// Comes from outside along a random line through the middle and presses to the surface that it meets.
Vec3 comeDown(const contact::SmoothMesh& mesh, BenchFinger& finger, Random& random) {
  finger.tracker = {};
  const Vec3 far = 2 * mesh.boundingRadius() * randomDirection(random);
  const contact::SurfaceContact met = finger.on(mesh, far).main();
  return met.p_BS + kBenchFinger * met.n_B;
}

double sway(double low, double high, std::int64_t tick, double period) {
  return low + (high - low) * (0.5 - 0.5 * math::cos(2 * M_PI * static_cast<double>(tick) / period));
}

}  // namespace

Vec3 randomDirection(Random& random) {
  const double z = random.uniform(-1, 1), a = random.uniform(0, 2 * M_PI);
  return {std::sqrt(1 - z * z) * math::cos(a), std::sqrt(1 - z * z) * math::sin(a), z};
}

FingerPath strokeOver(const contact::SmoothMesh& mesh, const Stroke& stroke, MeasureContext& context) {
  FingerPath path{{}, stroke.restart_every};
  path.centres.reserve(static_cast<std::size_t>(stroke.ticks));
  BenchFinger finger;
  Random random(stroke.seed);
  Vec3 C = Vec3::Zero(), heading = Vec3::UnitX();
  contact::SurfaceContact touch{Vec3::Zero(), Vec3::UnitZ()};
  for (std::int64_t i = 0; i < stroke.ticks && !context.interrupted(); ++i) {
    if (i % stroke.restart_every == 0) {
      C = comeDown(mesh, finger, random);
      heading = randomDirection(random);
    } else {
      const double step = kBenchTick * sway(stroke.slowest, stroke.fastest, i, 331);
      const double wanted = sway(0, stroke.depth, i, 719);
      heading += 0.04 * randomDirection(random);
      heading = (heading - heading.dot(touch.n_B) * touch.n_B).normalized();
      const double down = std::clamp(-wanted - touch.phi, -0.5 * step, 0.5 * step);
      C += std::sqrt(step * step - down * down) * heading + down * touch.n_B;
    }
    touch = finger.on(mesh, C).main();
    path.centres.push_back(C);
    context.progress(0.5 * static_cast<double>(i) / static_cast<double>(stroke.ticks));
  }
  return path;
}

}  // namespace pincer::tasks
