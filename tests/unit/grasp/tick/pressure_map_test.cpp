#include "pincer/grasp/pressure_map.h"

#include <gtest/gtest.h>

#include <cmath>
#include <random>

#include "pincer/grasp/tick/scratch.h"
#include "pincer/tests/support/allocation_guard.h"
#include "pincer/tests/support/error_of.h"
#include "pincer/tests/support/worlds.h"

namespace pincer::grasp {
namespace {

constexpr PressureGrid kGrid{.rows = 12, .columns = 10, .pitch = 2e-3};

struct Moments {
  double normal = 0, around = 0;
  Vec2 tangential = Vec2::Zero(), place = Vec2::Zero();  // place: first moments of the normal force
};
Moments momentsOf(const PressureGrid& grid, std::span<const Taxel> map) {
  Moments m;
  for (int row = 0; row < grid.rows; ++row) {
    for (int column = 0; column < grid.columns; ++column) {
      const Taxel& taxel = map[static_cast<std::size_t>(row * grid.columns + column)];
      const Vec2 x = taxelPlace(grid, row, column);
      m.normal += taxel.normal;
      m.tangential += taxel.tangential;
      m.place += taxel.normal * x;
      m.around += x.x() * taxel.tangential.y() - x.y() * taxel.tangential.x();
    }
  }
  return m;
}

std::vector<Taxel> mapOf(const PadForce& contact, const PressureGrid& grid = kGrid) {
  std::vector<Taxel> map(static_cast<std::size_t>(grid.rows * grid.columns));
  EXPECT_EQ(spread(grid, contact, map), 0);
  return map;
}

TEST(PressureMap, SumsAndMomentsAreTheContactsToRoundOff) {
  std::mt19937 random(1);
  std::uniform_real_distribution<double> any(-1, 1);
  for (int i = 0; i < 1000; ++i) {
    PadForce c;
    c.place = {5e-3 * any(random), 4e-3 * any(random)};
    c.force = {2 + any(random), {any(random), any(random)}};
    c.torsion = 1e-3 * any(random);
    c.radius = i % 3 == 0 ? 0 : 3e-3 * (1.05 + any(random)) / 2;
    c.hertz = i % 2 == 0;
    if (c.radius == 0) c.torsion = 0;  // a point carries none
    const std::vector<Taxel> map = mapOf(c);
    const Moments m = momentsOf(kGrid, map);
    EXPECT_NEAR(m.normal, c.force.normal, 1e-14);
    EXPECT_LE((m.tangential - c.force.tangential).norm(), 1e-14);
    EXPECT_LE((m.place - c.force.normal * c.place).norm(), 1e-16);
    EXPECT_NEAR(m.around, c.torsion + c.place.x() * c.force.tangential.y() - c.place.y() * c.force.tangential.x(),
                1e-16);
    for (const Taxel& taxel : map) EXPECT_GE(taxel.normal, 0);
  }
}

// On the limit surface friction uses mu of the pressure in the root mean square over the patch:
// of a fine grid, whose taxels hardly blend.
TEST(PressureMap, FrictionIsMuTimesPressureOnTheLimitSurface) {
  const PressureGrid fine{.rows = 64, .columns = 64, .pitch = 2e-4};
  const double mu = 0.5, e = 4e-3;
  for (const double share : {0.0, 0.6, 1.0}) {
    PadForce c{.force = {2, {mu * 2 * std::sqrt(1 - share * share), 0}}, .torsion = share * mu * 2 * e, .radius = e};
    const std::vector<Taxel> map = mapOf(c, fine);
    double squares = 0, normal = 0;
    for (const Taxel& taxel : map) {
      if (!(taxel.normal > 0)) continue;
      squares += taxel.tangential.squaredNorm() / taxel.normal;
      normal += taxel.normal;
    }
    EXPECT_NEAR(std::sqrt(squares / normal), mu, 0.05 * mu)
        << share << ": the rings' radii differ, and so does how they blend";
  }
}

TEST(PressureMap, APatchBeyondTheRimKeepsItsForceAndSaysSo) {
  std::vector<Taxel> map(120);
  const PadForce c{.place = {11e-3, 0}, .force = {1, Vec2::Zero()}, .radius = 2e-3};
  const double beyond = spread(kGrid, c, map);
  EXPECT_NEAR(momentsOf(kGrid, map).normal, 1, 1e-14);
  EXPECT_GT(beyond, 0.3);
  EXPECT_LT(beyond, 0.7);
}

// A finger on a plate, led along it and turned.
struct Stroke {
  GraspModel model;
  GraspState state;
  GraspScratch scratch;
  std::vector<FingerInput> input = std::vector<FingerInput>(1);

