// contact_slots: the up to three places at which one finger touches one surface, followed from tick to tick.
//
//   h_i = height of the finger's centre C over contact i, along its normal [m];  phi_i = h_i - r
//
// A tick:  follow what the tracker's slots hold;  in free space take the nearest place instead;  look for further places that face the
// centre with h < r + margin;  keep the three that matter;  write the slots back.
//
// - A contact is followed for as long as the equation has a solution that way, so the tracked side of a thin wall never changes. A further
//   one is added where the finger comes to touch it, at phi near 0, and dropped once it is out of the margin: no force jumps.
// - A new contact is one that the finger could come to from outside: its place faces where the centre was at the last query and faces it
//   now, and no other part of the surface hides it. A centre that has been pressed under the surface counts as being where the finger would
//   be on that surface, so the far side of a wall stays out of reach however long the finger is pressed.
// - Two that have moved to one place are one: they push alike, so nothing jumps when the younger goes.
// - With several contacts, one that loses its solution is held with its normal; a single one is looked for in the whole surface first.
#pragma once
#include "contact/surface/surface_contact.h"
#include "contact/surface/surface_search.h"

namespace pincer::contact {

struct TouchedSurface {
  const SurfaceNet& net;
  const SurfaceSearch& search;
  SurfaceVariant variant;
};

// Allocates nothing, throws nothing.
SurfaceContacts touchSurface(const TouchedSurface& surface, const Vec3& p_BC, double r, double margin, SurfaceTracker& tracker,
                             PatchCache& cache);

}  // namespace pincer::contact
