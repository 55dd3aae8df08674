// Blocks that tip and rock.
#include <algorithm>
#include <cmath>
#include <memory>

#include "pincer/tasks/judge/bench/engine/bench_scene.h"
#include "pincer/tasks/judge/exact/pendulum.h"
#include "pincer/tasks/judge/exact/toppling.h"

namespace pincer::tasks {
namespace {

double tiltAboutY(const Quat& q) { return 2 * math::atan2(q.y(), q.w()); }

// On a slope 5 % steeper than its diagonal: it goes over its lower edge, which stays where it is, by 0.2 rad.
BenchScene tippingScene() {
  constexpr double kHalfWidth = 0.02, kHalfHeight = 0.04, kTime = 0.24;  // [m], [m], [s]
  const double slope = math::atan(1.05 * kHalfWidth / kHalfHeight);
  BenchScene s{.name = "more/tipping-block",
               .metric = "angle at 0.24 s, relative error",
               .unit = "-",
               .duration = kTime,
               .floor = 1e-14};
  s.world.mu = 1;
  s.world.gravity_W = kBenchG * Vec3(math::sin(slope), 0, -math::cos(slope));
  s.world.bodies = {benchFloor(), benchBox(0.2, {kHalfWidth, 0.03, kHalfHeight}, {0, 0, kHalfHeight})};
  s.judge = [=] {
    const double exact = exact::tippedAngle(kHalfWidth, kHalfHeight, slope, kBenchG, kTime);
    return judgeOfEnd([=](BenchEngine& e) {
      const double tilt = tiltAboutY(e.motion(1).X_WB.q), error = std::abs(tilt / exact - 1);
      if (!(tilt > 0.2 * exact)) return BenchVerdict{.failure = "stands"};
      return error < 1 ? BenchVerdict{error} : BenchVerdict{.failure = "tips in another way"};
    });
  };
  return s;
}

// Housner's block, let go tilted: it falls upright, hits with its other edge, and rocks on to a lower peak.
BenchScene rockingScene() {
  const exact::RockingBlock exact{0.03, 0.09, kBenchG};
  constexpr double kTilt = 0.15;  // [rad]
  BenchScene s{.name = "more/rocking-block",
               .metric = "tilt after the first impact, relative error",
               .unit = "-",
               .duration = 1.2,
               .floor = 1e-14};
  const Quat q = quatFromRotationVector({0, kTilt, 0});
  const Vec3 edge(0.03, 0, -0.09);  // that stays on the floor
  s.world.mu = 1;
  s.world.bodies = {benchFloor(), benchBox(0.5, {0.03, 0.03, 0.09}, Vec3::Zero())};
  s.world.bodies[1].X_WB = {q, Vec3(0.03, 0, 0) - q * edge};
  s.judge = [=] {
    const auto peak = std::make_shared<double>(0);
    BenchJudge judge;
    judge.look = [=](double, BenchEngine& e) {
      const double tilt = tiltAboutY(e.motion(1).X_WB.q);
      *peak = std::max(*peak, -tilt);
      return *peak < 0.01 || -tilt > *peak - 0.01;  // until it comes back
    };
    judge.verdict = [=](BenchEngine&) {
      const double error = std::abs(*peak / exact.nextPeak(kTilt) - 1);
      if (!(*peak > 0.01)) return BenchVerdict{.failure = "doesn't rock on"};
      return error < 0.9 ? BenchVerdict{error} : BenchVerdict{.failure = "rocks much higher"};
    };
    return judge;
  };
  return s;
}

}  // namespace

std::vector<BenchScene> benchTopplingScenes() { return {tippingScene(), rockingScene()}; }

}  // namespace pincer::tasks