  static GraspModel make(const FingerModel& finger) {
    engine::WorldBuilder builder{engine::WorldOptions{}};
    builder.addBody({"plate", contact::HalfSpace{}, false, 0, {0.5, 0.5, 0, 0}});
    return buildGrasp(builder, {finger});
  }
  explicit Stroke(const FingerModel& finger)
      : model(make(finger)),
        state(makeState(model, {tests::startAt(Vec3::Zero())}, {Vec3(0, 0, 8e-3)})),
        scratch(model) {
    input[0].p_WF = Vec3(0, 0, 8e-3);
  }
  const FingerReport& lead(const Vec3& p, double angle) {
    input[0].v_WF = (p - input[0].p_WF) / 1e-3;
    input[0].p_WF = p;
    input[0].q_WF = Quat(Eigen::AngleAxisd(angle, Vec3(0.2, 0.1, 1).normalized()));
    step(model, state, scratch, input);
    return scratch.fingers[0];
  }
};

FingerModel padFinger() {
  FingerModel finger = tests::softFinger("pad");
  finger.pad.modulus = 1e5;
  finger.taxels = kGrid;
  return finger;
}

TEST(PressureMap, OfAFingerIsWhatItsReportSays) {
  Stroke f(padFinger());
  for (int i = 1; i <= 400; ++i) {
    const FingerReport& felt = f.lead(Vec3(1e-5 * i, 0, 8e-3 - 1e-5 * std::min(i, 200)), 1e-3 * i);
    ASSERT_EQ(felt.pressure.size(), 120u);
    const Moments m = momentsOf(kGrid, felt.pressure);
    EXPECT_NEAR(m.normal, felt.normal_force, 1e-12 * (1 + felt.normal_force));
    EXPECT_NEAR(m.tangential.norm(), felt.tangential_force, 1e-12);
    const Vec2 place = placeOnPad(f.model.fingers[0], felt.touch);
    EXPECT_LE((m.place - felt.normal_force * place).norm(), 1e-14);
    EXPECT_NEAR(m.around - (place.x() * m.tangential.y() - place.y() * m.tangential.x()), -felt.torsion, 1e-14)
        << "about the skin's normal";
    EXPECT_EQ(felt.off_grid, 0);
  }
  EXPECT_GT(std::abs(f.scratch.fingers[0].torsion), 1e-4);
  f.lead(Vec3(0, 0, 0.02), 0);
  for (const Taxel& taxel : f.scratch.fingers[0].pressure) EXPECT_EQ(taxel.normal, 0) << "nothing is touched";
}

// The friction that drags the finger back along -x is along the skin towards where the pad's axes say.
TEST(PressureMap, FrictionHasThePadsDirections) {
  FingerModel finger = padFinger();
  Stroke f(finger);
  for (int i = 1; i <= 300; ++i) {
    f.input[0].q_WF = Quat::Identity();
    f.lead(Vec3(2e-5 * i, 0, 7e-3), 0);
  }
  const Moments m = momentsOf(kGrid, f.scratch.fingers[0].pressure);
  EXPECT_LT(m.tangential.x(), -0.1) << "distal is +x, and the plate pulls towards -x";
  EXPECT_NEAR(m.tangential.y(), 0, 1e-9);
}

TEST(PressureMap, IsOffUnlessAskedFor) {
  FingerModel finger = padFinger();
  finger.taxels = {};
  Stroke f(finger);
  EXPECT_TRUE(f.lead(Vec3(0, 0, 7e-3), 0).pressure.empty());
}

TEST(PressureMap, AllocatesNothing) {
  if (!tests::allocationsAreCounted()) GTEST_SKIP() << "this build can't count allocations";
  Stroke f(padFinger());
  f.lead(Vec3(0, 0, 7e-3), 0);
  const std::int64_t before = tests::allocationCount();
  f.lead(Vec3(1e-5, 0, 7e-3), 0);
  EXPECT_EQ(tests::allocationCount() - before, 0);
}

TEST(PressureMap, RefusesGridsOutOfRange) {
  for (const PressureGrid& grid :
       {PressureGrid{.rows = 1, .columns = 4}, PressureGrid{.rows = 8, .columns = 65},
        PressureGrid{.rows = 8, .columns = 0}, PressureGrid{.rows = 8, .columns = 6, .pitch = 0},
        PressureGrid{.rows = -3, .columns = 6}}) {
    FingerModel finger = padFinger();
    finger.taxels = grid;
    EXPECT_NE(tests::errorOf([&] { Stroke{finger}; }).find("taxels"), std::string::npos)
        << grid.rows << " x " << grid.columns;
  }
}

}  // namespace
}  // namespace pincer::grasp
