#include <gtest/gtest.h>
#include <rapidcheck/gtest.h>

#include <vector>

#include "pincer/tasks/run/servo/paced_cycle.h"
#include "pincer/tasks/view/label_layout.h"
#include "pincer/tasks/view/strip_chart.h"
#include "pincer/tasks/view/timeline.h"

namespace pincer::tasks {
namespace {

bool overlap(const Vec2& a, const Vec2& size_a, const Vec2& b, const Vec2& size_b) {
  const Vec2 apart = (a - b).cwiseAbs(), least = 0.5 * (size_a + size_b);
  return apart.x() < least.x() && apart.y() < least.y();
}

// Up to eight labels (the most that the viewer writes beside contacts of bodies), all at one place or anywhere near it.
RC_GTEST_PROP(LabelLayout, NoLabelLiesOverAnotherNorOutside, ()) {
  const auto count = static_cast<std::size_t>(*rc::gen::inRange(1, 9));
  const int spread = *rc::gen::inRange(0, 200);
  const Vec2 picture(1280, 720);
  std::vector<LabelBox> labels;
  for (std::size_t i = 0; i < count; ++i) {
    const Vec2 anchor(640 + *rc::gen::inRange(-spread, spread + 1), 360 + *rc::gen::inRange(-spread, spread + 1));
    labels.push_back({anchor, Vec2(*rc::gen::inRange(40, 90), 20)});
  }
  const std::vector<Vec2> places = layOut(labels, {}, picture);
  RC_ASSERT(places.size() == count);
  for (std::size_t i = 0; i < count; ++i) {
    RC_ASSERT((places[i] - 0.5 * labels[i].size).minCoeff() >= 0);
    RC_ASSERT((picture - places[i] - 0.5 * labels[i].size).minCoeff() >= 0);
    for (std::size_t k = 0; k < i; ++k) RC_ASSERT(!overlap(places[i], labels[i].size, places[k], labels[k].size));
  }
}

TEST(LabelLayout, LeavesLabelsThatAreFreeWhereTheyBelong) {
  const std::vector<LabelBox> labels = {{Vec2(100, 100), Vec2(50, 20)}, {Vec2(300, 100), Vec2(50, 20)}};
  const std::vector<Vec2> places = layOut(labels, {}, Vec2(640, 360));
  EXPECT_EQ(places[0], labels[0].anchor);
  EXPECT_EQ(places[1], labels[1].anchor);
}

// Forces inside a small gripper were written over it.
TEST(LabelLayout, KeepsOffTheThingWhereThereIsRoom) {
  const Eigen::AlignedBox2d gripper(Vec2(560, 300), Vec2(720, 420));
  const std::vector<LabelBox> labels = {{Vec2(600, 340), Vec2(60, 20)}, {Vec2(680, 340), Vec2(60, 20)}};
  for (const Vec2& place : layOut(labels, {gripper}, Vec2(1280, 720)))
    EXPECT_FALSE(overlap(place, labels[0].size, gripper.center(), gripper.sizes())) << place.transpose();
  // A thing that fills the picture leaves no room: labels avoid each other alone.
  const Eigen::AlignedBox2d wall(Vec2(0, 0), Vec2(1280, 720));
  EXPECT_EQ(layOut(labels, {wall}, Vec2(1280, 720))[0], labels[0].anchor);
}

Snapshot at(double time, bool touching, bool sliding) {
  Snapshot snapshot;
  snapshot.time = time;
  snapshot.fingers.resize(1);
  snapshot.fingers[0].touching = touching;
  snapshot.fingers[0].sliding = sliding;
  return snapshot;
}

TEST(Timeline, TellsWhenAFingerTouchesSlipsHoldsAndLetsGo) {
  Timeline timeline;
  timeline.add(at(0, false, false));
  timeline.add(at(1, true, false));
  timeline.add(at(2, true, true));
  timeline.add(at(3, true, false));
  timeline.add(at(4, false, false));
  ASSERT_EQ(timeline.moments().size(), 4u);
  const std::vector<std::string> names = {"index"};
  EXPECT_EQ(momentText(timeline.moments()[0], names), "index touches");
  EXPECT_EQ(momentText(timeline.moments()[1], names), "index slips");
  EXPECT_EQ(momentText(timeline.moments()[2], names), "index holds again");
  EXPECT_EQ(momentText(timeline.moments()[3], {}), "finger 1 lets go");
  EXPECT_EQ(timeline.before(2.5)->time, 2);
  EXPECT_EQ(timeline.before(0.5), nullptr);
  timeline.add(at(1.5, true, false));  // the person began again from there
  EXPECT_EQ(timeline.moments().size(), 1u);
}

TEST(Timeline, HasRoundTimesOfWhichSoManyFit) {
  EXPECT_NEAR(tickStep(4, 8), 0.5, 1e-12);
  EXPECT_NEAR(tickStep(60, 12), 5, 1e-12);
  EXPECT_NEAR(tickStep(0.013, 10), 0.002, 1e-12);
}

// Round-off was drawn over the whole height of the chart: "height: -4.86e-14 mm".
TEST(StripChart, DrawsRoundOffAsNothing) {
  StripChart chart("height", "mm", {""}, 1e-3);
  chart.add(0, {0});
  chart.add(1, {-4.86e-14});
  EXPECT_EQ(chart.last(0), 0);
  EXPECT_EQ(chart.range().low, 0);
  EXPECT_EQ(chart.range().high, 0.01);
  chart.add(2, {2e-3});  // twice the dead band isn't drawn over the whole height either
  EXPECT_EQ(chart.last(0), 2e-3);
  EXPECT_EQ(chart.range().high, 0.01);
}

class CountingCycle final : public ServoCycle {
 public:
  explicit CountingCycle(int most) : most_(most) {}
  bool tick(double) override { return ++ticks < most_; }
  void cutForces() noexcept override {}
  int ticks = 0;

 private:
  int most_;
};

TEST(PacedCycle, GoesEightTimesAsFastAndSaysWhenItIsOver) {
  CountingCycle inner(100);
  PaceControl pace;
  pace.linger = true;
  pace.speed = 8;
  PacedCycle paced(inner, pace, 1000);
  for (int i = 0; i < 5; ++i) EXPECT_TRUE(paced.tick(0));
  EXPECT_EQ(inner.ticks, 40);
  EXPECT_FALSE(pace.ended);
  for (int i = 0; i < 20; ++i) EXPECT_TRUE(paced.tick(0));  // it lingers
  EXPECT_EQ(inner.ticks, 100);
  EXPECT_TRUE(pace.ended);
}

}  // namespace
}  // namespace pincer::tasks
