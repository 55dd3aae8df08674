#include "pincer/devices/cld/sim_cld.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <numbers>
#include <stdexcept>

#include "pincer/devices/sim_settings.h"

namespace pincer::devices {
namespace {

constexpr double kTick = 0.5e-3;   // of the firmware [s]
constexpr int kTicksPerFrame = 4;  // commands at 500 Hz

void check(const SimCldSettings& s) {
  requireSetting("simulated CLD", s.speed > 0 && s.speed < 10, "speed", s.speed, "(0, 10) m/s");
  requireSetting("simulated CLD", s.natural_frequency > 0 && s.natural_frequency < 500, "natural_frequency",
                 s.natural_frequency, "(0, 500) Hz");
  requireSetting("simulated CLD", s.damping_ratio > 0 && s.damping_ratio < 1, "damping_ratio", s.damping_ratio,
                 "(0, 1)");
  requireSetting("simulated CLD", s.play.minCoeff() >= 0 && s.play.maxCoeff() < 0.1, "play", s.play.minCoeff(),
                 "[0, 0.1) m");
  requireSetting("simulated CLD", s.resolution > 0 && s.resolution < 0.01, "resolution", s.resolution, "(0, 0.01) m");
  requireSetting("simulated CLD", s.delay >= 0 && s.delay <= kTick * kTicksPerFrame, "delay", s.delay, "[0, 0.002] s");
  requireSetting("simulated CLD", s.jitter >= 0 && s.delay + s.jitter <= kTick * kTicksPerFrame, "jitter", s.jitter,
                 "[0, 0.002 - delay] s");
}

double rounded(double value, double step) { return std::floor(value / step + 0.5) * step; }

}  // namespace

SimCld::SimCld(const SimCldSettings& settings) : settings_(settings), kinematics_(settings.geometry, settings.profile) {
  check(settings);
  const double round = settings.profile.radius * settings.geometry.carriage_max;
  most_ = Vec2(settings.geometry.place_max, round);
  least_ = Vec2(settings.geometry.place_min, -round);
  capabilities_ = {settings.resolution, settings.speed, 1 / (kTick * kTicksPerFrame), most_.cwiseMax(-least_)};
  jitter_ticks_ = static_cast<int>(std::floor(settings.jitter / kTick + 0.5));
  delay_ticks_ = static_cast<int>(std::floor(settings.delay / kTick + 0.5));
  const double w = 2 * std::numbers::pi * settings.natural_frequency;
  const double decay = settings.damping_ratio * w;
  const double wd = w * std::sqrt(1 - settings.damping_ratio * settings.damping_ratio);
  const double e = math::exp(-decay * kTick), s = math::sin(wd * kTick) / wd, c = math::cos(wd * kTick);
  a11_ = e * (c + decay * s);
  a12_ = e * s;
  a21_ = -w * w * e * s;
  a22_ = e * (c - decay * s);
  takeSample();
}

std::string SimCld::identity() const { return "pincer simulated 2-DOF CLD " + settings_.serial; }

DeviceState SimCld::state() const {
  return fault_ == SimFault::kUnplugged ? DeviceState::kFaulted : DeviceState::kReady;
}

TactileSample SimCld::sample() { return sample_; }

bool SimCld::command(const TactileCommand& command) {
  const Vec2 wanted = command.parked ? Vec2::Zero() : command.place_L;
  if (!wanted.allFinite()) return true;
  mailbox_ = wanted;
  return !kinematics_.reaches(wanted);
}

Vec2 SimCld::waysTo(const Vec2& place_L) const {
  const PadWay way = kinematics_.reach(place_L).way;
  return {way.along, settings_.profile.radius * way.round};
}

void SimCld::advance(double dt) {
  time_ += dt;
  owed_ += dt;
  while (owed_ >= kTick - kTimeRounding) {
    tick();
    owed_ -= kTick;
  }
  takeSample();
}

void SimCld::setFault(SimFault fault) {
  fault_ = fault;
  takeSample();
}

void SimCld::tick() {
  if (in_flight_ && --hops_left_ == 0) arrive();
  if (frame_tick_ == 0 && mailbox_) {
    in_flight_ = waysTo(*mailbox_);
    mailbox_.reset();
    draw_ = draw_ * 6364136223846793005u + 1442695040888963407u;  // Knuth's MMIX generator
    hops_left_ = delay_ticks_ + static_cast<int>((draw_ >> 33) % static_cast<unsigned>(jitter_ticks_ + 1));
    if (hops_left_ == 0) arrive();
  }
  frame_tick_ = (frame_tick_ + 1) % kTicksPerFrame;
  for (int axis = 0; axis < 2; ++axis) moveAxis(axis);
}

void SimCld::arrive() {
  target_ = *in_flight_;
  in_flight_.reset();
}

void SimCld::moveAxis(int axis) {
  if (fault_ == SimFault::kStuckMotor || fault_ == SimFault::kUnplugged) {
    actuator_speed_[axis] = 0;
    return;
  }
  double& a = actuator_[axis];
  double& v = actuator_speed_[axis];
  const double x = a - target_[axis];
  const double limit = settings_.speed * kTick;
  a += std::clamp(a11_ * x + a12_ * v - x, -limit, limit);
  v = std::clamp(a21_ * x + a22_ * v, -settings_.speed, settings_.speed);
  if (a > most_[axis] || a < least_[axis]) {  // an overshoot meets the end stop
    a = std::clamp(a, least_[axis], most_[axis]);
    v = 0;
  }
  tactor_[axis] = std::clamp(tactor_[axis], a - settings_.play[axis] / 2, a + settings_.play[axis] / 2);
}

void SimCld::takeSample() {
  if (fault_ == SimFault::kFrozenSamples) return;
  sample_.time = time_;
  sample_.valid = fault_ != SimFault::kInvalidSamples && fault_ != SimFault::kUnplugged;
  sample_.place_L.reset();
  if (!sample_.valid) return;
  if (fault_ == SimFault::kNotFinitePosition) {
    sample_.place_L = Vec2::Constant(std::numeric_limits<double>::quiet_NaN());
  } else {
    const Vec2 read(rounded(actuator_.x(), settings_.resolution), rounded(actuator_.y(), settings_.resolution));
    if (read != read_) read_place_L_ = placeOf(read);
    read_ = read;
    sample_.place_L = read_place_L_;
  }
}

}  // namespace pincer::devices
