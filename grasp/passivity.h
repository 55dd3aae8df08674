// passivity: fingers never give their users more energy than came in. Observers that watch, a controller that brakes.
//
//   E_i <- E_i - f_i . (p_i - p_i')
//       came in through finger i while its device held f_i, exactly, for a held force
//   B   <- min(B + sum_i (b |p_i - p_i'|^2 / h - f_i . (p_i - p_i')), S + R)
//       balance of all fingers: what may still flow out
//   O_i =  h f_i* . (v_i + h f_i / 2m) + |h f_i*|^2 / 2m
//       would flow out in the coming tick, with the wanted force f_i*
//   f_i =  f_i* - alpha_i v_i,   alpha_i = min(D_i / (h |v_i|^2), alpha_max)
//       where B < sum_i O_i, of fingers that move
//
//   E_i  energy that came in through finger i [J];  f_i  force that its device held since the last tick [N]
//   p_i, p_i'  its place now and then [m]
//   v_i  (p_i - p_i') / h, unfiltered: a filter's lag would miss what buzzes [m/s];  m, b  the least mass and
//        viscous friction of the arm at its tip [kg, N s/m]: half a tick's acceleration from the last velocity to
//        the present one and half to the coming one's mean
//   S    energy stored in the world above the least that it held [J] (stored in
//        springs, motion and height);  R  reserve [J]
//   D_i  finger i's share of sum O - B [J]: as much as it gave or would give itself. What the damping
//        can't dissipate stays in B: carried over
// Energy that alpha_max leaves is withheld (`bound`): the forces that would pay out are scaled down, all alike,
// to what B allows; direction kept. A finger slower than `still_speed` isn't damped: no damping has an effect
// there, and nothing is divided by its speed.
//
// The arm's own friction is what makes sampled walls passive at all (Colgate & Schenkel); its dissipation is credit, so
// that a coupling within the bound of hold_bounds.h is left alone.
//
// Energy may pass from one finger to another through what they hold: only the sum must not become negative (an n-port).
// With `each`, every finger must be passive alone.
//
// Sources: B. Hannaford, J.-H. Ryu, IEEE Trans. Robotics Autom. 18 (2002) 1-10 (observer and controller, n-ports);
// J.-H. Ryu, C. Preusche, B. Hannaford, G. Hirzinger, IEEE Trans. Control Syst. Technol. 13 (2005) 594-599 (a tick
// ahead); S. Stramigioli, C. Secchi, A. J. van der Schaft, C. Fantuzzi, IEEE Trans. Robotics 21 (2005) 574-587 (a held
// force's work is exact). Departures: the balance is no larger than what the world stores, so that energy lost to
// friction isn't credit to buzz with later; the arm's mass in the look ahead; the bound behind the damping.
#pragma once
#include <span>
#include <string>
#include <vector>

#include "pincer/contact/math.h"
#include "pincer/grasp/hold_bounds.h"

namespace pincer::grasp {

struct PassivityOptions {
  bool on = false;
  bool each = false;          // each finger alone, not only their sum
  bool bound = true;          // withhold what the damping can't dissipate
  double most_damping = 30;   // alpha_max [N s/m], 0 .. 1000
  double still_speed = 1e-4;  // [m/s], > 0
  double reserve = 0;         // R: what fingers may take out of the world beyond what they brought [J], >= 0
  std::vector<ArmPort> arms;  // m and b of each finger's arm; a finger beyond them has an ArmPort's defaults
};

// Throws InputError for a value out of its range.
void check(const PassivityOptions& options);

struct PortState {
  bool seen = false;
  Vec3 p_W = Vec3::Zero();       // of the device at the last tick [m]
  Vec3 v_W = Vec3::Zero();       // since the tick before [m/s]
  Vec3 f_held_W = Vec3::Zero();  // force on the user since the last tick [N]
  double energy = 0;             // E_i [J]
  double balance = 0;            // B of this finger alone [J]
  double damped = 0;             // by the controller so far, as predicted [J]
  double withheld = 0;           // by the bound so far, as predicted [J]
};

struct PassivityState {
  explicit PassivityState(std::size_t fingers = 0) : ports(fingers) {}
  std::vector<PortState> ports;
  double balance = 0;       // B [J]
  double least_stored = 0;  // by the world so far [J]
  bool started = false;
  int acted = 0;  // ticks in which the controller changed a force

  double energy() const;  // sum of E_i [J]
};

// Once per tick, before control: the devices' places now [m] and the energy that the world
// stores [J] (energy_ledger.h). `h`: tick [s].
void observePorts(const PassivityOptions& options, std::span<const Vec3> p_WF, double stored, double h,
                  PassivityState& state);

// Changes the wanted forces on the users [N].
void controlPorts(const PassivityOptions& options, double h, PassivityState& state, std::span<Vec3> f_W);

// Forces that the devices will hold until the next tick [N], after every other limit.
void holdPorts(std::span<const Vec3> f_W, PassivityState& state);

}  // namespace pincer::grasp
