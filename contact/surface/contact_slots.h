// contact_slots: the up to three places at which one finger touches one surface, followed from tick to tick.
//
//   h_i = (C - S_i) . n_i,   phi_i = h_i - r + e_i
//
//   C  finger's centre, S_i, n_i  place and unit normal of contact i [m, -], frame B;  r  finger's radius [m];  e_i >= 0  its ease [m]
//
// A tick:  follow what the tracker's slots hold;  in free space take the nearest place instead;  look for further places that face the
// centre with h < r + margin + w;  keep the three that matter;  ease what came or went in overlap;  write the slots back, and report those
// with h < r + margin.   w = r / 16: the centre's way within which each place is tried once, in turns (turns.h)
//
// - A contact is followed for as long as the equation has a solution that way, so the tracked side of a thin wall never changes. A further
//   one is added where the finger comes to touch it, at phi near 0, and dropped once it is out of the margin: no force jumps.
// - A new contact is one that the finger could come to from outside: its place faces where the centre was at the last query and faces it
//   now, and no other part of the surface hides it. A centre that has been pressed under the surface counts as being where the finger would
//   be on that surface, so the far side of a wall stays out of reach however long the finger is pressed.
// - Where more than three places are near, one that isn't touched yields to one that is clearly nearer; those that are touched stay, and
//   while they do none is looked for within w / 2 after one was left out.
// - Late by w, mostly: what comes from outside is known by the time it is reported, unless all slots are taken and one touches. What begins
//   in overlap begins at phi = 0 (below) whenever it is found; the places that lead to it may be there for less than w, and then it is missed
//   until others do (decision 7 has how often).
// - Two that have moved to one place are one. A contact whose overlap changes by more than it can (d / h of the way around an edge, d its
//   depth; by less on anything rounder and in hollows that the finger fits into) hasn't moved but slid down to another place: it is lost, and
//   that place is another contact's, or a new one.
// - Ease. Places that face a finger that is pressed into a hollow tighter than itself come, go and swap while they overlap (where two meet
//   at a fold of the distance). A contact that comes so begins at phi = 0, e = its depth; its ease shrinks by as much as the centre moves.
//   One that goes so stays as a plane, and its ease grows by as much, until it has faded; two that fade are joined, to push as both did,
//   where a new one needs the room. A finger whose contacts all have phi >= 0, as those of grasp/, meets no such place: the way down from
//   it leads to one nearer than it, so it lies at phi > 0. Nothing is eased where the centre leaps by more than half of r in one query.
// - A contact without a solution near is looked for in the whole surface; failing that, its plane is held.
#pragma once
#include "pincer/contact/surface/surface_search.h"
#include "pincer/contact/surface_contact.h"

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
