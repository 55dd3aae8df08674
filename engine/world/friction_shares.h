// friction_shares: how the contacts of a fingertip's face share its friction,
// where the shares of the last tick use it up.
//
//   r_iT = w_i (d + theta n x rho_i),   r_i,torsion = w_i e_i theta,   w_i = mu_i r_in
//
//   d, theta  such that force and torsion are those of the last tick's impulses [-, 1/m];  rho_i  place
//             from the w-weighted mean of them all [m]
//   e_i       torsion radius [m]
//
// Contacts of one face hold it more than once: pulling at each other they need no force from outside, and may use
// up all their friction so. Then they slide in turn, and what is held creeps (a short cylinder between flat pads,
// by 1e-3 um in seconds). These shares use least, and differ from the others by what is in balance anyway: as a
// warm start they cost the solver nothing.
#pragma once
#include "pincer/engine/world/scratch.h"

namespace pincer::engine {

// Of scratch.contacts (sorted by id) between points and bodies, changes scratch.r where a contact uses more than half
// of its friction and need not. Allocates nothing.
void shareFriction(WorldScratch& scratch);

}  // namespace pincer::engine
