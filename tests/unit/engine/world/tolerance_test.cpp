// The tick is cut until its error is below what the user asks for.
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>

#include "pincer/engine/step.h"
#include "pincer/tests/support/allocation_guard.h"
#include "pincer/tests/support/constants.h"
#include "pincer/tests/support/worlds.h"

namespace pincer::engine {
namespace {

using tests::kGravity;
using tests::startAt;

constexpr double kDish = 0.1, kBall = 0.02;

struct Slide {
  double error;  // [m], largest
  int most_parts;
  std::uint32_t status;
};

// A frictionless ball slides down in a dish from 1 rad beside its lowest point: a pendulum of length l = R - r. Judged
// by its energy, which becomes an error of height.
Slide slideInDish(double tolerance, int max_parts, double seconds) {
  WorldOptions options;
  options.position_tolerance = tolerance;
  options.max_parts = max_parts;
  WorldBuilder builder(options);
  const Material smooth{0, 0, 0, 0};
  builder.addBody({"dish", contact::Dish{kDish}, false, 0, smooth});
  builder.addBody({"ball", contact::Sphere{kBall}, true, 0.1, smooth});
  const WorldModel model = builder.build();
  const double l = kDish - kBall;
  WorldState state =
      makeState(model, {startAt(Vec3::Zero()), startAt(Vec3(l * std::sin(1), 0, kDish - l * std::cos(1)))}, {});
  WorldScratch scratch(model);
  const double start = potentialEnergy(model, state);
  Slide run{0, 0, 0};
  for (int i = 0; i < static_cast<int>(1e3 * seconds); ++i) {
    const StepReport report = step(model, state, scratch);
    run.most_parts = std::max(run.most_parts, report.parts);
    run.status |= report.status;
    run.error = std::max(
        run.error, std::abs(kineticEnergy(model, state) + potentialEnergy(model, state) - start) / (0.1 * kGravity));
  }
  return run;
}

TEST(Tolerance, OffMeansOnePartPerTick) { EXPECT_EQ(slideInDish(0, 16, 0.2).most_parts, 1); }

TEST(Tolerance, ErrorFollowsWhatIsAskedFor) {
  const Slide plain = slideInDish(0, 16, 0.5), fine = slideInDish(1e-10, 64, 0.5), finer = slideInDish(1e-12, 256, 0.5);
  EXPECT_EQ(fine.status, kStepOk);
  EXPECT_GT(fine.most_parts, 2);
  EXPECT_LT(fine.error, 0.5 * plain.error);
  EXPECT_LT(finer.error, 0.5 * fine.error);
}

TEST(Tolerance, OutOfReachIsReported) { EXPECT_TRUE(slideInDish(1e-12, 2, 0.1).status & kToleranceNotMet); }

TEST(Tolerance, FastTurnsAreCutBeforehand) {
  WorldOptions options;
  options.position_tolerance = 1e-3;
  WorldBuilder builder(options);
  builder.addBody({"floor", contact::HalfSpace{}, false, 0, {}});
  builder.addBody({"ball", contact::Sphere{0.02}, true, 0.1, {}});
  const WorldModel model = builder.build();
  WorldState state =
      makeState(model, {startAt(Vec3::Zero()), startAt(Vec3(0, 0, 0.5), Vec3::Zero(), Vec3(0, 0, 500))}, {});
  WorldScratch scratch(model);
  // 0.5 rad in a tick: 4 parts of less than 0.2 rad, and 8 to judge them by
  EXPECT_EQ(step(model, state, scratch).parts, 8);
}

TEST(Tolerance, AllocatesNothing) {
  if (!tests::allocationsAreCounted()) GTEST_SKIP() << "a sanitizer owns the allocator";
  WorldOptions options;
  options.position_tolerance = 1e-9;
  WorldBuilder builder(options);
  builder.addBody({"floor", contact::HalfSpace{}, false, 0, {}});
  builder.addBody({"ball", contact::Sphere{0.02}, true, 0.1, {}});
  const WorldModel model = builder.build();
  WorldState state = makeState(model, {startAt(Vec3::Zero()), startAt(Vec3(0, 0, 0.0205), Vec3(1, 0, 0))}, {});
  WorldScratch scratch(model);
  const auto before = tests::allocationCount();
  for (int i = 0; i < 200; ++i) step(model, state, scratch);
  EXPECT_EQ(tests::allocationCount(), before);
}

}  // namespace
}  // namespace pincer::engine
