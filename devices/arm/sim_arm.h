// sim_arm: a Phantom Premium 1.5 in virtual time, held by a simulated hand.
//
//   M(q) qddot + c(q, qdot) = tau_motor + J^T f_hand - B qdot - tau_friction,    |tau_friction,i| <= f_c lever_i
//   f_hand = k (p_hand - p_DF) - b v_DF
//
// M holds the arm, the display that it carries and the finger's mass at the tip; gravity is compensated. Dry
// friction is exact: a joint sticks while friction can hold it. Motors: command -> torque by J^T at the measured
// angles, one common scale when a joint would saturate, a pure delay, then a slew limit. The encoders quantise
// the joint angles; position is all that the arm measures (no velocity). Motion: half a drift, a kick with the
// forces there, half a drift; sub-steps of at most 0.5 ms (stable to 10 N/mm at the tip). Sources: constants and
// stops in premium_dynamics.h and premium_kinematics.h; friction, resolution, forces from the maker's data sheet.
// Where no source is given the value is ours.
#pragma once
#include <array>
#include <cstdint>
#include <string>

#include "pincer/devices/arm/arm.h"
#include "pincer/devices/arm/premium_dynamics.h"
#include "pincer/devices/arm/premium_kinematics.h"
#include "pincer/devices/math.h"
#include "pincer/devices/sim_fault.h"

namespace pincer::devices {

// The hand that holds the arm: where it aims and how firmly.
struct HandPull {
  Vec3 p_D = Vec3::Zero();  // where the hand would be if nothing pulled at it [m]
  double stiffness = 400;   // k [N/m], 200..600 for a hand that holds an object
  double damping = 3;       // b [N s/m], 2..5; opposes the velocity over ground
  double mass = 0.07;       // of the finger, fixed to the fingertip [kg], 0.05..0.1
};

struct SimArmSettings {
  std::string serial = "sim";      // tells two arms apart
  Vec3 start_D = Vec3::Zero();     // where the tip is at time 0 [m], within reach
  double payload = 0.045;          // carried at the tip [kg]: a 2-DOF contact location display (Doxon 2014, ch. 4)
  double coulomb_friction = 0.04;  // at the reset place [N], per axis
  double viscous_friction = 0.05;  // at the reset place [N s/m] (ours)
  double encoder_step = 3e-5 / premium::l1;  // of a joint angle [rad]: 0.03 mm at the tip
  double peak_force = 8.5;                   // at the reset place [N]
  double force_slew = 20000;                 // at the reset place [N/s]: 8.5 N in 0.4 ms, the motors' inductance (ours)
  double delay = 0.5e-3;                     // of a command [s], 0..4 ms (ours)
  premium::JointLimits limits = {};
};

class SimArm final : public Arm {
 public:
  // Throws std::invalid_argument for settings out of range or a start out of reach.
  explicit SimArm(const SimArmSettings& settings = {});

  std::string identity() const override;
  const ArmCapabilities& capabilities() const override { return capabilities_; }
  DeviceState state() const override;
  ArmSample sample() override;
  void commandForce(const Vec3& f_D) override;

  // Time moves only here. `dt` > 0 [s].
  void advance(double dt);

  void setHand(const HandPull& hand);
  // Orientation of the passive gimbal, read back in samples; absent until set.
  void setGimbal(const Quat& q_DF) { gimbal_ = q_DF; }
  void setFault(SimFault fault);

  // The truth, for records and tests; no participant may see it.
  double time() const { return time_; }
  // The largest torques of the motors [N m]: peak_force at the reset place.
  Vec3 peakTorque() const;
  Vec3 trueTip_D() const;           // [m]
  Vec3 trueVelocity_D() const;      // [m/s]
  Vec3 handForce_D() const;         // of the hand on the tip [N]
  Vec3 motorForce_D() const;        // of the motors on the tip [N]
  double mechanicalEnergy() const;  // kinetic energy plus the hand's spring [J]

 private:
  struct PendingTorque {
    Vec3 tau = Vec3::Zero();
    double wait = 0;  // until it reaches the motors [s]
  };

  void step(double h);
  void driveMotors(double h);
  void takeSample();
  Vec3 measuredAngles() const;

  SimArmSettings settings_;
  ArmCapabilities capabilities_;
  premium::Inertia inertia_;
  HandPull hand_;
  SimFault fault_ = SimFault::kNone;
  std::optional<Quat> gimbal_;
  double time_ = 0;                       // [s]
  Vec3 q_ = Vec3::Zero();                 // joint angles [rad]
  Vec3 w_ = Vec3::Zero();                 // joint speeds [rad/s]
  Vec3 tau_ = Vec3::Zero();               // of the motors [N m]
  Vec3 tau_wanted_ = Vec3::Zero();        // what they slew to [N m]
  std::array<PendingTorque, 8> pending_;  // commands on their way, oldest first
  int pending_count_ = 0;
  Mat3 J_measured_ = Mat3::Zero();  // at the measured angles [m/rad]
  ArmSample sample_;
};

}  // namespace pincer::devices
