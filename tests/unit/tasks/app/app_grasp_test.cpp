// `pincer sim --grasp`: how well the fingers hold, in words and as JSON.
#include <gtest/gtest.h>

#include "pincer/tasks/run/files/strict_json.h"
#include "pincer/tests/support/run_app.h"

namespace pincer::tasks {
namespace {

using tests::AppResult;
using tests::contains;
using tests::runPincer;

// 2 N each way, 0.1 kg: half the weight, 0.4905 N, of mu 2 N = 1 N; in all the weight needs m g / mu.
TEST(SimGrasp, PinchTellsItsMargins) {
  const AppResult r = runPincer({"sim", "s4_pinch", "--duration", "0.5", "--grasp", "--json"});
  const JsonValue json = parseJson(r.out, "stdout");
  const JsonValue& grasp = json.at("grasps").array().at(0);
  EXPECT_EQ(grasp.at("body").text(), "sphere");
  EXPECT_EQ(grasp.at("rank").number(), 5);
  EXPECT_FALSE(grasp.at("force_closure").boolean());
  EXPECT_NEAR(grasp.at("least_squeeze").number(), 1.962, 1e-6);
  EXPECT_NEAR(grasp.at("squeeze").number(), 4, 1e-9);
  for (const JsonValue& contact : grasp.at("contacts").array())
    EXPECT_NEAR(contact.at("slip_margin").number(), 0.5095, 1e-9);
  EXPECT_TRUE(contains(runPincer({"sim", "s4_pinch", "--duration", "0.5", "--grasp"}).out,
                       "no force closure: nothing resists a turn about (1.00, 0.00, 0.00)"));
}

TEST(SimGrasp, SaysThatNothingIsHeld) {
  EXPECT_TRUE(
      contains(runPincer({"sim", "s1_tumbling_box", "--duration", "0.01", "--grasp"}).out, "No finger presses a body"));
}

}  // namespace
}  // namespace pincer::tasks
