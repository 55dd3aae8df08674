#include "pincer/tasks/run/expectation.h"

#include <cmath>
#include <limits>

namespace pincer::tasks {

double Expectation::excess(double measured) const {
  if (std::isnan(measured)) return std::numeric_limits<double>::infinity();
  switch (relation) {
    case Relation::kEqual:
      return std::abs(measured - value) - tolerance;
    case Relation::kAtMost:
      return measured - value - tolerance;
    case Relation::kAtLeast:
      return value - tolerance - measured;
  }
  return std::numeric_limits<double>::infinity();
}

ExpectationLog::ExpectationLog(std::vector<Expectation> expectations)
    : expectations_(std::move(expectations)), outcomes_(expectations_.size()) {}

void ExpectationLog::observe(std::int64_t tick, double time, const Moment& moment) {
  for (std::size_t i = 0; i < expectations_.size(); ++i) {
    const Expectation& expected = expectations_[i];
    if (expected.tick != Expectation::kAlways && expected.tick != tick) continue;
    if (expected.hash) {
      const std::string hash = hashText(moment.state.world);
      outcomes_[i] = {true, 0, hash == *expected.hash ? 0 : kInfinity, time, hash};
      continue;
    }
    const double measured = expected.quantity.measure(moment);
    const double excess = expected.excess(measured);
    if (!outcomes_[i].reached || excess > outcomes_[i].worst_excess) outcomes_[i] = {true, measured, excess, time, {}};
  }
}

bool ExpectationLog::anyFailed() const {
  for (const Outcome& outcome : outcomes_) {
    if (outcome.reached && !outcome.holds()) return true;
  }
  return false;
}

}  // namespace pincer::tasks
