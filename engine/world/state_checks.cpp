#include "pincer/engine/world/state_checks.h"

#include <algorithm>
#include <cmath>

namespace pincer::engine {

bool isFinite(const MotionInput& in) {
  return in.X_WB.p.allFinite() && in.X_WB.q.coeffs().allFinite() && in.motion.v_W.allFinite() &&
         in.motion.w_W.allFinite();
}

bool isFinite(const PointInput& in) {
  // a NaN or infinity anywhere survives the sum
  const Vec3 sum = in.p_target_W + in.v_target_W + in.f_W + in.w_W + in.n_W;
  return std::isfinite(sum[0] + sum[1] + sum[2]);
}

bool isFinite(const DriveInput& in) { return std::isfinite(in.value) && std::isfinite(in.rate); }

bool isFinite(const WorldState& state) {
  double sum = 0;  // a NaN or infinity anywhere survives the sum
  for (const BodyState& b : state.bodies) sum += b.X_WI.p.sum() + b.X_WI.q.coeffs().sum() + b.v_W.sum() + b.L_W.sum();
  for (const Vec3& w_W : state.driven_w_W) sum += w_W.sum();
  for (const auto* numbers : {&state.tree_q, &state.tree_v}) {
    for (const double x : *numbers) sum += x;
  }
  for (const PointState& p : state.points)
    sum += p.p_W.sum() + p.v_W.sum() + p.twist + p.twist_rate + p.turn_W.sum() + p.turn_rate_W.sum();
  return std::isfinite(sum);
}

double largestDistance(const WorldModel& model, const WorldState& a, const WorldState& b) {
  double largest = 0;
  for (std::size_t i = 0; i < model.bodies.size(); ++i) {
    if (!model.bodies[i].dynamic) continue;
    const Pose &x = a.bodies[i].X_WI, &y = b.bodies[i].X_WI;
    const double turn = 2 * (x.q.conjugate() * y.q).vec().norm();
    largest =
        std::max(largest, (x.p - y.p).norm() + turn * (model.bodies[i].inner_radius + model.bodies[i].corner_reach));
  }
  for (std::size_t i = 0; i < a.points.size(); ++i)
    largest = std::max(largest, (a.points[i].p_W - b.points[i].p_W).norm());
  return largest;
}

}  // namespace pincer::engine
