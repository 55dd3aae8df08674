#include "pincer/tasks/judge/bench/engine/bench_world.h"

namespace pincer::tasks {

Vec3 guidingForce(const BenchBody& body, const BenchMotion& motion, double t, double h) {
  const BenchAim aim = body.aim ? body.aim(t) : BenchAim{};
  Vec3 f = aim.f_W;
  for (int k = 0; k < 3; ++k) {
    if (body.locked[static_cast<std::size_t>(k)]) f[k] = 0;
    f[k] += body.stiffness[k] * (aim.p_W[k] - motion.X_WB.p[k]);
    f[k] += body.damping[k] * (aim.v_W[k] - motion.v_W[k]) / (1 + h * body.damping[k] / body.mass);
  }
  return f;
}

}  // namespace pincer::tasks
