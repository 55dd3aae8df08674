// Soft fingers on their limit surface, and fingertips that roll.
#include <algorithm>
#include <cmath>

#include "pincer/tasks/judge/bench/grasp/bench_grasp.h"
#include "pincer/tasks/judge/bench/grasp/grasp_bench.h"
#include "pincer/tasks/judge/exact/rolling_contact.h"

namespace pincer::tasks {
namespace {

constexpr double kSoftMu = 0.6;  // [-]

BenchGrasp softOnPlate(const grasp::SoftPad& pad, double twist_stiffness) {
  engine::WorldBuilder builder(benchWorld(false));
  builder.addBody({"plate", contact::HalfSpace{}, false, 0, {kSoftMu, kSoftMu, 0, 0}});
  grasp::FingerModel finger = benchFinger("soft");
  finger.pad = pad;
  finger.coupling.twist_stiffness = twist_stiffness;
  return {std::move(builder), {engine::BodyStart{}}, {finger}, {Vec3(0, 0, kBenchTip)}};
}

// Pressed 2 mm, then dragged at v [m/s] and turned at w [rad/s] about the normal: slides on the surface
//   (f_t / mu f_n)^2 + (tau / (e mu f_n))^2 = 1,   tau / f_t = e^2 w / v     (the flow is normal to it)
struct OnLimit {
  double surface = 0;  // how far off it, relative
  double flow = 0;     // how far the ratio is off, relative
};
OnLimit slideAndTurn(const grasp::SoftPad& pad, double v, double w) {
  BenchGrasp grasp = softOnPlate(pad, 0);
  grasp.leadAll({Vec3(0, 0, kBenchTip - 2e-3)}, 100);
  OnLimit worst;
  Vec3 p(0, 0, kBenchTip - 2e-3);
  for (int k = 1; k <= 1500; ++k) {
    p.x() += v * kGraspTick;
    grasp.leadFinger(0, p);
    grasp.inputs[0].q_WF = quatFromRotationVector({0, 0, w * kGraspTick * k});
    grasp.tick();
    if (k < 1000) continue;  // slides by then
    const grasp::FingerReport& f = grasp.felt(0);
    const double e = grasp::torsionRadius(pad, kBenchTip, f.normal_force), limit = kSoftMu * f.normal_force;
    worst.surface =
        std::max(worst.surface, std::abs(math::hypot(f.tangential_force / limit, f.torsion / (e * limit)) - 1));
    if (v > 1e-6 && w > 1e-6)
      worst.flow = std::max(worst.flow, std::abs(std::abs(f.torsion) / f.tangential_force * v / (e * e * w) - 1));
  }
  return worst;
}

std::vector<Record> limitSurface(MeasureContext&) {
  OnLimit given, hertz;
  for (const double angle : {0.0, 0.4, 0.8, 1.2, M_PI / 2}) {
    const double v = 0.02 * math::cos(angle), w = 6 * math::sin(angle);
    const OnLimit a = slideAndTurn({.patch_radius = 5e-3}, v, w), b = slideAndTurn({.modulus = 1e5}, v, w);
    given = {std::max(given.surface, a.surface), std::max(given.flow, a.flow)};
    hertz = {std::max(hertz.surface, b.surface), std::max(hertz.flow, b.flow)};
  }
  return {atMost("patch given: off the limit surface, relative", given.surface, "-", 1e-3),
          atMost("patch given: off the flow rule, relative", given.flow, "-", 1e-3),
          atMost("patch by Hertz: off the limit surface, relative", hertz.surface, "-", 1e-3),
          atMost("patch by Hertz: off the flow rule, relative", hertz.flow, "-", 1e-3)};
}

// The onset, from rest: a twist spring of 0.2 N m/rad is wound up by a device that turns by microradians per tick.
std::vector<Record> twistOnset(MeasureContext&) {
  constexpr double kPadTwist = 0.2;  // [N m/rad]: about a fingertip's, 0.3
  const grasp::SoftPad pad{.patch_radius = 5e-3};
  BenchGrasp grasp = softOnPlate(pad, kPadTwist);
  grasp.leadAll({Vec3(0, 0, kBenchTip - 2e-3)}, 100);
  grasp.leadAll({Vec3(0, 0, kBenchTip - 2e-3)}, 200);
  double stiffness = 0, onset = 0;
  for (int k = 1; k <= 60000 && !grasp.felt(0).sliding; ++k) {
    const double angle = 1e-6 * k;
    grasp.inputs[0].q_WF = quatFromRotationVector({0, 0, angle});
    grasp.tick();
    onset = std::abs(grasp.felt(0).torsion) / (kSoftMu * grasp.felt(0).normal_force * 2.0 / 3 * pad.patch_radius);
    if (k == 10000) stiffness = std::abs(grasp.felt(0).torsion) / angle;
  }
  return {atMost("torsion at which it slips, over the limit, less 1", std::abs(onset - 1), "-", 1e-3),
          atMost("stiffness felt before, over the spring's, less 1", std::abs(stiffness / kPadTwist - 1), "-", 1e-6)};
}

// A tip rolls over a ball that doesn't move: its device goes round the ball and turns as rolling wants it.
struct Rolled {
  double speed = 0;  // of the contact over the pad, off Montana's, relative
  double share = 0;  // tangential over normal force
};
Rolled rollOver(double body_radius) {
  engine::WorldBuilder builder(benchWorld(false));
  if (body_radius > 0) {
    builder.addBody({"ball", contact::Sphere{body_radius}, false, 0, {kSoftMu, kSoftMu, 0, 0}});
  } else {
    builder.addBody({"plate", contact::HalfSpace{}, false, 0, {kSoftMu, kSoftMu, 0, 0}});
  }
  constexpr double kSpin = 2, kDepth = 1e-3;  // [rad/s], [m]
  const double k_b = body_radius > 0 ? 1 / body_radius : 0, k_f = 1 / kBenchTip;
  const double exact = exact::contactSpeedOnFinger(k_f, k_b, kSpin, 0);
  const double around = body_radius > 0 ? exact * k_b : 0;  // of the contact about the ball's centre [rad/s]
  // The proxy stays on the surface and rolls there; the device leads it, the press below it.
  const auto device = [&](double t) -> Vec3 {
    if (body_radius <= 0) return {kSpin * kBenchTip * t, 0, kBenchTip - kDepth};
    const double a = around * t, R = body_radius + kBenchTip - kDepth;
    return {R * math::sin(a), 0, R * math::cos(a)};
  };
  BenchGrasp grasp(std::move(builder), {engine::BodyStart{}}, {benchFinger("rolling", 1000, 0)},
                   {device(0) + Vec3(0, 0, kDepth)});
  grasp.leadAll({device(0)}, 100);
  grasp.leadAll({device(0)}, 200);
  Rolled worst;
  for (int k = 1; k <= 600; ++k) {
    // Eased in over 0.2 s: a jump of the speed would be felt.
    const double s = std::min(1.0, k / 200.0),
                 t = kGraspTick * (k <= 200 ? 200 * (s * s * s - 0.5 * s * s * s * s) : k - 100);
    grasp.leadFinger(0, device(t));
    grasp.inputs[0].q_WF = quatFromRotationVector({0, kSpin * t, 0});
    grasp.tick();
    if (k < 400) continue;
    const grasp::FingerReport& f = grasp.felt(0);
    worst.speed = std::max(worst.speed,
                           std::abs(grasp::placeRateOnPad(grasp.model.fingers[0], f, kGraspTick).norm() / exact - 1));
    worst.share = std::max(worst.share, f.tangential_force / f.normal_force);
  }
  return worst;
}

std::vector<Record> rolling(MeasureContext&) {
  const Rolled plane = rollOver(0), ball = rollOver(0.02);
  return {atMost("on a plane: speed of the contact over the pad, off Montana's, relative", plane.speed, "-", 1e-6),
          atMost("on a ball: likewise", ball.speed, "-", 1e-6),
          atMost("on a plane: tangential over normal force", plane.share, "-", 1e-3),
          unbounded("on a ball: tangential over normal force (the spring leads the proxy)", ball.share, "-")};
}

}  // namespace

std::vector<Measurement> softFingerMeasurements() {
  return {{"soft/limit-surface", limitSurface}, {"soft/twist", twistOnset}, {"soft/rolling", rolling}};
}

}  // namespace pincer::tasks
