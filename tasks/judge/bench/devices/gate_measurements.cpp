#include <algorithm>
#include <cmath>
#include <limits>

#include "pincer/devices/gate/force_gate.h"
#include "pincer/tasks/judge/bench/devices/devices_bench.h"
#include "pincer/tasks/lab/participants/random.h"

namespace pincer::tasks {
namespace {

using devices::GateInput;
using devices::GateLimits;
using devices::GateState;

// Wishes that jump, explode, and now and then aren't numbers, on an arm whose levers change as it moves.
class GateAdversary {
 public:
  GateInput next() {
    in_.now += 1e-3;
    in_.sample.time = in_.now;
    in_.sample.valid = random_.below(2000) != 0;
    if (!in_.f_D.allFinite() || random_.below(20) == 0) in_.f_D = wish();
    in_.v_DF = Vec3(random_.uniform() - 0.5, random_.uniform() - 0.5, 0);
    for (int i = 0; i < 9; ++i)
      J_(i / 3, i % 3) = std::clamp(J_(i / 3, i % 3) + 2e-4 * (random_.uniform() - 0.5), -0.3, 0.3);
    in_.sample.J = J_;
    return in_;
  }

 private:
  Vec3 wish() {
    const Vec3 direction(random_.uniform() - 0.5, random_.uniform() - 0.5, random_.uniform() - 0.5);
    const double scale[] = {0, 1, 20, 1e12, 1e300, std::numeric_limits<double>::quiet_NaN()};
    return direction * scale[random_.below(6)];
  }
  Random random_{1};
  GateInput in_;
  Mat3 J_ = 0.2 * Mat3::Identity();
};

std::vector<Record> hostileTicks(MeasureContext& context) {
  GateLimits limits;
  limits.ramp_time = 0.1;
  limits.peak_torque = Vec3(1.2, 1.2, 1.0);
  GateAdversary adversary;
  GateState state;
  double force = 0, change = 0, torque = 0;
  std::int64_t not_finite = 0, unlatched = 0;
  constexpr int kTicks = 1'000'000;  // 1000 s at 1 kHz; chosen
  for (int i = 0; i < kTicks && !context.interrupted(); ++i) {
    if (!state.armed && i % 50 == 0) devices::arm(state);
    const GateState before = state;
    const GateInput in = adversary.next();
    const Vec3 f = devices::gateForce(limits, in, state);
    not_finite += !f.allFinite();
    unlatched += !before.armed && (state.armed || !f.isZero(0));
    force = std::max(force, f.norm());
    torque = std::max(torque, (in.sample.J->transpose() * f).cwiseQuotient(*limits.peak_torque).cwiseAbs().maxCoeff());
    if (before.armed && state.armed) change = std::max(change, (f - before.f_D).norm());
    if (i % 1000 == 0) context.progress(static_cast<double>(i) / kTicks);
  }
  return {atMost("largest force in 1e6 hostile ticks", force, "N", 8.5),
          atMost("largest change in a tick, but for trips", change, "N", 1.001),
          atMost("largest joint torque over its bound", torque, "-", 1 + 1e-12),
          exactly("forces that are no numbers", static_cast<double>(not_finite), "-", 0),
          exactly("ticks with force while latched", static_cast<double>(unlatched), "-", 0)};
}

}  // namespace

std::vector<Measurement> gateMeasurements() { return {{"gate/adversary", hostileTicks}}; }

}  // namespace pincer::tasks
