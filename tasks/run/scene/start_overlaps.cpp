#include "pincer/tasks/run/scene/start_overlaps.h"

#include <algorithm>
#include <map>
#include <utility>
#include <vector>

#include "pincer/engine/step.h"

namespace pincer::tasks {
namespace {

constexpr double kDrawnDepth = 1e-5;  // that a drawing may leave by rounding its numbers [m]; chosen

// Gaps are those of the middle of a tick: of what doesn't move they are those of the start.
void stopAll(engine::WorldState& state) {
  for (engine::BodyState& body : state.bodies) {
    body.v_W.setZero();
    body.L_W.setZero();
  }
  std::fill(state.tree_v.begin(), state.tree_v.end(), 0);
  std::fill(state.driven_w_W.begin(), state.driven_w_W.end(), Vec3::Zero());
}

}  // namespace

std::vector<StartOverlap> overlapsAtStart(const engine::WorldModel& model, const engine::WorldState& start) {
  engine::WorldState probe = start;
  stopAll(probe);
  std::vector<engine::PointInput> points(probe.points.size());
  for (std::size_t i = 0; i < points.size(); ++i) points[i].p_target_W = probe.points[i].p_target_W;
  const engine::ScratchHandle scratch = engine::makeScratch(model);
  engine::step(model, probe, *scratch, points);
  std::map<std::pair<int, int>, double> depths;
  for (int k = 0; k < engine::contactCount(*scratch); ++k) {
    const engine::ContactReport contact = engine::contactAt(*scratch, k);
    if (contact.point >= 0 || !(contact.gap < -kDrawnDepth)) continue;
    double& depth = depths[std::minmax(contact.body, contact.other_body)];
    depth = std::max(depth, -contact.gap);
  }
  std::vector<StartOverlap> overlaps;
  for (const auto& [pair, depth] : depths) overlaps.push_back({pair.first, pair.second, depth});
  std::stable_sort(overlaps.begin(), overlaps.end(), [](const auto& x, const auto& y) { return x.depth > y.depth; });
  return overlaps;
}

}  // namespace pincer::tasks
