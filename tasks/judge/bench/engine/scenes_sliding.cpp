// Bodies that stick, slide and roll on floors and slopes.
#include <algorithm>
#include <cmath>
#include <memory>

#include "pincer/tasks/judge/bench/engine/bench_scene.h"
#include "pincer/tasks/judge/exact/sliding_rolling.h"
#include "pincer/tasks/judge/exact/thrown_ball.h"

namespace pincer::tasks {
namespace {

constexpr double kBenchSlope = 20 * kDegree;  // [rad]; chosen: friction is given as a share of its tangent

// Error over the whole way of the body 1, off `exact`; a way less than half or more
// than twice as long isn't the scene's motion.
BenchVerdict relativeWay(const Vec3& start, const Vec3& exact, BenchEngine& engine) {
  const Vec3 way = engine.motion(1).X_WB.p - start;
  const double share = way.dot(exact) / exact.squaredNorm();
  if (!(share > 0.5)) return {.failure = share > -0.5 ? "sticks" : "goes back"};
  if (share > 2) return {.failure = "goes more than twice as far"};
  if (std::abs(way.z() - exact.z()) > 0.2 * exact.norm()) return {.failure = "leaves the floor"};
  return {(way - exact).norm() / exact.norm()};
}

BenchScene slideToRollScene() {
  BenchScene s{.name = "s2/slide-to-roll",
               .metric = "position at 1 s, error",
               .unit = "mm",
               .floor = 1e-12,
               .error_bound = 1e-3,
               .cost_bound = 0.8};
  s.world.mu = 0.2;
  s.world.bodies = {benchFloor(), benchBall(0.1, 0.02, {0, 0, 0.02}, {1, 0, 0})};
  s.judge = [] {
    return judgeOfEnd([](BenchEngine& e) {
      const exact::SlideToRoll exact{1, 0.2, kBenchG};
      const BenchMotion m = e.motion(1);
      if (!(std::abs(m.v_W.x() / exact.velocity(1) - 1) < 0.05))
        return BenchVerdict{.failure = "doesn't end up rolling"};
      if (!(std::abs(m.X_WB.p.z() - 0.02) < 1e-3)) return BenchVerdict{.failure = "leaves the floor"};
      return BenchVerdict{1e3 * std::abs(m.X_WB.p.x() - exact.position(1))};
    });
  };
  return s;
}

BenchWorld slopeWorld(double tangent_over_mu, double heading, double v0) {
  const Vec3 downhill(math::cos(heading), math::sin(heading), 0);
  BenchWorld world;
  world.mu = math::tan(kBenchSlope) / tangent_over_mu;
  world.gravity_W = kBenchG * (math::sin(kBenchSlope) * downhill - math::cos(kBenchSlope) * Vec3::UnitZ());
  world.bodies = {benchFloor(), benchBox(0.2, {0.025, 0.025, 0.0125}, {0, 0, 0.0125}, v0 * downhill)};
  return world;
}

// How far it has crept between 1 s, when soft contacts have settled, and 10 s.
BenchScene stickScene(const std::string& name, double heading) {
  BenchScene s{.name = name,
               .metric = "creep from 1 to 10 s",
               .unit = "um",
               .duration = 10,
               .floor = 1e-10,
               .error_bound = 1e-9,
               .cost_bound = 2};
  s.world = slopeWorld(0.99, heading, 0);
  s.judge = [] {
    const auto settled = std::make_shared<Vec3>(Vec3::Zero());
    BenchJudge judge;
    judge.look = [=](double t, BenchEngine& e) {
      if (t < 1.0 + 1e-9) *settled = e.motion(1).X_WB.p;
      return true;
    };
    judge.verdict = [=](BenchEngine& e) {
      const Vec3 p = e.motion(1).X_WB.p;
      if (!((p - Vec3(0, 0, 0.0125)).norm() < 0.01)) return BenchVerdict{.failure = "slides off"};
      return BenchVerdict{1e6 * (p - *settled).norm()};
    };
    return judge;
  };
  return s;
}

BenchScene slideScene(const std::string& name, double heading, double v0) {
  BenchScene s{.name = name,
               .metric = "place at 2 s, error over way",
               .unit = "-",
               .duration = 2,
               .floor = 1e-15,
               .error_bound = 1e-9,
               .cost_bound = 2};
  s.world = slopeWorld(1.05, heading, v0);
  s.judge = [=] {
    return judgeOfEnd([=](BenchEngine& e) {
      const double way = exact::Slope{kBenchSlope, math::tan(kBenchSlope) / 1.05, kBenchG}.way(v0, 2);
      return relativeWay({0, 0, 0.0125}, way * Vec3(math::cos(heading), math::sin(heading), 0), e);
    });
  };
  return s;
}

// A ball let go on a slope, of a friction at which it rolls, or slides and rolls.
BenchScene rollingScene(const std::string& name, double friction_over_limit) {
  constexpr double kTheta = 30 * kDegree;  // of the slope [rad]
  const exact::RollingIncline exact{kTheta, friction_over_limit * 2 / 7 * math::tan(kTheta), kBenchG};
  BenchScene s{.name = name, .metric = "way in 1 s, relative error", .unit = "-", .floor = 1e-15, .error_bound = 1e-9};
  s.world.mu = exact.mu;
  s.world.gravity_W = kBenchG * Vec3(math::sin(kTheta), 0, -math::cos(kTheta));
  s.world.bodies = {benchFloor(), benchBall(0.1, 0.02, {0, 0, 0.02})};
  s.judge = [=] {
    return judgeOfEnd([=](BenchEngine& e) { return relativeWay({0, 0, 0.02}, {0.5 * exact.acceleration(), 0, 0}, e); });
  };
  return s;
}

// A ball thrown with side spin: it curves until it rolls.
BenchScene sideSpinScene() {
  const exact::SpinningSlide exact{0.02, 0.2, kBenchG, {1, 0, 0}, {60, 0, 40}};
  BenchScene s{.name = "more/side-spin", .metric = "place at 1 s, error over way", .unit = "-", .floor = 1e-15};
  s.world.mu = exact.mu;
  s.world.bodies = {benchFloor(), benchBall(0.1, exact.radius, {0, 0, exact.radius}, exact.v0, exact.w0)};
  s.judge = [=] {
    return judgeOfEnd([=](BenchEngine& e) { return relativeWay({0, 0, exact.radius}, exact.position(1), e); });
  };
  return s;
}

// A cube thrown at 6 m/s: it stops after v^2 / (2 mu g), and nothing lifts it (a cone that isn't exact does: dilation).
BenchScene thrownCubeScene() {
  BenchScene s{.name = "more/thrown-cube",
               .metric = "way until it stops, relative error",
               .unit = "-",
               .duration = 1.6,
               .floor = 1e-15,
               .error_bound = 1e-6};
  s.world.bodies = {benchFloor(), benchBox(0.2, {0.025, 0.025, 0.025}, {0, 0, 0.025}, {6, 0, 0})};
  s.judge = [] {
    return judgeOfEnd([](BenchEngine& e) {
      return relativeWay({0, 0, 0.025}, {exact::Stopping{6, 0.5, kBenchG}.way(), 0, 0}, e);
    });
  };
  return s;
}

}  // namespace

std::vector<BenchScene> benchSlidingScenes() {
  constexpr double k30 = 30 * kDegree;
  return {slideToRollScene(),
          stickScene("s3/stick", 0),
          stickScene("s3/stick-30deg", k30),
          slideScene("s3/slide", 0, 0),
          slideScene("s3/slide-30deg", k30, 0),
          slideScene("s3/slide-30deg-moving", k30, 0.1),
          rollingScene("more/rolling-incline", 3),
          rollingScene("more/slipping-incline", 0.5),
          sideSpinScene(),
          thrownCubeScene()};
}

}  // namespace pincer::tasks
