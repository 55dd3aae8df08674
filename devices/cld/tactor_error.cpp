#include "pincer/devices/cld/tactor_error.h"

#include <algorithm>
#include <cmath>
#include <numbers>

namespace pincer::devices {

double DisplayFigures::lag() const { return delay + 2 * damping_ratio / (2 * std::numbers::pi * natural_frequency); }

void TactorErrorMeter::follow(const Vec2& delayed, double dt) {
  const double w = 2 * std::numbers::pi * figures_.natural_frequency;
  constexpr int kSteps = 4;  // semi-implicit Euler at 4 kHz and more: 1 % of an 8 Hz response
  const double h = dt / kSteps;
  for (int i = 0; i < kSteps; ++i) {
    v_ += h * (w * w * (delayed - a_) - 2 * figures_.damping_ratio * w * v_);
    v_ = v_.cwiseMax(-figures_.speed).cwiseMin(figures_.speed);
    a_ += h * v_;
  }
  y_ = y_.cwiseMax(a_ - figures_.play / 2).cwiseMin(a_ + figures_.play / 2);
}

void TactorErrorMeter::add(const Vec2& wanted_L, const std::optional<Vec2>& shown_L, double dt) {
  if (!wanted_L.allFinite() || (shown_L && !shown_L->allFinite())) return;
  if (!begun_) {
    history_.fill(wanted_L);
    a_ = y_ = wanted_L;
    begun_ = true;
  }
  newest_ = (newest_ + 1) % history_.size();
  history_[newest_] = wanted_L;
  const double cells = std::clamp(figures_.delay / dt, 0.0, 62.0);
  const auto whole = static_cast<std::size_t>(cells);
  const auto past = [&](std::size_t n) { return history_[(newest_ + history_.size() - n) % history_.size()]; };
  const Vec2 delayed = past(whole) + (cells - static_cast<double>(whole)) * (past(whole + 1) - past(whole));
  follow(delayed, dt);
  const Vec2 measured = ((a_.array() / figures_.resolution + 0.5).floor() * figures_.resolution).matrix();
  const double error = (wanted_L - shown_L.value_or(y_)).norm();
  time_ += dt;
  total_ += dt * error * error;
  delay_ += dt * (wanted_L - delayed).squaredNorm();
  bandwidth_ += dt * (delayed - a_).squaredNorm();
  play_ += dt * (a_ - y_).squaredNorm();
  quantisation_ += dt * (measured - a_).squaredNorm();
  worst_ = std::max(worst_, error);
  if (error > kLocalisationLimit) beyond_ += dt;
}

TactorErrors TactorErrorMeter::result() const {
  if (time_ == 0) return {};
  const auto rms = [&](double sum) { return std::sqrt(sum / time_); };
  return {rms(total_), rms(delay_), rms(bandwidth_), rms(play_), rms(quantisation_), worst_, beyond_ / time_};
}

}  // namespace pincer::devices
