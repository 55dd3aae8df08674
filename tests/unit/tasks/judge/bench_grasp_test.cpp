// `pincer bench grasp`: its quick measurements keep their promises wherever the tests
// run; those of time are left to the command.
#include <gtest/gtest.h>

#include <set>

#include "pincer/tasks/judge/bench/grasp/grasp_bench.h"

namespace pincer::tasks {
namespace {

TEST(GraspBench, QuickMeasurementsKeepTheirPromises) {
  const std::set<std::string> quick = {"hold/slip-onset", "hold/handover", "soft/limit-surface", "soft/rolling",
                                       "methods/friction"};
  std::size_t seen = 0;
  MeasureContext context;
  for (const Measurement& measurement : graspMeasurements({})) {
    if (!quick.contains(measurement.name)) continue;
    ++seen;
    for (const Record& record : measurement.run(context)) {
      EXPECT_TRUE(record.ok) << measurement.name << ": " << record.metric << " = " << record.value << " "
                             << record.unit;
    }
  }
  EXPECT_EQ(seen, quick.size());
}

TEST(GraspBench, NamesAreUnique) {
  std::set<std::string> names;
  for (const Measurement& measurement : graspMeasurements({}))
    EXPECT_TRUE(names.insert(measurement.name).second) << measurement.name;
}

}  // namespace
}  // namespace pincer::tasks
