#include "pincer/tasks/run/servo/arm_check.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <numbers>

#include "pincer/devices/usb/usb_bus.h"

namespace pincer::tasks {
namespace {

constexpr double kSettled = 0.3;     // after arming, in which a device may test itself [s]
constexpr double kFar = 0.015;       // the tip is pulled so far [m]
constexpr double kCalming = 1;       // [N s/m]
constexpr double kTopSpeed = 0.5;    // [m/s]
constexpr double kStrongest = 0.5;   // [N]
constexpr std::size_t kWindow = 10;  // ticks of a difference of places

}  // namespace

ArmCheck::ArmCheck(HandDevices& devices, int arms, const ArmCheckOptions& options)
    : devices_(devices),
      options_(options),
      gates_(static_cast<std::size_t>(arms)),
      findings_(gates_.size()),
      past_(gates_.size()) {
  for (int i = 0; i < arms; ++i) {
    devices::GateLimits limits;
    limits.watchdog_time = kOldestSample * options.watchdog;
    limits.peak_force = std::clamp(options.force, 1e-3, kStrongest);
    limits.slew = 100;
    limits.ramp_time = kSettled;
    limits.top_speed = kTopSpeed;
    limits_.push_back(devices::within(limits, devices.arm(i).capabilities()));
    findings_[static_cast<std::size_t>(i)].arm = devices.arm(i).identity();
    past_[static_cast<std::size_t>(i)].places.assign(kWindow, Vec3::Zero());
  }
}

void ArmCheck::cutForces() noexcept {
  for (std::size_t i = 0; i < gates_.size(); ++i) devices_.arm(static_cast<int>(i)).stop();
}

bool ArmCheck::tick(double now) {
  const std::int64_t epoch = devices::usb::monotonicNs() - static_cast<std::int64_t>(1e9 * now);
  if (!begun_ || epoch < epoch_ns_) devices_.setEpoch(epoch_ns_ = epoch);
  begun_ = true;
  devices_.advanceTo(now);
  if (!armed_ && now >= kRest && options_.force > 0) {
    armed_ = true;
    for (std::size_t i = 0; i < gates_.size(); ++i) devices::arm(gates_[i]), devices_.arm(static_cast<int>(i)).arm();
  }
  for (std::size_t i = 0; i < gates_.size(); ++i) drive(i, now);
  return now < kRest + (options_.force > 0 ? kPushed : 0);
}

void ArmCheck::drive(std::size_t i, double now) {
  devices::Arm& arm = devices_.arm(static_cast<int>(i));
  devices::GateInput in;
  in.sample = arm.sample();
  learn(i, in.sample, now);
  in.now = now;
  in.v_DF = past_[i].v;
  if (armed_) in.f_D = pull(i, in.sample, now);
  const Vec3 f_D = devices::gateForce(limits_[i], in, gates_[i]);
  arm.commandForce(f_D);
  findings_[i].strongest = std::max(findings_[i].strongest, f_D.norm());
  if (gates_[i].trip != devices::Trip::kNone && findings_[i].trip.empty())
    findings_[i].trip = devices::describe(limits_[i], gates_[i]);
}

// Out and back, with neither jerk nor end.
Vec3 ArmCheck::pull(std::size_t i, const devices::ArmSample& sample, double now) const {
  const double share = std::clamp((now - kRest - kSettled) / (kPushed - 2 * kSettled), 0.0, 1.0);
  const double there = 0.5 * (1 - math::cos(2 * std::numbers::pi * share));
  const Vec3 target = past_[i].first + Vec3(0, 0, kFar * there);
  const double stiffness = options_.force / (0.5 * kFar);
  return stiffness * (target - sample.p_DF) - kCalming * past_[i].v;
}

void ArmCheck::learn(std::size_t i, const devices::ArmSample& sample, double now) {
  ArmFindings& found = findings_[i];
  Past& past = past_[i];
  ++found.ticks;
  if (!sample.valid) return;
  ++found.valid;
  found.ages.add(now - sample.time);
  if (sample.time != past.time) ++found.fresh;
  past.time = sample.time;
  if (past.seen == 0) past.first = sample.p_DF;
  const Vec3 last = past.places[static_cast<std::size_t>(past.seen + kWindow - 1) % kWindow];
  const double step = past.seen > 0 ? (sample.p_DF - last).norm() : 0;
  if (step > 0 && (found.smallest_step == 0 || step < found.smallest_step)) found.smallest_step = step;
  if (now < kRest) found.noise = std::max(found.noise, (sample.p_DF - past.first).norm());
  if (armed_) found.moved = std::max(found.moved, sample.p_DF.z() - past.first.z());
  learnSpeed(i, sample);
  past.places[static_cast<std::size_t>(past.seen++) % kWindow] = sample.p_DF;
}

void ArmCheck::learnSpeed(std::size_t i, const devices::ArmSample& sample) {
  Past& past = past_[i];
  if (past.seen < static_cast<std::int64_t>(kWindow)) return;
  const Vec3 oldest = past.places[static_cast<std::size_t>(past.seen) % kWindow];
  past.v = (sample.p_DF - oldest) / (1e-3 * static_cast<double>(kWindow));
  if (!sample.v_DF) return;
  findings_[i].tells_speed = true;
  past.squares += (*sample.v_DF - past.v).squaredNorm();
  findings_[i].speed_error = std::sqrt(past.squares / static_cast<double>(++past.speeds));
}

std::string armCheckText(const ArmFindings& f) {
  const auto ms = [](double s) { return 1e3 * s; };
  std::string text =
      fmt::format("{}: {} of {} ticks with a sample, {} of them new\n", f.arm, f.valid, f.ticks, f.fresh);
  text += fmt::format("  age of a sample   median {:.2f}, 99.9 % <= {:.2f}, largest {:.2f} ms\n",
                      ms(f.ages.quantile(0.5)), ms(f.ages.quantile(0.999)), ms(f.ages.largest()));
  text += fmt::format("  place             at rest within {:.3g} um, smallest step {:.3g} um\n", 1e6 * f.noise,
                      1e6 * f.smallest_step);
  if (f.tells_speed)
    text +=
        fmt::format("  velocity          {:.2g} mm/s (rms) off the differences of its places\n", 1e3 * f.speed_error);
  text += fmt::format("  push              {:.2f} N at most; it moved {:.1f} mm", f.strongest, 1e3 * f.moved);
  return text;
}

std::vector<std::string> oddities(const ArmFindings& f, const ArmCheckOptions& options) {
  std::vector<std::string> odd;
  constexpr double kMostInvalid = 0.01;  // share of the samples
  if (!f.trip.empty()) odd.push_back(f.trip);
  if (static_cast<double>(f.valid) < (1 - kMostInvalid) * static_cast<double>(f.ticks))
    odd.push_back(
        fmt::format("Only {} of {} ticks had a sample. Check cable, power and calibration.", f.valid, f.ticks));
  const double old = f.ages.quantile(0.999), wanted = kOldestSample * options.watchdog;
  if (old > wanted)
    odd.push_back(
        fmt::format("A sample in a thousand is older than {:.1f} ms, and a session trusts {:.1f} ms. Close other "
                    "programs, permit real-time "
                    "priority (docs/devices/setup.md), or run sessions with --watchdog {:.0f}.",
                    1e3 * old, 1e3 * wanted, std::ceil(1e3 * old / kOldestSample)));
  if (options.force > 0 && f.trip.empty() && f.moved < 1e-3)
    odd.push_back(
        fmt::format("{:.2f} N moved it by {:.1f} mm only. Is something in its way, or are its motors without power?",
                    f.strongest, 1e3 * f.moved));
  return odd;
}

}  // namespace pincer::tasks
