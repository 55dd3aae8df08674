#include <gtest/gtest.h>
#include <rapidcheck/gtest.h>

#include <cmath>
#include <numbers>

#include "pincer/tasks/view/chart_board.h"
#include "pincer/tasks/view/sim_view.h"
#include "pincer/tasks/view/viewer.h"
#include "pincer/tasks/view/words.h"

namespace pincer::tasks {
namespace {

using devices::InputKind;

// A ball of 20 mm that floats, or that has lain on a floor until it sleeps.
Simulation ballScene(bool floats) {
  const std::string world =
      floats ? R"("gravity": [0, 0, 0], "bodies": [)"
             : R"("bodies": [{"name": "floor", "shape": {"type": "half_space", "point": [0, 0, -0.02]}},)";
  Simulation simulation(
      parseScene(R"({"version": 1, "duration": 10, "camera": {"yaw": 0, "pitch": 0}, )" + world +
                     R"({"name": "ball", "shape": {"type": "sphere", "radius": 0.02}, "mass": 0.1}]})",
                 "ball.json"));
  for (int i = 0; i < 500 && !floats; ++i) simulation.tick();
  return simulation;
}

void pullFor(double seconds, Simulation& simulation, BodyPull& pull) {
  for (int i = 0; i < std::lround(1000 * seconds); ++i) {
    const engine::AppliedForces applied = pull.forces(simulation.state().world, 1e-3);
    simulation.tick(simulation.nextFingers(), applied);
  }
}

// A critically damped spring: x(t) = d (1 - (1 + w t) exp(-w t)). The force is that of the tick's beginning, with the
// speed of the tick before: half a tick and one late, of 1 / w = 40 ticks, so 4 % of the way.
TEST(BodyPull, BringsAFloatingBodyLikeACriticallyDampedSpring) {
  Simulation simulation = ballScene(true);
  BodyPull pull(simulation.model());
  pull.take(0, Vec3::Zero(), Vec3(0.05, 0, 0));
  const double w = 2 * std::numbers::pi * 4;
  for (int i = 1; i <= 6; ++i) {
    pullFor(0.03, simulation, pull);
    const double wt = w * 0.03 * i;
    EXPECT_NEAR(simulation.bodyPose(0).p.x(), 0.05 * (1 - (1 + wt) * std::exp(-wt)), 0.04 * 0.05) << i;
  }
  pull.letGo();
  pullFor(0.001, simulation, pull);
  const double before = simulation.bodyPose(0).p.x();
  pullFor(0.001, simulation, pull);
  const double step = simulation.bodyPose(0).p.x() - before;
  pullFor(0.1, simulation, pull);
  EXPECT_NEAR(simulation.bodyPose(0).p.x(), before + 101 * step, 1e-12) << "nothing pulls any more";
}

TEST(BodyPull, LiftsABodyThatSleptAndHoldsItBelowTheHandByItsWeight) {
  Simulation simulation = ballScene(false);
  const int ball = 1;
  BodyPull pull(simulation.model());
  const double rest = simulation.bodyPose(ball).p.z();
  pull.take(ball, Vec3::Zero(), Vec3(0, 0, 0.08));
  pullFor(2, simulation, pull);
  const double w = 2 * std::numbers::pi * 4;
  EXPECT_NEAR(simulation.bodyPose(ball).p.z(), 0.08 - 9.81 / (w * w), 1e-6);
  pull.letGo();
  pullFor(1, simulation, pull);
  EXPECT_NEAR(simulation.bodyPose(ball).p.z(), rest, 1e-4);
}

// Taken off its centre it turns, and doesn't spin up: the place that was taken comes to the hand.
TEST(BodyPull, TakenAtItsRimABodyTurnsTowardsTheHandAndComesToRest) {
  Simulation simulation = ballScene(true);
  BodyPull pull(simulation.model());
  pull.take(0, Vec3(0, 0.02, 0), Vec3(0.06, 0.02, 0));
  pullFor(5, simulation, pull);
  EXPECT_LT((simulation.bodyPose(0) * Vec3(0, 0.02, 0) - Vec3(0.06, 0.02, 0)).norm(), 1e-4);
}

TEST(BodyPull, ByTheMouseWithControlMovesTheBodyUnderThePointer) {
  Simulation simulation = ballScene(true);
  const auto surface = devices::openOffscreen({640, 360});
  SnapshotChannel channel(snapshotOf(simulation));
  BodyPull pull(simulation.model());
  SceneCycle cycle(simulation, channel, nullptr, &pull);
  PaceControl pace;
  Viewer viewer(*surface, simulation.model(), snapshotOf(simulation), channel, pace, nullptr,
                {.camera = simulation.scene().camera, .pull = &pull});
  const auto move = [&](const Vec2& pixel) { viewer.handle({InputKind::kMove, 0, false, pixel.x(), pixel.y(), {}}); };
  const Vec2 ball = *viewer.painter().camera().toPixel(Vec3::Zero(), 640, 360);
  move(ball);
  viewer.handle({InputKind::kButton, devices::kButtonLeft, true, 0, 0, {}});
  EXPECT_FALSE(pull.holds()) << "without Control the button turns the camera";
  viewer.handle({InputKind::kButton, devices::kButtonLeft, false, 0, 0, {}});
  viewer.handle({InputKind::kKey, devices::kKeyControl, true, 0, 0, {}});
  viewer.handle({InputKind::kButton, devices::kButtonLeft, true, 0, 0, {}});
  ASSERT_TRUE(pull.holds());
  move(ball + Vec2(40, -30));
  for (int i = 0; i < 1000; ++i) cycle.tick(0);
  viewer.look();
  const Vec2 now = *viewer.painter().camera().toPixel(simulation.bodyPose(0).p, 640, 360);
  EXPECT_LT((now - ball - Vec2(40, -30)).norm(), 1) << now.transpose();
  viewer.handle({InputKind::kButton, devices::kButtonLeft, false, 0, 0, {}});
  EXPECT_FALSE(pull.holds());
}

RC_GTEST_PROP(ViewCamera, FindsThePlaceUnderAPixel, ()) {
  const auto number = [](int low, int high) { return 0.001 * *rc::gen::inRange(1000 * low, 1000 * high); };
  Camera camera;
  camera.yaw = number(-3, 3);
  camera.pitch = number(-1, 1);
  camera.distance = number(1, 3);
  const Vec3 p_W(number(-1, 1) / 4, number(-1, 1) / 4, number(-1, 1) / 4);
  const Vec2 pixel(*rc::gen::inRange(0, 1280), *rc::gen::inRange(0, 720));
  const Vec3 found_W = camera.fromPixel(pixel, 1280, 720, p_W);
  const auto seen = camera.toPixel(found_W, 1280, 720);
  RC_ASSERT(seen.has_value());
  RC_ASSERT((*seen - pixel).norm() < 0.05);  // toPixel is of single precision
  RC_ASSERT(std::abs((found_W - p_W).dot((camera.eye_W() - camera.target_W).normalized())) < 1e-12);
}

TEST(ChartBoard, ShowsSpeedTurnPlaceAndLoadOfTheBodyThatItFollows) {
  Snapshot snapshot;
  snapshot.X_WB.resize(2);
  snapshot.fingers.resize(2);
  snapshot.contacts.resize(2);
  ChartBoard board(snapshot, {"index", "thumb"});
  board.follow(1, "ball");
  for (const std::size_t quantity : {0u, 1u, 2u}) EXPECT_TRUE(board.toggle(quantity));  // no longer shown
  for (const std::size_t quantity : {3u, 4u, 5u, 6u, 7u}) EXPECT_TRUE(board.toggle(quantity));
  board.add(snapshot);
  snapshot.time = 0.5;
  snapshot.X_WB[1] = {quatFromRotationVector({0, 0, 0.5}), {0.03, 0, 0.04}};
  snapshot.contact_count = 2;
  snapshot.contacts[0] = {.finger = 0, .body = 1, .n_W = Vec3::UnitX(), .f_W = Vec3(2, 0, 0.5), .mu = 0.5};
  snapshot.contacts[1] = {.finger = -1, .body = 0, .other_body = 1, .f_W = Vec3(0, 0, 1)};
  board.add(snapshot);
  const std::vector<const StripChart*> charts = board.shown();
  ASSERT_EQ(charts.size(), 5u);
  EXPECT_EQ(charts[0]->title(), "ball, speed");
  EXPECT_NEAR(charts[0]->last(0), 100, 1e-9);  // 50 mm in half a second
  EXPECT_NEAR(charts[1]->last(0), 0.5 / kDegree, 1e-9);
  EXPECT_NEAR(charts[2]->last(2), 40, 1e-9);
  EXPECT_NEAR(charts[3]->last(0), std::sqrt(4.25) + 1, 1e-9);
  EXPECT_NEAR(charts[4]->last(0), 0.5, 1e-9);  // 0.5 N of 0.5 * 2 N
  EXPECT_EQ(charts[4]->last(1), 0);
  EXPECT_FALSE(ChartBoard(Snapshot(), {}).toggle(0)) << "there is no finger";
}

TEST(Words, OfContactsNameTheOtherOne) {
  Snapshot snapshot;
  snapshot.contacts = {{.finger = 0, .body = 1, .f_W = Vec3(1.5, 0, 0)},
                       {.finger = -1, .body = 0, .other_body = 1, .f_W = Vec3(0, 0, 2), .sliding = true}};
  snapshot.contact_count = 2;
  EXPECT_EQ(contactWords(snapshot, 1, {"index"}, {"floor", "ball"}), "index 1.50 N, sticks\nfloor 2.00 N, slides");
  EXPECT_EQ(contactWords(snapshot, 0, {"index"}, {"floor", "ball"}), "ball 2.00 N, slides");
  EXPECT_EQ(fingerWords({}), "in the air");
}

}  // namespace
}  // namespace pincer::tasks
