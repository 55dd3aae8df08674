// The scenes S1 to S5 against their exact solutions. The bounds are what pincer promises (and each is beyond what the best other engine
// reached in the same scene at the same step).
#include <algorithm>
#include <cmath>
#include <numbers>

#include "tests/accuracy/exact_solutions.h"
#include "tests/accuracy/measured.h"

namespace pincer::tasks {
namespace {

constexpr double kG = 9.81;
constexpr double kSlope = 20 * std::numbers::pi / 180;

TEST(S1TumblingBox, TurnsAsEulersEquationsSay) {
  Simulation sim = openScene("s1_tumbling_box");
  const Vec3 half(0.01, 0.02, 0.04);
  const Vec3 moments =
      0.1 / 3 *
      Vec3(half.y() * half.y() + half.z() * half.z(), half.x() * half.x() + half.z() * half.z(), half.x() * half.x() + half.y() * half.y());
  for (int i = 0; i < 1000; ++i) sim.tick();
  const Quat q_exact = exact::freeRotation(moments, {0.02, 20, 0.02}, 1);
  expectBelow("S1 angle at 1 s", angleBetween(q_exact, sim.bodyPose(0).q), 1e-6, "rad");
}

TEST(S1TumblingBox, KeepsEnergyAndMomentumForAMinute) {
  Simulation sim = openScene("s1_tumbling_box");
  const double energy = engine::kineticEnergy(sim.model().world, sim.state().world);
  const Vec3 momentum = sim.state().world.bodies[0].L_W;
  double energy_drift = 0, momentum_drift = 0;
  runThrough(sim, [&] {
    energy_drift = std::max(energy_drift, std::abs(engine::kineticEnergy(sim.model().world, sim.state().world) / energy - 1));
    momentum_drift = std::max(momentum_drift, (sim.state().world.bodies[0].L_W - momentum).norm() / momentum.norm());
  });
  expectBelow("S1 energy drift in 60 s", energy_drift, 1e-7, "-");
  expectBelow("S1 angular momentum drift in 60 s", momentum_drift, 1e-14, "-");
}

TEST(S2SlideToRoll, EndsWhereTheClosedFormSays) {
  Simulation sim = openScene("s2_slide_to_roll");
  const exact::SlideToRoll exact{1, 0.2, kG};
  double rise = 0;
  runThrough(sim, [&] { rise = std::max(rise, std::abs(sim.bodyPose(1).p.z() - 0.02)); });
  expectBelow("S2 position at 1 s", 1e3 * std::abs(sim.bodyPose(1).p.x() - exact.position(1)), 1e-3, "mm");
  expectBelow("S2 velocity at 1 s, relative", std::abs(sim.state().world.bodies[1].v_W.x() / exact.velocity(1) - 1), 1e-6, "-");
  expectBelow("S2 height, largest deviation", 1e3 * rise, 1e-6, "mm");
}

class S3Incline : public testing::TestWithParam<double> {  // downhill's heading [rad]
 protected:
  Vec3 downhill() const { return {std::cos(GetParam()), std::sin(GetParam()), 0}; }
  std::string suffix() const { return GetParam() == 0 ? "" : "_30deg"; }
  std::string label() const { return GetParam() == 0 ? "" : " at 30 degrees"; }

