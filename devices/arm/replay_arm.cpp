#include "pincer/devices/arm/replay_arm.h"

#include <algorithm>
#include <stdexcept>
#include <utility>

namespace pincer::devices {

ReplayArm::ReplayArm(std::string name, std::vector<ReplayPoint> points)
    : name_(std::move(name)), points_(std::move(points)) {
  if (points_.empty()) throw std::invalid_argument("recording " + name_ + ": it has no places.");
  for (std::size_t i = 0; i < points_.size(); ++i) {
    const bool sound = std::isfinite(points_[i].time) && points_[i].p_DF.allFinite() &&
                       (i == 0 || points_[i].time > points_[i - 1].time);
    if (!sound)
      throw std::invalid_argument("recording " + name_ + ": place " + std::to_string(i) +
                                  " isn't a number or doesn't come later.");
  }
  moveTo(0);
}

void ReplayArm::moveTo(double time) {
  sample_ = ArmSample{};
  sample_.time = time;
  sample_.valid = time <= points_.back().time;
  if (!sample_.valid) return;
  const auto next =
      std::lower_bound(points_.begin(), points_.end(), time, [](const ReplayPoint& p, double t) { return p.time < t; });
  if (next == points_.begin()) {
    sample_.p_DF = next->p_DF;
    return;
  }
  const ReplayPoint& last = *(next - 1);
  const double share = (time - last.time) / (next->time - last.time);
  sample_.p_DF = last.p_DF + share * (next->p_DF - last.p_DF);
  sample_.v_DF = (next->p_DF - last.p_DF) / (next->time - last.time);
}

}  // namespace pincer::devices
