#include "pincer/tasks/lab/participants/skin.h"

#include <cmath>
#include <numbers>

namespace pincer::tasks {
namespace {

constexpr double kSkinStep = 1e-3;            // [s]
constexpr double kDifferenceOfSigma = 0.954;  // 0.674 sqrt(2)

double keptOf(double frequency) { return math::exp(-2 * std::numbers::pi * frequency * kSkinStep); }

}  // namespace

BandPass::BandPass(double low, double high) : keep_low_(keptOf(low)), keep_high_(keptOf(high)) {}

double BandPass::pass(double input) {
  if (!begun_) slow_[0] = input;
  begun_ = true;
  double passed = input;
  for (double& slow : slow_) {
    slow = passed + keep_low_ * (slow - passed);
    passed -= slow;
  }
  first_ = passed + keep_high_ * (first_ - passed);
  second_ = first_ + keep_high_ * (second_ - first_);
  return second_;
}

void BandPower::add(double u, bool counts) {
  const double x = filter_.pass(u);
  if (!counts) return;
  sum_ += x * x;
  ++count_;
}

double BandPower::rms() const { return count_ > 0 ? std::sqrt(sum_ / count_) : 0; }

void BandPower::clear() {
  sum_ = 0;
  count_ = 0;
}

PushedSkin::PushedSkin(const SkinLimits& limits)
    : stiffness_(limits.stiffness),
      w2_(limits.stiffness / limits.mass),
      drag_(2 * limits.damping * std::sqrt(limits.stiffness / limits.mass)) {}

Vec2 PushedSkin::pushed(const Vec2& f) {
  const Vec2 a = w2_ * (f / stiffness_ - u_) - drag_ * v_;
  v_ += kSkinStep * a;  // semi-implicit Euler: stable up to w = 2000 / s, here 100 / s
  u_ += kSkinStep * v_;
  return u_;
}

FeltMotion feltMotion(double rms, double threshold, double difference, Random& random) {
  const double sigma = math::hypot(threshold, difference * rms) / kDifferenceOfSigma;
  return {rms + sigma * random.normal(), sigma};
}

}  // namespace pincer::tasks
