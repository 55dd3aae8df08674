// near_parts: the patches that a finger may come to touch before it has moved far, kept for the ticks until it has.
//
//   approach = max( |C - x| - reach,  the way to where the patch's normal cone may face C )
//              over the places x of the patch's ball
//
//   C  finger's centre [m], reach  how far from it contacts are wanted [m]
//   A patch matters once the centre has moved by its approach [m].
//
// A list of neighbours as in molecular dynamics (L. Verlet, Phys. Rev. 159, 1967). The tree is asked again when
// the centre has moved by the horizon; what faces along the followed contacts' normals within half of the angle
// at which two contacts count as two is left out, as whole branches of the tree: while those normals have
// turned by no more than the other half, it can't hold another contact. So on a smooth surface the list is
// short or empty, however fine the mesh is.
//
// Each part has its own `due`: the flat mesh can have no minimum of the distance on it before, so a tick looks at those
// only that are due and have their turn (turns.h). The list of the next look is made while this one still holds, a
// bounded part of it per tick, and takes over what is known of the parts.
//
// All of this is scratch: the parts are a function of mesh and look, and what isn't due would be found not to matter.
// So no answer depends on how far a list has come, on what is due when, nor on whether it had to be made anew.
#pragma once
#include <cstdint>
#include <vector>

#include "pincer/contact/surface/four_lanes.h"
#include "pincer/contact/surface/tree_walk.h"
#include "pincer/contact/surface_contact.h"

namespace pincer::contact {

constexpr double kApart = 0.998;  // cosine of 3.6 degrees: two contacts differ by more in their normals
constexpr double kHalfApart = ConesAlong::kHalfApart;  // the cosine of half that angle
constexpr double kLookHorizon = 1.0 / 8;               // the way for which a look holds, of its reach
constexpr std::size_t kMostParts = 512;                // of a list; a full one keeps its nearer half

struct NearPart {
  std::int32_t place;  // in the search's order
  float approach;      // [m], rounded down
  double due;          // SurfaceTracker::gone at which it may matter, no later [m]
  double turn = 0;     // at which it may be tried for another contact, no later [m]
};

struct NearParts {
  std::uint64_t net = 0;  // the mesh's fingerprint; 0: of none
  // its centre, reach and normals; the horizon is shorter than asked for where more than kMostParts are near
  SurfaceLook look;
  std::vector<NearPart> parts;  // by place, as the tree has them
  double due = 0;               // no later than any of them is and has its turn [m]
  TreeWalk walk;                // to those that aren't listed yet
  bool is_whole = false;
};

// Of one finger: the look that it lives from, and the next. What is due when holds for ways
// from where the last query left the centre.
struct LookParts {
  NearParts now, ahead;
  Vec3 p_BC = Vec3::Zero();
  double gone = 0;
};

// True if `parts` are those of the look, as far as they have come.
inline bool areOf(const NearParts& parts, std::uint64_t net, const SurfaceLook& look) {
  return parts.net == net && parts.look.p_BC == look.p_BC && parts.look.reach == look.reach && parts.look.n == look.n;
}

class SurfaceNet;
class SurfaceSearch;

// Begins a list. Allocates nothing in a NearParts that has room.
void beginNearParts(const SurfaceNet& net, const SurfaceLook& look, NearParts& found);

// Carries it on by at most `most` visits of the tree. `gone_at_look`: SurfaceTracker::gone less the way from
// the look to where the centre is now [m].
void continueNearParts(const SurfaceNet& net, const SurfaceSearch& search, double gone_at_look, int most,
                       NearParts& found);

// Forgets what was known of the parts but their approach.
void forgetDues(double gone_at_look, NearParts& parts);

// Parts of both lists become due no earlier than in `from`.
void takeDues(const NearParts& from, NearParts& to);

}  // namespace pincer::contact
