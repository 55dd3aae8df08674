// rocking: bodies that lean on a pad by a place that wanders far as they turn.
//
//   T = h^2 f F^T W F,   Gamma = 3/4 T^2 (1 + T)^-1,   g = F^-T Gamma F^-1
//   I w+ = I w_free + (moments of the contacts) - g (w+ - w_p)
//
//   W      of the contact [m] (contact/shape/wander.h): turned by theta the body gets the torque -f W theta
//   f      normal force of the last tick [N];   h  the tick [s]
//   F      F F^T = I^-1 of a free body about its centre of mass, in W [kg^-1/2 m^-1]
//   w_p    with which the pad turns [rad/s]
//   g      what resists the turn [kg m^2]
//
// A face bent to 5 m rocks under a gripper's load with w h = sqrt(T) > 2: a tick takes the place of the load from its
// middle, as it would be by the last velocity, and throws the body over it and back, for ever. With g the eigenvalues
// of the linear tick,  l^2 - (1 + rho - b) l + rho = 0,  rho = 1/(1 + Gamma), b = T rho,  are below 1 for every T > 0:
// b < 2 (1 + rho) is T < 4 + 2 Gamma. What rocks slower than a tick can follow (trace T <= 1) doesn't feel it: it would
// be rolling resistance. The torque is the contact's: its load acts by as much beside its place.
#pragma once
#include "pincer/engine/model.h"
#include "pincer/engine/state.h"
#include "pincer/engine/world/scratch.h"

namespace pincer::engine {

// After the contacts were recalled, before they are filled: the free velocities and F of bodies that rock.
void steadyRocking(const WorldModel& model, const WorldState& state, WorldScratch& scratch);

// After the contacts' impulses were gathered: -g (w+ - w_p) besides.
void resistRocking(WorldScratch& scratch);

}  // namespace pincer::engine
