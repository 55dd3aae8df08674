// The budget: what a tick may cost, counted.
#include <gtest/gtest.h>

#include <cmath>

#include "pincer/contact/error.h"
#include "pincer/engine/solve/sweeps.h"
#include "pincer/engine/step.h"
#include "pincer/tests/support/contact_problems.h"
#include "pincer/tests/support/worlds.h"

namespace pincer::engine {
namespace {

using tests::startAt;

struct HeapRun {
  WorldState state;
  int flagged = 0, spent = 0;
  std::int64_t least_left = kNoLimit;
};

// Boxes dropped on each other, 300 ticks.
HeapRun dropBoxes(double budget) {
  WorldOptions options;
  options.solver.budget = budget;
  WorldBuilder builder{options};
  std::vector<BodyStart> starts{startAt(Vec3::Zero())};
  builder.addBody({"floor", contact::HalfSpace{}, false, 0, {}});
  for (int i = 0; i < 6; ++i) {
    builder.addBody({"box", contact::Box{Vec3(0.02, 0.015, 0.01)}, true, 0.1, {}});
    const Pose X{quatFromRotationVector(Vec3(0.4 * i, 0.3, 0.2 * i)),
                 Vec3(0.004 * (i % 2), 0.003 * (i % 3), 0.03 + 0.045 * i)};
    starts.push_back({X, Vec3::Zero(), Vec3::Zero()});
  }
  const WorldModel model = builder.build();
  HeapRun run{makeState(model, starts, {})};
  WorldScratch scratch(model);
  const double energy = kineticEnergy(model, run.state) + potentialEnergy(model, run.state);
  for (int i = 0; i < 300; ++i) {
    const StepReport report = step(model, run.state, scratch);
    run.flagged += report.status != kStepOk;
    run.spent += (report.status & kBudgetSpent) != 0;
    run.least_left = std::min(run.least_left, scratch.operations_left);
    // as `pincer stress` asks
    EXPECT_LE(kineticEnergy(model, run.state) + potentialEnergy(model, run.state), energy * (1 + 1e-5));
    for (int b = 1; b <= 6; ++b) EXPECT_GT(run.state.bodies[b].X_WI.p.z(), 0) << "tick " << i;
  }
  return run;
}

TEST(Budget, ThatIsNotUsedChangesNoBit) {
  const HeapRun without = dropBoxes(0), with = dropBoxes(1);
  EXPECT_EQ(with.spent, 0);
  EXPECT_EQ(hashOf(without.state), hashOf(with.state));
}

TEST(Budget, RunsOutFlaggedAndAddsNoEnergy) {
  const double budget = 5e-5;
  const HeapRun run = dropBoxes(budget);
  EXPECT_GT(run.spent, 0);
  EXPECT_GE(run.flagged, run.spent);
  // Beyond it the step that was refused is spent, and the sweeps that every tick gets.
  EXPECT_GT(run.least_left, -static_cast<std::int64_t>(1e-3 * kOperationsPerSecond));
}

TEST(Budget, IsDeterministic) { EXPECT_EQ(hashOf(dropBoxes(5e-5).state), hashOf(dropBoxes(5e-5).state)); }

// Each tick began with no impulse, and never came far: columns of 14 bricks sank by 6 mm in 0.3 s, of 30 by 90 mm.
TEST(Budget, ColumnsStandThoughNoTickOfTheirsIsSolved) {
  for (const int count : {14, 30}) {
    WorldOptions options;
    options.solver.budget = 2e-4;
    WorldBuilder builder{options};
    std::vector<BodyStart> starts(1);
    builder.addBody({"floor", contact::HalfSpace{}, false, 0, {}});
    for (int i = 0; i < count; ++i) {
      builder.addBody({"brick", contact::Box{{0.02, 0.01, 0.01}}, true, 0.1, {}});
      BodyStart start = tests::startAt({2e-3 * std::sin(3.0 * i), 1e-3 * std::sin(5.0 * i), 0.01 + 0.02 * i});
      start.X_WB.q = quatFromRotationVector(0.1 * std::sin(7.0 * i) * Vec3::UnitZ());
      starts.push_back(start);
    }
    const WorldModel model = builder.build();
    WorldState state = makeState(model, starts, {});
    WorldScratch scratch(model);
    const double energy = potentialEnergy(model, state);
    int spent = 0;
    for (int tick = 0; tick < 300; ++tick) spent += (step(model, state, scratch).status & kBudgetSpent) != 0;
    EXPECT_EQ(spent, 300) << count;
    // 0.22 mm of 14 were measured, 4.3 of 30
    EXPECT_GT(state.bodies.back().X_WI.p.z(), 0.01 + 0.02 * (count - 1) - (count == 14 ? 5e-4 : 1e-2)) << count;
    EXPECT_LE(potentialEnergy(model, state) + kineticEnergy(model, state), energy * (1 + 1e-5))
        << count;  // as `stress`
  }
}

// The rest of the tick was done in one part, in which needles turned so far that contacts gave them energy: 13 of
// these worlds gained some, up to 600 times what they had.
TEST(Budget, SpinningNeedlesGainNoEnergyWhereItRunsOut) {
  int spent = 0;
  for (int n = 0; n < 40; ++n) {
    WorldOptions options;
    options.solver.budget = 1e-4;
    tests::EngineWorld w = tests::spinningNeedles(n, 5e-4, 3, 200, options);
    WorldScratch scratch(w.model);
    const double most = w.energy() * (1 + 1e-5);  // as `pincer stress` asks
    for (int i = 0; i < 200; ++i) {
      spent += (step(w.model, w.state, scratch).status & kBudgetSpent) != 0;
      ASSERT_LE(w.energy(), most) << n << ", tick " << i;
    }
  }
  EXPECT_GT(spent, 1000);
}

// The sweeps that every tick gets counted as nothing, so that what was kept back for later was spent again and
// again: ticks of 3 ms at a budget of 0.5.
TEST(Budget, SweepsOfAProblemThatHasNoneLeftAreCounted) {
  tests::RandomScenes random(5);
  for (int n = 0; n < 20; ++n) {
    tests::OwnedContactProblem p = random.stack(20, 1, 1e-3);  // eighty contacts
    SolverScratch scratch(static_cast<int>(p.mu.size()), p.movers);
    Eigen::VectorXd r = Eigen::VectorXd::Zero(p.q.size()), u = r;
    scratch.operations_left = 0;
    const SolveResult result = solveContacts(p.view(), {}, scratch, {r.data(), r.size()}, {u.data(), u.size()});
    ASSERT_GT(result.iterations, 0) << n;
    EXPECT_LE(scratch.operations_left, -kPerContactSwept * result.iterations * static_cast<int>(p.mu.size())) << n;
  }
}

TEST(Budget, OutOfRangeIsRefused) {
  WorldOptions options;
  options.solver.budget = 100;
  EXPECT_THROW(WorldBuilder{options}, InputError);
}

}  // namespace
}  // namespace pincer::engine