  void compareSlide(const std::string& scene, double v0, const std::string& what) const {
    Simulation sim = openScene(scene);
    runThrough(sim, [] {});
    const double way = exact::Slope{kSlope, std::tan(kSlope) / 1.05, kG}.way(v0, sim.time());
    const Vec3 p = sim.bodyPose(1).p;
    expectBelow(what + label() + ", relative", std::abs(p.dot(downhill()) / way - 1), 1e-9, "-");
    expectBelow(what + label() + ", sideways, relative", std::abs(p.cross(downhill()).z()) / way, 1e-9, "-");
  }
};

// The table's figure is where the box is after 10 s (and the harness's: after the first second). In between, what the solver leaves at its
// tolerance makes it swing about its anchor by a few 1e-15 m for some ticks; that is bounded too.
TEST_P(S3Incline, SticksWithoutCreep) {
  Simulation sim = openScene("s3_incline_stick" + suffix());
  const Vec3 start = sim.bodyPose(1).p;
  double swing = 0, first_second = 0;
  runThrough(sim, [&] {
    const double offset = 1e6 * (sim.bodyPose(1).p - start).norm();
    swing = std::max(swing, offset);
    if (sim.ticks() == 1000) first_second = offset;
  });
  expectBelow("S3 sticking" + label() + ", after 1 s", first_second, 1e-9, "um");
  expectBelow("S3 sticking" + label() + ", after 10 s", 1e6 * (sim.bodyPose(1).p - start).norm(), 1e-9, "um");
  expectBelow("S3 sticking" + label() + ", largest swing", swing, 1e-8, "um");
}

TEST_P(S3Incline, SlidesAsFarAsTheClosedFormSays) { compareSlide("s3_incline_slide" + suffix(), 0, "S3 sliding"); }

INSTANTIATE_TEST_SUITE_P(Headings, S3Incline, testing::Values(0.0, std::numbers::pi / 6));

class S3Pushed : public S3Incline {};
TEST_P(S3Pushed, SlidesAsFarAsTheClosedFormSays) { compareSlide("s3_incline_slide_30deg_moving", 0.1, "S3 sliding from 0.1 m/s"); }
INSTANTIATE_TEST_SUITE_P(Headings, S3Pushed, testing::Values(std::numbers::pi / 6));

class S4Held : public testing::TestWithParam<const char*> {};

TEST_P(S4Held, DoesNotSlip) {
  Simulation sim = openScene(GetParam());
  const Vec3 start = sim.bodyPose(0).p;
  double slip = 0, turn = 0;
  runThrough(sim, [&] {
    slip = std::max(slip, (sim.bodyPose(0).p - start).norm());
    turn = std::max(turn, angleBetween(Quat::Identity(), sim.bodyPose(0).q));
  });
  expectBelow(fmt::format("S4 slip in {} s ({})", sim.scene().duration, GetParam()), 1e6 * slip, 1e-6, "um");
  expectBelow(fmt::format("S4 rotation in {} s ({})", sim.scene().duration, GetParam()), turn, 1e-9, "rad");
}

INSTANTIATE_TEST_SUITE_P(Scenes, S4Held, testing::Values("s4_pinch", "s4_pinch_102"));

TEST(S4Slipping, DropsWhenTheConstrainedMotionSays) {
  Simulation sim = openScene("s4_pinch_098");
  const exact::SlidingPinch exact{0.1, 0.02, 0.05, 0.008, 2, 0.98 * 0.1 * kG / 4, kG};
  constexpr double kDepth = 0.005;
  double before = 0, time = 0;
  runThrough(sim, [&] {
    const double depth = 0.1 - sim.bodyPose(0).p.z();
    // Between ticks on a straight line, which errs by at most a h^2/8 = 3e-8 m, or 3e-6 of the time.
    if (time == 0 && depth > kDepth) time = sim.time() - 1e-3 * (depth - kDepth) / (depth - before);
    before = depth;
  });
  ASSERT_GT(time, 0) << "it never dropped by 5 mm";
  expectBelow("S4 at 0.98 x, time to drop 5 mm, relative", std::abs(time / exact.dropTime(kDepth) - 1), 1e-4, "-");
}

TEST(S5Lift, MovesAsIfGluedToTheFingers) {
  Simulation sim = openScene("s5_lift");
  const exact::StuckLift exact{0.3, 500, 2, 0.1, 1, 0.2};
  const std::vector<double> rises = exact.rises(static_cast<int>(sim.scene().ticks()), sim.scene().options.h);
  double error = 0, slip = 0;
  runThrough(sim, [&] {
    const double z = sim.bodyPose(0).p.z();
    const auto& fingers = sim.state().world.points;
    error = std::max(error, std::abs(z - 0.1 - rises[static_cast<std::size_t>(sim.ticks() - 1)]));
    slip = std::max(slip, std::abs(z - 0.5 * (fingers[0].p_W.z() + fingers[1].p_W.z())));
  });
  expectBelow("S5 trajectory, largest deviation", 1e6 * error, 1e-2, "um");
  expectBelow("S5 slip against the fingers", 1e6 * slip, 1e-6, "um");
}

}  // namespace
}  // namespace pincer::tasks
