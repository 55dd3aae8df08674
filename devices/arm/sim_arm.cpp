#include "pincer/devices/arm/sim_arm.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <stdexcept>

#include "pincer/devices/sim_settings.h"

namespace pincer::devices {
namespace {

using namespace premium;

constexpr double kLongestStep = 0.5e-3;  // [s]
const Vec3 kLever(l1, l1, l2);           // of each joint on the tip at the reset place [m]

void check(const SimArmSettings& s) {
  requireSetting("simulated arm", s.payload >= 0 && s.payload < 1, "payload", s.payload, "[0, 1) kg");
  requireSetting("simulated arm", s.coulomb_friction >= 0 && s.coulomb_friction < 10, "coulomb_friction",
                 s.coulomb_friction, "[0, 10) N");
  requireSetting("simulated arm", s.viscous_friction >= 0 && s.viscous_friction < 100, "viscous_friction",
                 s.viscous_friction, "[0, 100) N s/m");
  requireSetting("simulated arm", s.encoder_step > 0 && s.encoder_step < 0.1, "encoder_step", s.encoder_step,
                 "(0, 0.1) rad");
  requireSetting("simulated arm", s.peak_force > 0 && s.peak_force < 1000, "peak_force", s.peak_force, "(0, 1000) N");
  requireSetting("simulated arm", s.force_slew > 0 && std::isfinite(s.force_slew), "force_slew", s.force_slew,
                 "(0, inf) N/s");
  requireSetting("simulated arm", s.delay >= 0 && s.delay <= 4e-3, "delay", s.delay, "[0, 0.004] s");
}

Vec3 startAngles(const SimArmSettings& s) {
  const auto q = inverse(s.start_D);
  if (q && withinLimits(s.limits, *q)) return *q;
  throw std::invalid_argument("simulated arm: start_D = (" + std::to_string(s.start_D.x()) + ", " +
                              std::to_string(s.start_D.y()) + ", " + std::to_string(s.start_D.z()) +
                              ") m is out of reach. (0, 0, 0) is the reset place.");
}

// A stop: n . q <= most.
struct Stop {
  Vec3 n;
  double most;
};

// Brings the joint speeds `w` down to what reaches, but doesn't cross, the stops within
// `h`; an inelastic impulse of the stop each.
void meetStops(const JointLimits& limits, const MassMatrix& m, const Vec3& q, double h, Vec3& w) {
  if (withinLimits(limits, q + h * w)) return;
  const std::array<Stop, 8> stops{{{Vec3::UnitX(), limits.max[0]},
                                   {-Vec3::UnitX(), -limits.min[0]},
                                   {Vec3::UnitY(), limits.max[1]},
                                   {-Vec3::UnitY(), -limits.min[1]},
                                   {Vec3::UnitZ(), limits.max[2]},
                                   {-Vec3::UnitZ(), -limits.min[2]},
                                   {Vec3(0, 1, -1), limits.elbow},
                                   {Vec3(0, -1, 1), limits.elbow}}};
  for (const Stop& stop : stops) {
    const double excess = stop.n.dot(w) - std::max(0.0, (stop.most - stop.n.dot(q)) / h);
    if (excess <= 0) continue;
    const Vec3 response = m.solve(stop.n);
    w -= response * (excess / stop.n.dot(response));
  }
}

// M + damping of `b_tip` [kg] against ground at the tip and `b_joints` [kg m^2] in
// the joints; J^T J has the same zeros as M.
MassMatrix withDamping(MassMatrix m, const Mat3& J, double b_tip, const Vec3& b_joints) {
  m.m11 += b_tip * J.col(0).squaredNorm() + b_joints[0];
  m.m22 += b_tip * J.col(1).squaredNorm() + b_joints[1];
  m.m33 += b_tip * J.col(2).squaredNorm() + b_joints[2];
  m.m23 += b_tip * J.col(1).dot(J.col(2));
  return m;
}

Vec3 rounded(const Vec3& q, double step) { return ((q.array() / step + 0.5).floor() * step).matrix(); }

}  // namespace

SimArm::SimArm(const SimArmSettings& settings) : settings_(settings) {
  check(settings);
  q_ = startAngles(settings);
  capabilities_.peak_force = settings.peak_force;
  capabilities_.continuous_force = 1.4;
  capabilities_.resolution = settings.encoder_step * l1;
  capabilities_.stiffness_limit = 3500;
  capabilities_.peak_torque = peakTorque();
  capabilities_.workspace_min_D = kWorkspaceMin_D;
  capabilities_.workspace_max_D = kWorkspaceMax_D;
  setHand(HandPull{.p_D = settings.start_D});
  takeSample();
}

std::string SimArm::identity() const { return "pincer simulated Premium 1.5 arm " + settings_.serial; }

DeviceState SimArm::state() const {
  return fault_ == SimFault::kUnplugged ? DeviceState::kFaulted : DeviceState::kReady;
}

ArmSample SimArm::sample() { return sample_; }

void SimArm::commandForce(const Vec3& f_D) {
  if (fault_ == SimFault::kStuckMotor || fault_ == SimFault::kUnplugged) return;
  Vec3 tau = f_D.allFinite() ? Vec3(J_measured_.transpose() * f_D) : Vec3::Zero();
  const double load = tau.cwiseQuotient(settings_.peak_force * kLever).cwiseAbs().maxCoeff();
  if (load > 1) tau /= load;
  // the newest command replaces the last one
  if (pending_count_ == static_cast<int>(pending_.size())) --pending_count_;
  pending_[pending_count_++] = {tau, settings_.delay};
}

void SimArm::advance(double dt) {
  const int steps = std::max(1, static_cast<int>(std::ceil(dt / kLongestStep - kTimeRounding)));
  for (int i = 0; i < steps; ++i) step(dt / steps);
  time_ += dt;
  takeSample();
}

void SimArm::setHand(const HandPull& hand) {
  hand_ = hand;
  inertia_ = inertia(settings_.payload + hand.mass);
}

void SimArm::setFault(SimFault fault) {
  fault_ = fault;
  if (fault == SimFault::kUnplugged) {
    pending_count_ = 0;
    tau_ = tau_wanted_ = Vec3::Zero();
  }
  takeSample();
}

Vec3 SimArm::peakTorque() const { return settings_.peak_force * kLever; }

Vec3 SimArm::trueTip_D() const { return forward(q_); }

Vec3 SimArm::trueVelocity_D() const { return jacobian(q_) * w_; }

Vec3 SimArm::handForce_D() const {
  return hand_.stiffness * (hand_.p_D - trueTip_D()) - hand_.damping * trueVelocity_D();
}

Vec3 SimArm::motorForce_D() const { return jacobian(q_).transpose().inverse() * tau_; }

double SimArm::mechanicalEnergy() const {
  return 0.5 * w_.dot(massMatrix(inertia_, q_).times(w_)) +
         0.5 * hand_.stiffness * (hand_.p_D - trueTip_D()).squaredNorm();
}

// Damping enters by its mean over the step (trapezoidal rule), which never turns into drive.
void SimArm::step(double h) {
  driveMotors(h);
  const Vec3 q = q_ + 0.5 * h * w_;
  const JointSines at(q);
  const MassMatrix m = massMatrix(inertia_, at);
  const Mat3 J = jacobian(at);
  const Vec3 v = J * w_;
  const Vec3 f_hand = hand_.stiffness * (hand_.p_D - forward(at)) - hand_.damping * v;
  const Vec3 bearings = settings_.viscous_friction * kLever.cwiseAbs2();
  const Vec3 tau = tau_ + J.transpose() * f_hand - bearings.cwiseProduct(w_);
  const MassMatrix damped = withDamping(m, J, 0.5 * h * hand_.damping, 0.5 * h * bearings);
  const Vec3 w_mid = w_ + damped.solve(0.5 * h * (tau - coriolis(inertia_, m, w_)));
  Vec3 w = w_ + damped.solve(h * (tau - coriolis(inertia_, m, w_mid)));
  w = afterDryFriction(damped, w, h * settings_.coulomb_friction * kLever);
  meetStops(settings_.limits, damped, q, h, w);
  w_ = w;
  q_ = q + 0.5 * h * w_;
}

void SimArm::driveMotors(double h) {
  int due = 0;
  while (due < pending_count_ && pending_[due].wait <= kTimeRounding) tau_wanted_ = pending_[due++].tau;
  for (int i = due; i < pending_count_; ++i) pending_[i - due] = {pending_[i].tau, pending_[i].wait - h};
  pending_count_ -= due;
  const Vec3 most = settings_.force_slew * h * kLever;
  tau_ += (tau_wanted_ - tau_).cwiseMax(-most).cwiseMin(most);
}

void SimArm::takeSample() {
  const JointSines at(measuredAngles());
  J_measured_ = jacobian(at);
  if (fault_ == SimFault::kFrozenSamples) return;
  sample_ = ArmSample{};
  sample_.time = time_;
  sample_.valid = fault_ != SimFault::kInvalidSamples && fault_ != SimFault::kUnplugged;
  if (!sample_.valid) return;
  sample_.q_DF = gimbal_;
  sample_.J = J_measured_;
  sample_.p_DF = fault_ == SimFault::kNotFinitePosition ? Vec3(Vec3::Constant(std::numeric_limits<double>::quiet_NaN()))
                                                        : forward(at);
}

Vec3 SimArm::measuredAngles() const { return rounded(q_, settings_.encoder_step); }

}  // namespace pincer::devices
