// Trees in a tick, without a world: orders, energies and what rests, against exact motions.
#include <gtest/gtest.h>

#include <numbers>

#include "pincer/engine/tree/tree_course.h"
#include "pincer/engine/tree/tree_pattern.h"
#include "pincer/tasks/judge/exact/linkages.h"
#include "pincer/tests/support/random_tree.h"

namespace pincer::engine {
namespace {

constexpr double kG = 9.81;

// A tree that runs by itself.
struct LoneTree {
  TreeModel tree;
  std::vector<double> q, u;
  std::vector<DriveTick> drives;
  Vec3 gravity_W = Vec3(0, 0, -kG);
  bool may_be_fine = true;
  double h = 1e-3;
  bool was_fine = true;  // in all ticks

  void go(double time) {
    finishTree(tree);
    if (u.empty()) u.assign(tree.before.size(), 0);
    TreeCourse course(tree);
    const std::vector<double> gained(u.size(), 0);
    std::vector<double> q_end(q.size()), u_end(u.size());
    const auto ticks = std::lround(time / h);
    for (long n = 0; n < ticks; ++n) {
      predictTree(tree, {}, {.gravity_W = gravity_W, .drives = drives, .may_be_fine = may_be_fine}, q, u, h, course);
      was_fine = was_fine && course.fine;
      advanceTree(tree, {}, {gained, h}, h, q, u, course, q_end, u_end);
      q = q_end;
      u = u_end;
    }
  }
};

void addCoordinate(TreeModel& tree, JointKind kind, const Pose& X_PJ, const Pose& X_LJ, double mass,
                   const Vec3& moments) {
  TreeLink link;
  link.parent = static_cast<int>(tree.links.size()) - 1;
  link.kind = kind;
  link.X_PJ = X_PJ;
  link.X_LJ = X_LJ;
  link.mass = mass;
  link.moments = moments;
  link.first_q = tree.q_count;
  link.first_v = tree.coordinateCount();
  for (int k = 0; k < coordinatesOf(kind); ++k) {
    TreeCoordinate coordinate;
    coordinate.link = static_cast<int>(tree.links.size());
    coordinate.q = kind == JointKind::kBall ? -1 : tree.q_count;
    tree.coordinates.push_back(coordinate);
  }
  tree.q_count += kind == JointKind::kBall ? 4 : coordinatesOf(kind);
  tree.links.push_back(link);
}

// Axes along y, rods hanging along -z.
constexpr double kRodLength = 0.2, kRodMass = 0.1;
Pose aboutY(const Vec3& p) { return {quatFromRotationVector({-std::numbers::pi / 2, 0, 0}), p}; }
LoneTree rods(int count, const std::vector<double>& angles) {
  LoneTree run;
  const double across = kRodMass * kRodLength * kRodLength / 12;
  for (int i = 0; i < count; ++i) {
    const Vec3 end = i == 0 ? Vec3::Zero() : Vec3(0, 0, -kRodLength / 2);
    addCoordinate(run.tree, JointKind::kPivot, aboutY(end), aboutY({0, 0, kRodLength / 2}), kRodMass,
                  {across, across, 1e-6});
  }
  for (int i = 0; i < count; ++i) run.q.push_back(angles[i] - (i > 0 ? angles[i - 1] : 0));
  return run;
}

double worstAngle(const LoneTree& run, const std::vector<double>& exact) {
  double sum = 0, worst = 0;
  for (std::size_t i = 0; i < exact.size(); ++i) {
    sum += run.q[i];
    worst = std::max(worst, std::abs(sum - exact[i]));
  }
  return worst;
}

TEST(TreeCourse, RodsSwingAsTheirEquationsSayToFourthOrder) {
  const std::vector<double> start{0.2, 0.2, 0.2}, exact = exact::RodChain{3, kRodLength, kRodMass, kG}.angles(start, 2);
  LoneTree coarse = rods(3, start), fine = rods(3, start);
  coarse.h = 2e-3;
  coarse.go(2);
  fine.go(2);
  EXPECT_TRUE(fine.was_fine);
  EXPECT_LE(worstAngle(fine, exact), 2e-7);
  EXPECT_GE(worstAngle(coarse, exact), 14 * worstAngle(fine, exact));  // 16, and what is of 5th order
}

TEST(TreeCourse, WithoutRungeKuttaRodsAreOfSecondOrder) {
  const std::vector<double> start{0.2, 0.2, 0.2}, exact = exact::RodChain{3, kRodLength, kRodMass, kG}.angles(start, 2);
  LoneTree coarse = rods(3, start), fine = rods(3, start);
  coarse.may_be_fine = fine.may_be_fine = false;
  coarse.h = 2e-3;
  coarse.go(2);
  fine.go(2);
  EXPECT_LE(worstAngle(fine, exact), 1e-3);
  EXPECT_GE(worstAngle(coarse, exact), 3.5 * worstAngle(fine, exact));
  EXPECT_LE(worstAngle(coarse, exact), 4.5 * worstAngle(fine, exact));
}

TEST(TreeCourse, ADoublePendulumKeepsItsEnergyInLargeSwings) {
  const exact::RodChain chain{2, kRodLength, kRodMass, kG};
  LoneTree run = rods(2, {2.5, -1});
  const double before = chain.energy({2.5, -1}, {0, 0});
  run.go(10);
  const double after = chain.energy({run.q[0], run.q[0] + run.q[1]}, {run.u[0], run.u[0] + run.u[1]});
  EXPECT_NEAR(after / before, 1, 1e-6);
}

// A slider on a drive with a damper, against the exact motion; from `speed` towards a target 10 mm
// ahead. The largest error, over those 10 mm.
double stepError(double k, double d, double speed, double h, bool may_be_fine) {
  LoneTree run;
  addCoordinate(run.tree, JointKind::kSlider, {}, {}, 1, Vec3::Ones());
  run.tree.drives.push_back({0, {{0, 1}}});
  run.drives.push_back({.stiffness = k, .damping = d, .target = 0.01});
  run.gravity_W.setZero();
  run.q = {0};
  run.u = {speed};
  run.h = h;
  run.may_be_fine = may_be_fine;
  double worst = 0;
  const exact::DampedOscillator oscillator{1, k, d};
  const double span = 4e-3;
  for (int n = 1; n <= 10; ++n) {
    run.go(span);
    worst = std::max(worst, std::abs(run.q[0] - 0.01 - oscillator.place(-0.01, speed, n * span)) / 0.01);
  }
  return worst;
}

TEST(TreeCourse, ASoftDriveStepsAsItsEquationSays) {
  constexpr double kStiffness = 1e4, kDamping = 60;  // h^2 k = .01 m, h d = .06 m
  EXPECT_LE(stepError(kStiffness, kDamping, 0, 1e-3, true), 2e-5);
  EXPECT_LE(stepError(kStiffness, kDamping, 0, 1e-3, false), 5e-4);
  EXPECT_GE(stepError(kStiffness, kDamping, 0, 2e-3, false), 3.5 * stepError(kStiffness, kDamping, 0, 1e-3, false));
}

// h d = 10 m: the damper's own time is a tenth of a tick. What starts with the speed that drive and damper agree on is
// of second order; a jump of that speed comes half a tick late.
TEST(TreeCourse, AStiffDriveThatIsDampedIsOfSecondOrder) {
  constexpr double kStiffness = 4e5, kDamping = 1e4;
  const double slow = (kDamping - std::sqrt(kDamping * kDamping - 4 * kStiffness)) / 2;
  EXPECT_LE(stepError(kStiffness, kDamping, 0.01 * slow, 1e-3, true), 2e-4);
  EXPECT_GE(stepError(kStiffness, kDamping, 0.01 * slow, 2e-3, true),
            3 * stepError(kStiffness, kDamping, 0.01 * slow, 1e-3, true));
  EXPECT_LE(stepError(kStiffness, kDamping, 0, 1e-3, true), 0.5e-3 * slow);
}

// Whatever its form: where k e is the load it stays to the bit, but for round-off of the load.
TEST(TreeCourse, ADriveHoldsALoadWhereItsSpringIsTheLoad) {
  for (const double stiffness : {10.0, 1e4, 1e6, 1e9}) {
    for (const double damping : {0.0, 50.0, 1e5}) {
      LoneTree run;
      addCoordinate(run.tree, JointKind::kSlider, {}, {}, 2, Vec3::Ones());
      run.tree.drives.push_back({0, {{0, 1}}});
      run.drives.push_back({.stiffness = stiffness, .damping = damping, .target = 0.3});
      run.q = {0.3 - 2 * kG / stiffness};
      const double start = run.q[0];
      run.go(1);
      EXPECT_NEAR(run.q[0], start, 1e-12) << stiffness << " " << damping;
    }
  }
}

// Stiff without a damper: it may neither ring for ever nor grow.
TEST(TreeCourse, AStiffSpringWithoutADamperComesToRest) {
  for (const double stiffness : {1e7, 1e9, 1e12}) {
    LoneTree run;
    addCoordinate(run.tree, JointKind::kSlider, {}, {}, 1, Vec3::Ones());
    run.tree.coordinates[0].traits.stiffness = stiffness;
    run.q = {0.01};
    run.go(0.1);
    EXPECT_NEAR(run.q[0], -kG / stiffness, 1e-12) << stiffness;
    EXPECT_NEAR(run.u[0], 0, 1e-9) << stiffness;
  }
}

double energyOf(const LoneTree& run) {
  TreePlace place(run.tree);
  placeLinks(run.tree, {}, run.q, place);
  moveLinks(run.tree, {}, run.q, run.u, place);
  double sum = 0;
  for (std::size_t l = 0; l < run.tree.links.size(); ++l) {
    const TreeLink& link = run.tree.links[l];
    const Motion& motion = place.links[l].motion;
    const Vec3 w_L = place.links[l].q_WL.conjugate() * motion.w_W;
    sum += 0.5 * (link.mass * motion.v_W.squaredNorm() + w_L.dot(link.moments.cwiseProduct(w_L)));
    sum -= link.mass * run.gravity_W.dot(linkPose(place, static_cast<int>(l)).p);
  }
  for (std::size_t i = 0; i < run.tree.coordinates.size(); ++i) {
    const TreeCoordinate& coordinate = run.tree.coordinates[i];
    const double rate = place.coordinates[i].share * run.u[static_cast<std::size_t>(coordinate.column)];
    sum += 0.5 * coordinate.traits.armature * rate * rate;
    if (coordinate.q >= 0)
      sum += 0.5 * coordinate.traits.stiffness * std::pow(run.q[static_cast<std::size_t>(coordinate.q)], 2);
  }
  for (std::size_t d = 0; d < run.tree.drives.size(); ++d)
    sum += 0.5 * run.drives[d].stiffness *
           std::pow(lengthOf(run.tree, run.tree.drives[d], run.q) - run.drives[d].target, 2);
  return sum;
}

// Nothing of what nobody drew gains energy: not from springs, drives, couplings or masses of 1e4
// to 1, soft or stiff, by whatever course.
TEST(TreeCourse, RandomTreesWithSpringsAndDampersLoseEnergy) {
  std::mt19937_64 random(7);
  for (int n = 0; n < 40; ++n) {
    const tests::RandomTree t = tests::randomTree(random, {.balls = false, .driven_base = false});
    LoneTree run;
    run.tree = t.tree;
    run.q = t.q;
    run.u = t.u;
    run.may_be_fine = n % 4 > 0;
    run.drives.assign(run.tree.drives.size(), {.stiffness = n % 2 ? 10.0 : 1e6, .damping = n % 3 ? 1.0 : 1e3});
    for (std::size_t d = 0; d < run.drives.size(); ++d)
      run.drives[d].target = lengthOf(run.tree, run.tree.drives[d], run.q);
    for (TreeCoordinate& coordinate : run.tree.coordinates) {
      coordinate.damping = 0.05;
      coordinate.traits.stiffness = 20;
    }
    double before = energyOf(run);
    for (int second = 0; second < 3; ++second) {
      run.go(1);
      const double after = energyOf(run);
      EXPECT_LE(after, before + 1e-6 * (1 + std::abs(before))) << n << " in second " << second;
      before = after;
    }
  }
}

}  // namespace
}  // namespace pincer::engine
