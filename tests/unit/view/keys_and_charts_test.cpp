#include <gtest/gtest.h>

#include <fstream>
#include <set>
#include <sstream>

#include "pincer/devices/window/input.h"
#include "pincer/tasks/view/history.h"
#include "pincer/tasks/view/keys.h"
#include "pincer/tasks/view/strip_chart.h"

namespace pincer::tasks {
namespace {

TEST(ViewerKeys, AreTheOnesInTheDocumentation) {
  std::ifstream file(PINCER_SOURCE_DIR "/docs/keys.md");
  std::stringstream text;
  text << file.rdbuf();
  EXPECT_EQ(text.str(), keysMarkdown()) << "`pincer keys` prints it";
}

TEST(ViewerKeys, EachMeansOneThing) {
  std::set<int> seen;
  for (const KeyGroup& group : keyGroups().first(keyGroups().size() - 1)) {
    for (const KeyBinding& key : group.keys) EXPECT_TRUE(seen.insert(key.code).second) << key.name;
  }
}

TEST(ViewerKeys, ArrowsMeanTheFingersWhereThereAreSome) {
  EXPECT_EQ(actionOf(devices::kKeyRight, false), ViewAction::kTickForward);
  EXPECT_EQ(actionOf(devices::kKeyRight, true), ViewAction::kHandRight);
  EXPECT_EQ(actionOf('X', false), std::nullopt);
}

TEST(StripChart, KeepsTheLastSecondsAndARoundScale) {
  StripChart chart("grip", "N", {"index", "thumb"});
  for (int i = 0; i <= 1000; ++i) chart.add(0.01 * i, {0.0, 0.13 * i / 100});
  EXPECT_NEAR(chart.points().front().time, 2, 1e-9);
  EXPECT_EQ(chart.range().low, 0);
  EXPECT_EQ(chart.range().high, 2);
  EXPECT_NEAR(chart.at(5.004)->values[1], 0.65, 1e-9);  // under the cursor
  EXPECT_NEAR(chart.at(0)->time, 2, 1e-9);
  chart.add(0.5, {0, -0.3});  // the person went back
  EXPECT_EQ(chart.points().size(), 1u);
  EXPECT_EQ(chart.range().low, -0.5);
}

TEST(ViewHistory, FindsWhatWasShownAtATime) {
  History history(100);
  Snapshot snapshot;
  for (int i = 0; i < 150; ++i) {
    snapshot.tick = i;
    snapshot.time = 0.1 * i;
    history.add(snapshot);
    history.add(snapshot);  // the same tick again isn't kept twice
  }
  EXPECT_EQ(history.size(), 100u);
  EXPECT_EQ(history.at(history.find(9.95)).tick, 99);
  EXPECT_EQ(history.find(-1), 0u);
  EXPECT_EQ(history.find(1e9), 99u);
}

}  // namespace
}  // namespace pincer::tasks
