// simulated_finger: a simulated arm and display in virtual time, and the participant whose finger wears them.
#pragma once
#include "pincer/devices/arm/sim_arm.h"
#include "pincer/devices/cld/sim_one_dof_cld.h"
#include "pincer/tasks/lab/finger/worn_finger.h"

namespace pincer::tasks {

// A simulated 1-DOF display on a finger of this radius [m].
devices::SimOneDofCld simulatedDisplay(double finger_radius);

class SimulatedFinger final : public WornFinger {
 public:
  // `observer` has begun, and outlives it.
  SimulatedFinger(const FingerPlace& place, OneFingerObserver& observer);

  const FingerWear& wear() const override { return wear_; }
  void advanceTo(double now) override;
  const FingerInputs& sample() override;
  FingerDeed apply(const FingerOutputs& outputs, Cue cue, double now) override;
  void setTransmission(const devices::VirtualTransmission& transmission) override {
    display_.setTransmission(transmission);
  }
  double tactorPlace() const override { return tactor_place_; }

 private:
  Quat q_WD_;
  OneFingerObserver& observer_;
  devices::SimArm arm_;
  devices::SimOneDofCld display_;
  FingerWear wear_;
  FingerInputs inputs_;
  double now_ = 0, tactor_place_ = 0;  // [s], [m]
};

}  // namespace pincer::tasks
