#include "pincer/devices/cld/sim_one_dof_cld.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <numbers>
#include <stdexcept>

#include "pincer/devices/sim_settings.h"

namespace pincer::devices {
namespace {

constexpr double kRollerTick = 1e-3;                        // of the firmware [s]
constexpr const char* kRollerName = "simulated 1-DOF CLD";  // in messages and logs

void checkRoller(const SimOneDofCldSettings& s) {
  const auto require = [](bool ok, const char* field, double value, const char* range) {
    requireSetting(kRollerName, ok, field, value, range);
  };
  require(s.map.arc > 0 && s.map.arc < 0.1, "map.arc", s.map.arc, "(0, 0.1) m");
  require(s.map.travel > 0 && s.map.travel < 0.1, "map.travel", s.map.travel, "(0, 0.1) m");
  require(s.map.finger_diameter > 0 && s.map.finger_diameter < 0.1, "map.finger_diameter", s.map.finger_diameter,
          "(0, 0.1) m");
  require(s.loop_frequency > 0 && s.loop_frequency < 50, "loop_frequency", s.loop_frequency, "(0, 50) Hz");
  require(s.speed > 0 && s.speed < 10, "speed", s.speed, "(0, 10) m/s");
  require(s.acceleration > 0 && s.acceleration < 1000, "acceleration", s.acceleration, "(0, 1000) m/s^2");
  require(s.play >= 0 && s.play < 0.1, "play", s.play, "[0, 0.1) m");
  require(s.resolution > 0 && s.resolution < 0.01, "resolution", s.resolution, "(0, 0.01) m");
}

double onGrid(double value, double step) { return std::floor(value / step + 0.5) * step; }

}  // namespace

SimOneDofCld::SimOneDofCld(const SimOneDofCldSettings& settings) : settings_(settings) {
  checkRoller(settings);
  capabilities_ = {settings.map.placeOf(settings.resolution), settings.map.placeOf(settings.speed), 1 / kRollerTick,
                   Vec2(settings.map.arc / 2, 0)};
  transmitted(transmission_, 0, transmission_state_);  // the roller starts at the centre, and so does what drives it
  takeSample();
}

std::string SimOneDofCld::identity() const { return "pincer simulated 1-DOF CLD " + settings_.serial; }

DeviceState SimOneDofCld::state() const {
  return fault_ == SimFault::kUnplugged ? DeviceState::kFaulted : DeviceState::kReady;
}

TactileSample SimOneDofCld::sample() { return sample_; }

bool SimOneDofCld::command(const TactileCommand& command) {
  const Vec2 wanted = command.parked ? Vec2::Zero() : command.place_L;
  if (!wanted.allFinite()) return true;
  const double reachable = std::clamp(wanted.x(), -settings_.map.arc / 2, settings_.map.arc / 2);
  wanted_ = settings_.map.carriageOf(reachable);
  return reachable != wanted.x() || wanted.y() != 0;
}

void SimOneDofCld::setTransmission(const VirtualTransmission& transmission) {
  if (const auto problem = problemWith(transmission))
    throw std::invalid_argument(std::string(kRollerName) + ": " + *problem);
  transmission_ = transmission;
}

void SimOneDofCld::advance(double dt) {
  time_ += dt;
  owed_ += dt;
  for (; owed_ >= kRollerTick - kTimeRounding; owed_ -= kRollerTick) tick();
  takeSample();
}

void SimOneDofCld::setFault(SimFault fault) {
  fault_ = fault;
  takeSample();
}

void SimOneDofCld::tick() {
  std::rotate(travelling_.begin(), travelling_.end() - 1, travelling_.end());
  const double place = settings_.map.placeOf(wanted_);
  travelling_[0] = settings_.map.carriageOf(transmitted(transmission_, place, transmission_state_));
  draw_ = draw_ * 6364136223846793005u + 1442695040888963407u;  // Knuth's MMIX generator
  travelled_ = std::min(travelled_ + 1, 1 + static_cast<int>(draw_ >> 63));
  if (fault_ == SimFault::kStuckMotor || fault_ == SimFault::kUnplugged) {
    velocity_ = 0;
    return;
  }
  drive(travelling_[static_cast<std::size_t>(travelled_)]);
}

void SimOneDofCld::drive(double target) {
  const double w = 2 * std::numbers::pi * settings_.loop_frequency;
  const double error = target - onGrid(carriage_, settings_.resolution);
  const double asked = w * w * (3 * error + w * integral_) - 3 * w * velocity_;
  const double u = std::clamp(asked, -settings_.acceleration, settings_.acceleration);
  if (u == asked) integral_ += error * kRollerTick;  // no wind-up while the motor is at its limit
  velocity_ = std::clamp(velocity_ + u * kRollerTick, -settings_.speed, settings_.speed);
  carriage_ += velocity_ * kRollerTick;
  const double stop = 0.010;  // of the carriage: about 2 cm of travel [m]
  const double end = std::max(stop, settings_.map.travel / 2);
  if (std::abs(carriage_) > end) {
    carriage_ = std::copysign(end, carriage_);
    velocity_ = 0;
  }
  roller_ = std::clamp(roller_, carriage_ - settings_.play / 2, carriage_ + settings_.play / 2);
}

void SimOneDofCld::takeSample() {
  if (fault_ == SimFault::kFrozenSamples) return;
  sample_.time = time_;
  sample_.valid = fault_ != SimFault::kInvalidSamples && fault_ != SimFault::kUnplugged;
  sample_.place_L.reset();
  if (!sample_.valid) return;
  const double place = settings_.map.placeOf(onGrid(carriage_, settings_.resolution));
  sample_.place_L = Vec2(fault_ == SimFault::kNotFinitePosition ? std::numeric_limits<double>::quiet_NaN() : place, 0);
}

}  // namespace pincer::devices
