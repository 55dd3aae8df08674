#include <gtest/gtest.h>

#include "pincer/tasks/run/scene/builtin_scenes.h"
#include "pincer/tasks/view/sim_view.h"
#include "pincer/tasks/view/viewer.h"

namespace pincer::tasks {
namespace {

using devices::InputEvent;
using devices::InputKind;

// A person at the window, played: the viewer's own events, the servo's own ticks, in virtual time.
class PlayedPerson {
 public:
  explicit PlayedPerson(std::string_view scene = "pickup")
      : simulation_(readBuiltinScene(scene)),
        hand_(mouseMounts(simulation_.scene())),
        start_(snapshotOf(simulation_)),
        channel_(start_),
        cycle_(simulation_, channel_, &hand_),
        paced_(cycle_, pace_, 1000),
        surface_(devices::openOffscreen({320, 180})),
        viewer_(*surface_, simulation_.model(), start_, channel_, pace_, &hand_, {}) {}

  void wait(double seconds) {
    for (int i = 0; i < std::lround(1000 * seconds); ++i) paced_.tick(1e-3 * static_cast<double>(ticks_++));
  }
  void button(int code, bool down) { viewer_.handle({InputKind::kButton, code, down, x_, y_, {}}); }
  void moveBy(double x, double y) { viewer_.handle({InputKind::kMove, 0, false, x_ += x, y_ += y, {}}); }
  void key(int code) { viewer_.handle({InputKind::kKey, code, true, 0, 0, {}}); }
  double height() const { return simulation_.bodyPose(1).p.z(); }
  SceneCycle& cycle() { return cycle_; }
  Viewer& viewer() { return viewer_; }
  PaceControl& pace() { return pace_; }
  Simulation& simulation() { return simulation_; }

 private:
  Simulation simulation_;
  devices::MouseHand hand_;
  Snapshot start_;
  SnapshotChannel channel_;
  SceneCycle cycle_;
  PaceControl pace_;
  PacedCycle paced_;
  std::unique_ptr<devices::Surface> surface_;
  Viewer viewer_;
  double x_ = 160, y_ = 90;
  long ticks_ = 0;
};

TEST(MousePickup, PinchesLiftsHoldsAndLetsGo) {
  PlayedPerson person;
  person.moveBy(0, 0);
  person.wait(0.2);
  person.button(devices::kButtonLeft, true);
  person.wait(1.5);
  for (int i = 0; i < 30; ++i) {
    person.moveBy(0, -1);
    person.wait(0.03);
  }
  person.wait(0.5);
  const double lifted = person.height() - 0.02;
  EXPECT_GT(lifted, 0.02);  // 30 of 180 pixels of a picture that is 0.166 m high
  EXPECT_NEAR(person.cycle().lift(), lifted, 5e-3);
  person.wait(2);
  EXPECT_NEAR(person.height() - 0.02, lifted, 1e-4);  // held: nothing creeps
  person.button(devices::kButtonLeft, false);
  person.wait(1);
  EXPECT_LT(person.height(), 0.05);  // fallen back into the dish
}

// The robot holds the cube until 4 s, then lets go of it.
TEST(MousePickup, TakesACubeFromAGripper) {
  PlayedPerson person("takeover");
  const Scene& scene = person.simulation().scene();
  const auto measured = [&](const char* quantity) {
    return quantityOf(quantity, scene).measure(person.simulation().moment());
  };
  person.moveBy(0, 0);
  person.wait(2.5);
  EXPECT_GT(measured("cube|left_tip.normal_force"), 2);
  person.button(devices::kButtonLeft, true);
  person.wait(1.4);
  EXPECT_EQ(measured("index.touching"), 1);
  const double before = measured("cube.p_z");
  person.wait(1.6);
  EXPECT_EQ(measured("cube|left_tip.touching"), 0);
  // The hand carries it now: on each side the finger's spring of 1 kN/m and the arm's of 400 N/m.
  EXPECT_NEAR(before - measured("cube.p_z"), 0.5 * 0.1 * 9.81 * (1 / 1000.0 + 1 / 400.0), 1e-6);
  for (int i = 0; i < 20; ++i) {
    person.moveBy(1, 1);
    person.wait(0.03);
  }
  person.wait(0.5);
  EXPECT_LT(measured("cube.p_z"), before - 5e-3);
  EXPECT_GT(measured("cube.p_x"), 5e-3);
  const double carried = measured("cube.p_z");
  person.wait(2);
  EXPECT_NEAR(measured("cube.p_z"), carried, 1e-5);  // held: nothing creeps
  person.button(devices::kButtonLeft, false);
  person.wait(1);
  EXPECT_LT(measured("cube.p_z"), carried - 0.02);
}

// A pickup can be held still, and goes on where it stood.
TEST(MousePickup, SpacePausesAndRightTakesATick) {
  PlayedPerson person;
  person.wait(0.1);
  person.key(' ');
  person.wait(0.1);
  EXPECT_EQ(person.simulation().ticks(), 100);
  person.key(devices::kKeyRight);
  person.key(devices::kKeyRight);
  person.wait(0.1);
  EXPECT_EQ(person.simulation().ticks(), 102);
  person.key(' ');
  person.wait(0.1);
  EXPECT_EQ(person.simulation().ticks(), 202);
}

TEST(MousePickup, KeysSwitchWhatIsShown) {
  PlayedPerson person;
  EXPECT_TRUE(person.viewer().choice().forces);
  person.key('F');
  EXPECT_FALSE(person.viewer().choice().forces);
  person.key('F');
  EXPECT_TRUE(person.viewer().choice().forces);
}

}  // namespace
}  // namespace pincer::tasks
