// link_contacts: contacts of links with each other and with what stands still or is led. The joints may leave nothing
// to solve of them.
//
//   s = |A_n| / |A|     share of a contact's velocities that can be along its normal [-]
//   A                   rows of the contact problem along three axes, of each side by itself
//
// A leg that swings along the side of its trunk touches it on all its way, and no coordinate moves the two along the
// normal: W_nn = |A_n|^2 is round-off, and any impulse would do. Impulses that stop a motion v grow as 1 / s, and the
// velocity that they give is off by (round-off / s) v.
//   s <= round-off / the solver's tolerance    the contact presses nothing and is left out
//   else                                       overlap is undone by at most s kLargestCorrection, so that links move
//                                              by kLargestCorrection at most
#pragma once
#include "pincer/engine/state.h"
#include "pincer/engine/world/scratch.h"

namespace pincer::engine {

// Leaves out contacts that nothing moves along their normals. Before fillContacts.
void leaveOutGrazingLinks(const WorldModel& model, WorldScratch& scratch);

// After fillContacts, in a part of a tick that takes time: limits pushes, and adds what the turn of a common carrier
// does.
//
// Velocities at the end of the tick meet the contact as it lies in the middle. Of two links of a robot that turns as a
// whole by w that errs by
//   h/2 n . (w x (2 v - w_a x r_a + w_b x r_b) - (w_a - w) x (w x r_a) + (w_b - w) x (w x r_b))
//   v  velocity of a past b [m/s];   w_a, w_b  how fast they turn [rad/s];   r_a, r_b  arms to the contact [m]
// and what joints keep shut seems to close. Contacts that pushed in the last tick know their turn from that one.
void adjustLinkContacts(const WorldModel& model, WorldScratch& scratch);

}  // namespace pincer::engine
