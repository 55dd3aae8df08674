// The form that all measuring commands share.
#include <gtest/gtest.h>

#include <cmath>
#include <limits>

#include "pincer/contact/error.h"
#include "pincer/tasks/app/app.h"
#include "pincer/tasks/app/commands/measure_command.h"
#include "pincer/tasks/app/record_text.h"
#include "pincer/tasks/run/files/strict_json.h"
#include "pincer/tasks/run/measure/timing.h"
#include "pincer/tests/support/constants.h"

namespace pincer::tasks {
namespace {

using tests::kNan;

TEST(Record, IsOkWhereItsRelationHolds) {
  EXPECT_TRUE(atMost("a", 1, "-", 1).ok);
  EXPECT_FALSE(atMost("a", 1.001, "-", 1).ok);
  EXPECT_TRUE(atLeast("a", 1, "-", 1).ok);
  EXPECT_FALSE(atLeast("a", 0.999, "-", 1).ok);
  EXPECT_TRUE(exactly("a", 0, "-", 0).ok);
  EXPECT_FALSE(exactly("a", 1e-300, "-", 0).ok);
  EXPECT_TRUE(unbounded("a", 1e300, "-").ok);
}

TEST(Record, NothingMeasuredIsNeverOk) {
  for (const Record& r : {atMost("a", kNan, "-", 1), atLeast("a", kNan, "-", 1), exactly("a", kNan, "-", kNan),
                          unbounded("a", kNan, "-")}) {
    EXPECT_FALSE(r.ok);
  }
  EXPECT_FALSE(allOk({unbounded("a", 1, "-"), unbounded("b", kNan, "-")}));
  EXPECT_TRUE(allOk({}));
}

TEST(Record, JsonHasAllMembersAndNullForWhatIsNoNumber) {
  const JsonValue json =
      parseJson(recordJson({atMost("slip", 0.5, "um", 1), unbounded("peer", kNan, "us")}), "records");
  ASSERT_EQ(json.array().size(), 2u);
  const JsonValue& first = json.array()[0];
  EXPECT_EQ(first.at("metric").text(), "slip");
  EXPECT_EQ(first.at("value").number(), 0.5);
  EXPECT_EQ(first.at("unit").text(), "um");
  EXPECT_EQ(first.at("relation").text(), "<=");
  EXPECT_EQ(first.at("bound").number(), 1);
  EXPECT_TRUE(first.at("ok").boolean());
  EXPECT_EQ(first.at("seconds").number(), 0);
  EXPECT_EQ(json.array()[1].at("value").kind(), JsonValue::Kind::kNull);
  EXPECT_EQ(json.array()[1].at("bound").kind(), JsonValue::Kind::kNull);
}

TEST(Record, TableAlignsItsColumns) {
  const std::string table = recordTable({atMost("slip", 0.5, "um", 1), atMost("a much longer name", 123456, "ns", 1)});
  EXPECT_EQ(table,
            "what  figure               value unit  bound  \n"
            "      slip                   0.5 um    <= 1   ok\n"
            "      a much longer name  123456 ns    <= 1   FAIL\n");
}

TEST(MeasurementNames, MatchAnywhereWithStars) {
  EXPECT_TRUE(matches("contact/torus", ""));
  EXPECT_TRUE(matches("contact/torus", "tor"));
  EXPECT_TRUE(matches("contact/torus", "con*us"));
  EXPECT_TRUE(matches("contact/torus", "t?r"));
  EXPECT_TRUE(matches("aab", "ab"));
  EXPECT_FALSE(matches("contact/torus", "sphere"));
  EXPECT_FALSE(matches("contact/torus", "us*con"));
  EXPECT_FALSE(matches("", "?"));
}

int runWith(const std::vector<Measurement>& list, const MeasureOptions& options, std::string& out) {
  ::testing::internal::CaptureStdout();
  int exit_code = kExitInterrupted;
  try {
    exit_code = runMeasurements(list, options, "test");
  } catch (const std::runtime_error&) {  // as the program catches it
    exit_code = kExitUsage;
  }
  out = ::testing::internal::GetCapturedStdout();
  return exit_code;
}

TEST(Measurements, RunWhatIsSelectedAndFailTogether) {
  int runs = 0;
  const auto giving = [&](double value) {
    return [&runs, value](MeasureContext& context) {
      context.progress(0.5);
      ++runs;
      return std::vector{atMost("value", value, "-", 1)};
    };
  };
  const std::vector<Measurement> list = {{"good", giving(1)}, {"bad", giving(2)}};
  std::string out;
  EXPECT_EQ(runWith(list, {.json = true}, out), kExitCheckFailed);
  EXPECT_EQ(parseJson(out, "stdout").array()[1].at("name").text(), "bad");
  EXPECT_EQ(runs, 2);
  EXPECT_EQ(runWith(list, {.only = {"goo"}}, out), kExitOk);
  EXPECT_EQ(runs, 3);
  EXPECT_EQ(runWith(list, {.list = true}, out), kExitOk);
  EXPECT_EQ(out, "good\nbad\n");
  EXPECT_EQ(runWith(list, {.only = {"goo", "ugly"}}, out), kExitUsage);
  EXPECT_EQ(runs, 3);
}

TEST(Measurements, OneThatCannotBeMadeFailsAlone) {
  const auto broken = [](MeasureContext&) -> std::vector<Record> { throw InputError("no such file"); };
  const auto good = [](MeasureContext&) { return std::vector{atMost("value", 1, "-", 1)}; };
  std::string out;
  EXPECT_EQ(runWith({{"broken", broken}, {"good", good}}, {.json = true}, out), kExitCheckFailed);
  const JsonValue json = parseJson(out, "stdout");
  EXPECT_NE(json.array()[0].at("metric").text().find("no such file"), std::string::npos);
  EXPECT_FALSE(json.array()[0].at("ok").boolean());
  EXPECT_TRUE(json.array()[1].at("ok").boolean());
}

TEST(Timing, CallsInOrderAndAsOftenAsAsked) {
  std::int64_t next = 0;
  const CallCost cost = costOfCalls([&](std::int64_t i) { next = i == next ? next + 1 : -1; },
                                    {.warm_up = 10, .batches = 3, .calls_per_batch = 7, .single_calls = 5});
  EXPECT_EQ(next, 10 + 3 * 7 + 5);
  EXPECT_TRUE(std::isfinite(cost.median));
  EXPECT_LE(cost.p999, cost.worst);
}

TEST(Timing, AnArithmeticQuantileIsTheNearestRank) {
  EXPECT_EQ(quantileOf({3, 1, 2}, 0.5), 2);
  EXPECT_EQ(quantileOf({3, 1, 2}, 0), 1);
  EXPECT_EQ(quantileOf({3, 1, 2}, 1), 3);
  EXPECT_TRUE(std::isnan(quantileOf({}, 0.5)));
}

// Twenty times the work: any clock that counts it sees more than twice the cost, however busy the machine.
TEST(Timing, MoreWorkCostsMore) {
  const auto work = [](int n) {
    return [n] {
      volatile double x = 1;
      for (int i = 0; i < n; ++i) x = x * 1.0000001;
    };
  };
  EXPECT_GT(ratioOfCosts(work(400000), work(20000), 5), 2);
}

}  // namespace
}  // namespace pincer::tasks
