// Bodies that nothing touches.
#include <algorithm>
#include <cmath>
#include <memory>

#include "pincer/tasks/judge/bench/engine/bench_scene.h"
#include "pincer/tasks/judge/exact/pendulum.h"
#include "pincer/tasks/judge/exact/rigid_body.h"

namespace pincer::tasks {
namespace {

Vec3 momentsOfBox(double mass, const Vec3& half) {
  const Vec3 s = half.cwiseAbs2();
  return mass / 3 * Vec3(s.y() + s.z(), s.x() + s.z(), s.x() + s.y());
}

BenchVerdict angleFrom(const Quat& exact, double spin, BenchEngine& engine) {
  const BenchMotion m = engine.motion(0);
  if (!(m.w_W.norm() > 0.5 * spin && m.w_W.norm() < 2 * spin)) return {.failure = "doesn't keep its spin"};
  return {angleBetween(exact, m.X_WB.q)};
}

constexpr double kBoxMass = 0.1;  // [kg]
// Half sides [m]; spin [rad/s], nearly about the axis of the middle moment, where it tumbles.
const Vec3 kBoxHalf(0.01, 0.02, 0.04), kBoxSpin(0.02, 20, 0.02);

BenchWorld tumblingWorld(const Vec3& half, const Vec3& w) {
  BenchWorld world;
  world.gravity_W.setZero();
  world.bodies = {benchBox(kBoxMass, half, Vec3::Zero(), Vec3::Zero(), w)};
  return world;
}

BenchScene tumblingBoxScene() {
  BenchScene s{.name = "s1/tumbling-box",
               .metric = "angle at 1 s, error",
               .unit = "rad",
               .floor = 1e-14,
               .error_bound = 1e-6,
               .cost_bound = 0.3};
  s.world = tumblingWorld(kBoxHalf, kBoxSpin);
  s.judge = [] {
    const Quat exact = exact::freeRotation(momentsOfBox(kBoxMass, kBoxHalf), kBoxSpin, 1);
    return judgeOfEnd([=](BenchEngine& e) { return angleFrom(exact, kBoxSpin.norm(), e); });
  };
  return s;
}

// Largest drift of the kinetic energy.
BenchScene tumblingEnergyScene(bool whole) {
  BenchScene s{.name = "s1/energy",
               .metric = "energy drift, largest",
               .unit = "-",
               .duration = whole ? 60.0 : 10.0,
               .floor = 1e-15,
               .error_bound = 1e-7,
               .cost_bound = 0.3};
  s.world = tumblingWorld(kBoxHalf, kBoxSpin);
  s.judge = [] {
    const auto worst = std::make_shared<double>(0);
    const Vec3 moments = momentsOfBox(kBoxMass, kBoxHalf);
    const auto energy = [=](const BenchMotion& m) {
      const Vec3 w_B = m.X_WB.q.conjugate() * m.w_W;
      return 0.5 * w_B.dot(moments.cwiseProduct(w_B));
    };
    const double start = 0.5 * kBoxSpin.dot(moments.cwiseProduct(kBoxSpin));
    BenchJudge judge;
    judge.look = [=](double, BenchEngine& e) {
      *worst = std::max(*worst, std::abs(energy(e.motion(0)) / start - 1));
      return std::isfinite(*worst);
    };
    judge.verdict = [=](BenchEngine&) {
      return *worst < 1 ? BenchVerdict{*worst} : BenchVerdict{.failure = "energy more than doubles"};
    };
    return judge;
  };
  return s;
}

BenchScene coinScene() {
  const Vec3 half(0.02, 0.02, 0.005), spin(15, -4, 90);
  BenchScene s{.name = "more/symmetric-top",
               .metric = "angle at 1 s, error",
               .unit = "rad",
               .floor = 1e-13,
               .error_bound = 1e-10};
  s.world = tumblingWorld(half, spin);
  s.judge = [=] {
    const Vec3 moments = momentsOfBox(kBoxMass, half);
    const Quat exact = exact::symmetricTop(moments.x(), moments.z(), spin, 1);
    return judgeOfEnd([=](BenchEngine& e) { return angleFrom(exact, spin.norm(), e); });
  };
  return s;
}

// A bar that swings about its end, from the horizontal.
BenchScene pendulumScene() {
  const Vec3 half(0.1, 0.01, 0.01);
  BenchScene s{.name = "more/pendulum",
               .metric = "angle at 2 s, error",
               .unit = "rad",
               .duration = 2,
               .floor = 1e-12,
               .error_bound = 1e-10};
  BenchBody bar = benchBox(0.2, half, Vec3(0.1, 0, 0));
  bar.kind = BenchKind::kHinged;
  s.world.bodies = {bar};
  s.judge = [=] {
    const double inertia = 0.2 * (half.x() * half.x() + half.z() * half.z()) / 3 + 0.2 * 0.01;
    const double angle = exact::Pendulum{inertia, 0.2 * 0.1, kBenchG}.angle(M_PI / 2, 2) - M_PI / 2;  // about -y
    return judgeOfEnd([=](BenchEngine& e) {
      const BenchMotion m = e.motion(0);
      const double off = std::abs(m.X_WB.p.norm() - 0.1);
      if (!(off < 0.01)) return BenchVerdict{.failure = "leaves its hinge"};
      return BenchVerdict{std::max(angleBetween(quatFromRotationVector({0, -angle, 0}), m.X_WB.q), off / 0.1)};
    });
  };
  return s;
}

}  // namespace

std::vector<BenchScene> benchFreeScenes(bool whole) {
  return {tumblingBoxScene(), tumblingEnergyScene(whole), coinScene(), pendulumScene()};
}

}  // namespace pincer::tasks
