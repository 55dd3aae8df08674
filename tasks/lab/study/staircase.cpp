#include "pincer/tasks/lab/study/staircase.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <numeric>

#include "pincer/contact/elementary.h"
#include "pincer/contact/functions/invariants.h"

namespace pincer::tasks {

std::string problemWith(const StaircaseRule& r) {
  const auto said = [](const char* field, double value, const char* range) {
    return fmt::format("{} = {:g} is out of range {}", field, value, range);
  };
  if (r.up < 1) return said("up", r.up, "[1, inf)");
  if (r.down < 1) return said("down", r.down, "[1, inf)");
  if (!(r.large_step > 0)) return said("large_step", r.large_step, "(0, inf)");
  if (!(r.small_step > 0)) return said("small_step", r.small_step, "(0, inf)");
  if (r.large_reversals < 0) return said("large_reversals", r.large_reversals, "[0, inf)");
  if (r.reversals < 1) return said("reversals", r.reversals, "[1, inf)");
  if (r.averaged < 1 || r.averaged > r.reversals) return said("averaged", r.averaged, "[1, reversals]");
  if (!(r.lowest < r.highest)) return said("lowest", r.lowest, "(-inf, highest)");
  if (!(r.start >= r.lowest && r.start <= r.highest)) return said("start", r.start, "[lowest, highest]");
  if (r.most_trials < 1) return said("most_trials", r.most_trials, "[1, inf)");
  return {};
}

double convergencePoint(int down) { return math::pow(0.5, 1.0 / down); }

bool Staircase::over() const {
  return static_cast<int>(reversals_.size()) >= rule_.reversals || trials_ >= rule_.most_trials;
}

bool Staircase::answer(bool correct) {
  ++trials_;
  right_ = correct ? right_ + 1 : 0;
  wrong_ = correct ? 0 : wrong_ + 1;
  if (right_ == rule_.down) return move(-1);
  if (wrong_ == rule_.up) return move(+1);
  return false;
}

bool Staircase::move(int direction) {
  PINCER_ASSERT(rule_.lowest <= level_ && level_ <= rule_.highest);
  right_ = wrong_ = 0;
  const bool reversed = direction_ != 0 && direction != direction_;
  direction_ = direction;
  if (reversed) reversals_.push_back(level_);
  const double step = static_cast<int>(reversals_.size()) < rule_.large_reversals ? rule_.large_step : rule_.small_step;
  const double moved = rule_.steps_are_ratios ? level_ * math::pow(1 + step, direction) : level_ + direction * step;
  level_ = std::clamp(moved, rule_.lowest, rule_.highest);
  return reversed;
}

double Staircase::threshold() const {
  const auto n = static_cast<std::ptrdiff_t>(rule_.averaged);
  if (static_cast<std::ptrdiff_t>(reversals_.size()) < n) return std::numeric_limits<double>::quiet_NaN();
  return std::accumulate(reversals_.end() - n, reversals_.end(), 0.0) / static_cast<double>(n);
}

double Staircase::progress() const { return std::min(1.0, static_cast<double>(reversals_.size()) / rule_.reversals); }

}  // namespace pincer::tasks
