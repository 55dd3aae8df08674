// The accuracy suite (tasks/judge/verify): every figure within its bound.
#include "pincer/tasks/judge/verify/verify.h"

#include <fmt/format.h>
#include <gtest/gtest.h>

#include <cstdlib>

namespace pincer::tasks {
namespace {

class Verify : public testing::TestWithParam<std::size_t> {};

TEST_P(Verify, KeepsItsPromise) {
  const Measurement measurement = verifyMeasurements()[GetParam()];
  MeasureContext context;
  context.thorough = std::getenv("PINCER_LONG_TESTS") != nullptr;
  for (const Record& r : measurement.run(context)) {
    fmt::print("  {:<28} {:<52} {:>11.3g} {} {:<8.3g} {}\n", measurement.name, r.metric, r.value, r.relation, r.bound,
               r.unit);
    EXPECT_TRUE(r.ok) << measurement.name << ": " << r.metric << " = " << r.value << " " << r.unit;
  }
}

std::string testName(const testing::TestParamInfo<std::size_t>& info) {
  std::string name = verifyMeasurements()[info.param].name;
  for (char& c : name) c = std::isalnum(static_cast<unsigned char>(c)) ? c : '_';
  return name;
}

INSTANTIATE_TEST_SUITE_P(All, Verify, testing::Range<std::size_t>(0, verifyMeasurements().size()), testName);

}  // namespace
}  // namespace pincer::tasks
