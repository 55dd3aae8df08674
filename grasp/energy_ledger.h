// energy_ledger: where the energy of fingers came from and went to.
//
//   came in (held)  =  late + (stored + damped + slipped + to bodies + numerical)
//                      per finger, since the ledger was opened
//
//   held       -sum f_n-1 . (x_n - x_n-1)
//              through the finger's port: the force that the device held, over the way that it went [J]
//   late       -sum (f_n-1 - f_n) . (x_n - x_n-1)
//              part of it that exists only because a force is held for a tick and comes a tick late: negative means
//              energy made by sampling, the one that virtual walls are known for (J. E. Colgate, G. G. Schenkel,
//              J. Robotic Systems 14 (1997) 37-47)
//   stored     1/2 k e^2 + 1/2 m v^2, in the coupling's spring and the proxy, now less at the start
//   damped     by the coupling's damper, d |de|^2 / h
//   slipped    by friction between finger and bodies
//   to bodies  what the contacts did on bodies
//   numerical  the rest: what integrating in ticks dissipates (positive) or makes (negative)
//
//   f  force on the user [N];  x  place of the device [m];  e  proxy less device [m]
//   k, d, m  coupling (engine/model.h)
#pragma once
#include <span>
#include <vector>

#include "pincer/grasp/step.h"

namespace pincer::grasp {

struct EnergyAccount {
  double held = 0, late = 0, stored = 0, damped = 0, slipped = 0, to_bodies = 0, numerical = 0;  // [J]
};

class EnergyLedger {
 public:
  EnergyLedger(const GraspModel& model, const GraspState& state);

  // After each tick; `f_W`: forces that the devices hold from now on [N], those of the reports unless
  // something limited them. Allocates nothing.
  void add(const GraspModel& model, const GraspState& state, const GraspScratch& scratch,
           std::span<const Vec3> f_W = {});

  const EnergyAccount& account(std::size_t finger) const { return entries_[finger].account; }

 private:
  struct Entry {
    EnergyAccount account;
    // device, proxy and held force at the last tick
    Vec3 x_W = Vec3::Zero(), p_W = Vec3::Zero(), f_held_W = Vec3::Zero();
    double stored_at_start = 0;
  };
  std::vector<Entry> entries_;
};

// Of one finger's coupling and proxy, and of the whole: fingers, bodies' motion and height (zero at W's origin) [J].
double storedByFinger(const GraspModel& model, const GraspState& state, int finger);
double storedEnergy(const GraspModel& model, const GraspState& state);

}  // namespace pincer::grasp
