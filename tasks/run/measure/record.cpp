#include "pincer/tasks/run/measure/record.h"

#include <algorithm>
#include <cmath>

namespace pincer::tasks {
namespace {

Record judged(std::string metric, double value, std::string unit, std::string relation, double bound, bool ok) {
  Record record;
  record.metric = std::move(metric);
  record.value = value;
  record.unit = std::move(unit);
  record.relation = std::move(relation);
  record.bound = bound;
  record.ok = ok && !std::isnan(value);
  return record;
}

}  // namespace

Record atMost(std::string metric, double value, std::string unit, double bound) {
  return judged(std::move(metric), value, std::move(unit), "<=", bound, value <= bound);
}
Record atLeast(std::string metric, double value, std::string unit, double bound) {
  return judged(std::move(metric), value, std::move(unit), ">=", bound, value >= bound);
}
Record exactly(std::string metric, double value, std::string unit, double bound) {
  return judged(std::move(metric), value, std::move(unit), "==", bound, value == bound);
}
Record unbounded(std::string metric, double value, std::string unit) {
  return judged(std::move(metric), value, std::move(unit), "<=", std::numeric_limits<double>::infinity(), true);
}

bool allOk(const std::vector<Record>& records) {
  return std::all_of(records.begin(), records.end(), [](const Record& r) { return r.ok; });
}

}  // namespace pincer::tasks
