// Objects held, let slip, lifted and handed over by fingers.
#include <algorithm>
#include <cmath>
#include <memory>

#include "pincer/tasks/judge/bench/engine/bench_scene.h"
#include "pincer/tasks/judge/exact/pinch.h"

namespace pincer::tasks {
namespace {

constexpr double kPinchLimit = 0.1 * kBenchG / (2 * 2);  // the friction that just holds 100 g at 2 N [-]

// How far body 0 has moved between `settled` and the end; `most` is how far it may
// be from its start and count as held [m].
BenchJudge judgeOfHold(double settled, double most) {
  const auto start = std::make_shared<Vec3>(Vec3::Constant(std::nan(""))), rest = std::make_shared<Vec3>(Vec3::Zero());
  BenchJudge judge;
  judge.look = [=](double t, BenchEngine& e) {
    const Vec3 p = e.motion(0).X_WB.p;
    if (std::isnan(start->x())) *start = p;
    if (t < settled + 1e-9) *rest = p;
    return (p - *start).norm() < most;
  };
  judge.verdict = [=](BenchEngine& e) {
    const Vec3 p = e.motion(0).X_WB.p;
    if (!((p - *start).norm() < most)) return BenchVerdict{.failure = "drops it"};
    return BenchVerdict{1e6 * (p - *rest).norm()};
  };
  return judge;
}

BenchWorld pinchedBall(double mu) {
  BenchWorld world;
  world.mu = mu;
  world.bodies = {benchBall(0.1, 0.02, {0, 0, 0.1}), benchFinger({-0.028, 0, 0.1}, 0, [](double) { return 2; }),
                  benchFinger({0.028, 0, 0.1}, 0, [](double) { return -2; })};
  return world;
}

BenchScene holdScene(const std::string& name, double mu, double seconds) {
  BenchScene s{.name = name,
               .metric = "slip after 0.5 s",
               .unit = "um",
               .duration = seconds,
               .floor = 1e-10,
               .error_bound = 1e-6,
               .cost_bound = 0.9};
  s.world = pinchedBall(mu);
  s.judge = [] { return judgeOfHold(0.5, 0.01); };
  return s;
}

// Between steps the depth is taken as quadratic in time, with the velocity at the step's
// end, so that this errs less than any engine.
BenchScene slipScene() {
  constexpr double kDepth = 0.005, kMu = 0.98 * kPinchLimit;  // of the squeeze [m]; [-]
  BenchScene s{.name = "s4/slip-0.98",
               .metric = "time to drop 5 mm, relative error",
               .unit = "-",
               .duration = 2,
               .floor = 1e-12,
               .error_bound = 1e-4,
               .cost_bound = 1.3};
  s.world = pinchedBall(kMu);
  s.judge = [=] {
    struct Fall {
      double t = 0, depth = 0, dropped = std::nan("");
    };
    const auto fall = std::make_shared<Fall>();
    BenchJudge judge;
    judge.look = [=](double t, BenchEngine& e) {
      const BenchMotion m = e.motion(0);
      const double depth = 0.1 - m.X_WB.p.z(), h = t - fall->t;
      if (depth > kDepth) {  // depth - v s + a/2 s^2 = kDepth, s back from t, a from the step's two depths
        const double v = -m.v_W.z(), a = 2 * (fall->depth - depth + v * h) / (h * h), over = depth - kDepth;
        fall->dropped = t - 2 * over / (v + std::sqrt(std::max(0.0, v * v - 2 * a * over)));
        return false;
      }
      fall->t = t;
      fall->depth = depth;
      return true;
    };
    judge.verdict = [=](BenchEngine&) {
      const double exact = exact::SlidingPinch{0.1, 0.02, 0.05, 0.008, 2, kMu, kBenchG}.dropTime(kDepth);
      if (std::isnan(fall->dropped)) return BenchVerdict{.failure = "sticks"};
      const double error = std::abs(fall->dropped / exact - 1);
      return error < 0.5 ? BenchVerdict{error}
                         : BenchVerdict{.failure = "drops in less than half or more than 1.5 times the time"};
    };
    return judge;
  };
  return s;
}

double benchJerk(double s) { return s <= 0 ? 0 : s >= 1 ? 1 : s * s * s * (10 + s * (-15 + 6 * s)); }
double benchJerkRate(double s) { return s <= 0 || s >= 1 ? 0 : s * s * (30 + s * (-60 + 30 * s)); }

// Largest deviation from the motion of a cube that sticks to its fingers.
BenchScene liftScene() {
  BenchScene s{.name = "s5/lift",
               .metric = "trajectory, largest deviation",
               .unit = "um",
               .duration = 11,
               .floor = 1e-8,
               .error_bound = 1e-2,
               .cost_bound = 1.6};
  const auto finger = [](double x) {
    BenchBody f = benchFinger({x, 0, 0.1}, 0, [](double) { return 0; });
    f.locked = {false, true, false};
    f.stiffness = {0, 0, 500};
    f.damping = {0, 0, 2};
    f.aim = [x](double t) {
      const Vec3 rise(0, 0, 0.1 * benchJerk(t - 0.2)), speed(0, 0, 0.1 * benchJerkRate(t - 0.2));
      // half the cube's weight each
      return BenchAim{Vec3(x, 0, 0.1) + rise, speed, Vec3(x < 0 ? 4 : -4, 0, 0.1 * kBenchG)};
    };
    return f;
  };
  s.world.bodies = {benchBox(0.2, {0.025, 0.025, 0.025}, {0, 0, 0.1}), finger(-0.033), finger(0.033)};
  s.judge = [] {
    struct Path {
      std::vector<double> rises;
      std::size_t next = 0;
      double worst = 0;
    };
    const auto path = std::make_shared<Path>();
    BenchJudge judge;
    judge.look = [=](double t, BenchEngine& e) {
      if (path->rises.empty())
        path->rises = exact::StuckLift{0.3, 500, 2, 0.1, 1, 0.2}.rises(static_cast<int>(std::lround(11 / t)), t);
      const double error = std::abs(e.motion(0).X_WB.p.z() - 0.1 - path->rises[path->next++]);
      path->worst = std::max(path->worst, error);
      return error < 0.03;
    };
    judge.verdict = [=](BenchEngine&) {
      if (path->next < path->rises.size() || !std::isfinite(path->worst)) return BenchVerdict{.failure = "drops it"};
      return BenchVerdict{1e6 * path->worst};
    };
    return judge;
  };
  return s;
}

// A box between flat contacts falls with 0.02 g.
BenchScene flatSlideScene() {
  BenchScene s{.name = "more/flat-slide-0.98",
               .metric = "way in 0.48 s, relative error",
               .unit = "-",
               .duration = 0.48,
               .floor = 1e-15,
               .error_bound = 1e-9};
  s.world = pinchedBall(0.98 * kPinchLimit);
  s.world.bodies[0] = benchBox(0.1, {0.02, 0.02, 0.06}, {0, 0, 0.1});
  s.judge = [] {
    return judgeOfEnd([](BenchEngine& e) {
      const double exact = 0.5 * 0.02 * kBenchG * 0.48 * 0.48, way = 0.1 - e.motion(0).X_WB.p.z();
      if (!(way > 0.5 * exact)) return BenchVerdict{.failure = "sticks"};
      if (!(way < 2 * exact)) return BenchVerdict{.failure = "drops it"};
      return BenchVerdict{std::abs(way / exact - 1)};
    });
  };
  return s;
}

// Two fingers hold a box, two others take it, the first let go: from 2 N to 0.05 N and back.
BenchScene handoverScene() {
  BenchScene s{.name = "more/handover",
               .metric = "moved from 0.4 to 3 s",
               .unit = "um",
               .duration = 3.008,
               .floor = 1e-10,
               .error_bound = 1};
  s.world.mu = 0.6;
  const auto taking = [](double t) { return 0.05 + 1.95 * benchJerk(2 * (t - 0.5)); };
  const auto leaving = [](double t) { return 2 - 1.95 * benchJerk(2 * (t - 1.5)); };
  s.world.bodies = {benchBox(0.1, {0.02, 0.02, 0.03}, {0, 0, 0.1}), benchFinger({-0.028, 0, 0.1}, 0, leaving),
                    benchFinger({0.028, 0, 0.1}, 0, [=](double t) { return -leaving(t); }),
                    benchFinger({0, -0.028, 0.1}, 1, taking),
                    benchFinger({0, 0.028, 0.1}, 1, [=](double t) { return -taking(t); })};
  s.judge = [] { return judgeOfHold(0.4, 0.01); };
  return s;
}

// MuJoCo's issue 3328: a capsule between two pads that press it with a constant force, a multiple of what holds it.
BenchScene capsuleScene(const std::string& name, double squeeze, double seconds) {
  BenchScene s{.name = name,
               .metric = "creep after 0.5 s",
               .unit = "um/s",
               .duration = seconds,
               .floor = 1e-12,
               .error_bound = 1e-6 / 60};
  const auto pad = [=](double side) {
    BenchBody body = benchBox(0.2, {0.008, 0.03, 0.02}, {0.012 * side, 0, 0.1});
    body.kind = BenchKind::kGuided;
    body.locked = {false, true, true};
    body.damping = {100, 0, 0};
    body.aim = [=](double) { return BenchAim{Vec3::Zero(), Vec3::Zero(), Vec3(-squeeze * side, 0, 0)}; };
    return body;
  };
  s.steps = {4e-3, 2e-3, 1e-3, 5e-4};
  BenchBody rod = benchBall(0.045, 0.004, {0, 0, 0.1});
  rod.shape = contact::Capsule{0.004, 0.05};
  rod.X_WB.q = quatFromRotationVector({M_PI / 2, 0, 0});
  s.world.mu = 0.7;
  s.world.bodies = {rod, pad(-1), pad(1)};
  s.judge = [=] {
    BenchJudge judge = judgeOfHold(0.5, 0.02);
    judge.verdict = [=, um = judge.verdict](BenchEngine& e) {
      BenchVerdict v = um(e);
      v.error /= seconds - 0.5;
      return v;
    };
    return judge;
  };
  return s;
}

}  // namespace

std::vector<BenchScene> benchPinchScenes(bool whole) {
  const double minute = whole ? 60 : 10;
  return {holdScene("s4/hold", 0.5, minute),
          holdScene("s4/hold-1.02", 1.02 * kPinchLimit, 10),
          slipScene(),
          liftScene(),
          flatSlideScene(),
          handoverScene(),
          capsuleScene("more/capsule-pinch-20x", 6.207, whole ? 60 : 4),
          capsuleScene("more/capsule-pinch-95x", 29.84, whole ? 60 : 4)};
}

}  // namespace pincer::tasks
