// record: one measured figure beside what pincer promises of it.
//
//   ok = value relation bound,   false wherever the value is NaN
//
// `value` and `bound` are in `unit`, which a person reads (um, ns, degrees): these are results,
// not quantities that a computation goes on with. A figure without a promise (a peer's, a
// baseline) has the relation <= and the bound infinity.
#pragma once
#include <limits>
#include <string>
#include <vector>

namespace pincer::tasks {

struct Record {
  std::string name;    // of the measurement: "contact/torus"
  std::string metric;  // what was measured: "warm query, median"
  double value = std::numeric_limits<double>::quiet_NaN();
  std::string unit;             // "-" for none
  std::string relation = "<=";  // <=, >= or ==
  double bound = std::numeric_limits<double>::infinity();
  bool ok = false;
  double seconds = 0;  // that the measurement took which gave this figure, all its figures together [s]
};

Record atMost(std::string metric, double value, std::string unit, double bound);
Record atLeast(std::string metric, double value, std::string unit, double bound);
Record exactly(std::string metric, double value, std::string unit, double bound);  // equal to the last bit: counts
Record unbounded(std::string metric, double value, std::string unit);  // shown, promised nothing; ok unless NaN

bool allOk(const std::vector<Record>& records);

}  // namespace pincer::tasks
