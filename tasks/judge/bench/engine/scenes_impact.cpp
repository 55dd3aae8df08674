// Balls that bounce.
#include <algorithm>
#include <cmath>
#include <memory>

#include "pincer/tasks/judge/bench/engine/bench_scene.h"
#include "pincer/tasks/judge/exact/thrown_ball.h"

namespace pincer::tasks {
namespace {

BenchWorld dropWorld(double restitution) {
  BenchWorld world;
  world.mu = 0.2;
  world.restitution = restitution;
  world.bodies = {benchFloor(), benchBall(0.1, 0.02, {0, 0, 0.52})};
  return world;
}

// Heights of the bounces: what the ball reaches on the parabola that it is on in the step in which it turns.
struct Peaks {
  double v_before = -1;
  std::vector<double> heights;

  void look(BenchEngine& e) {
    const BenchMotion m = e.motion(1);
    const double v = m.v_W.z();
    if (v_before > 0 && v <= 0) heights.push_back(m.X_WB.p.z() - 0.02 + v * v / (2 * kBenchG));
    v_before = v;
  }
};

BenchScene bounceScene() {
  constexpr double kRestitution = 0.8;  // [-]
  constexpr int kBounces = 5;           // whose heights are compared, as the metric says
  BenchScene s{.name = "s7/bounce-0.8",
               .metric = "height of 5 bounces, largest relative error",
               .unit = "-",
               .duration = 3,
               .floor = 1e-15,
               .error_bound = 1e-9,
               .cost_bound = 0.5};
  s.world = dropWorld(kRestitution);
  s.judge = [] {
    const auto peaks = std::make_shared<Peaks>();
    BenchJudge judge;
    judge.look = [=](double, BenchEngine& e) {
      peaks->look(e);
      return peaks->heights.size() < kBounces;
    };
    judge.verdict = [=](BenchEngine&) {
      if (peaks->heights.size() < kBounces) return BenchVerdict{.failure = "bounces less than 5 times"};
      double worst = 0, exact = 0.5;
      for (const double height : peaks->heights) {
        exact *= kRestitution * kRestitution;
        worst = std::max(worst, std::abs(height / exact - 1));
      }
      return worst < 1 ? BenchVerdict{worst} : BenchVerdict{.failure = "bounces more than twice as high"};
    };
    return judge;
  };
  return s;
}

BenchScene superballScene(bool whole) {
  BenchScene s{.name = "s7/superball",
               .metric = whole ? "energy over 60 s, largest error" : "energy over 12 s, largest error",
               .unit = "-",
               .duration = whole ? 60.0 : 12.0,
               .floor = 1e-15,
               .error_bound = 1e-12,
               .cost_bound = 0.4};
  s.world = dropWorld(1);
  s.judge = [seconds = s.duration] {
    const auto peaks = std::make_shared<Peaks>();
    BenchJudge judge;
    judge.look = [=](double, BenchEngine& e) {
      peaks->look(e);
      return true;
    };
    judge.verdict = [=](BenchEngine&) {
      double worst = 0;
      for (const double height : peaks->heights) worst = std::max(worst, std::abs(height / 0.5 - 1));
      if (static_cast<double>(peaks->heights.size()) < seconds / 2) return BenchVerdict{.failure = "stops bouncing"};
      return worst < 1 ? BenchVerdict{worst} : BenchVerdict{.failure = "loses its height, or doubles it"};
    };
    return judge;
  };
  return s;
}

// Thrown with spin: friction in each bounce turns spin into motion.
BenchScene obliqueScene() {
  const exact::ObliqueBounces exact{0.02, 0.2, 0.8, kBenchG, 0.5, {0.5, 0.2, 0}, {0, -80, 30}};
  BenchScene s{.name = "more/oblique-bounces",
               .metric = "place after 3 bounces, error over way",
               .unit = "-",
               .duration = 1.6,
               .floor = 1e-15};
  s.world = dropWorld(0.8);
  s.world.bodies[1].v_W = exact.v0;
  s.world.bodies[1].w_W = exact.w0;
  s.judge = [=] {
    return judgeOfEnd([=](BenchEngine& e) {
      const Vec3 way = e.motion(1).X_WB.p - Vec3(0, 0, 0.52), right = exact.position(1.6);
      const double error = (way - right).norm() / right.norm();
      return error < 0.5 ? BenchVerdict{error} : BenchVerdict{.failure = "goes elsewhere"};
    });
  };
  return s;
}

}  // namespace

std::vector<BenchScene> benchImpactScenes(bool whole) { return {bounceScene(), superballScene(whole), obliqueScene()}; }

}  // namespace pincer::tasks
