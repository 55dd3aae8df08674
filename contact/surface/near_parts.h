// near_parts: the patches that a finger may come to touch before it has moved far, kept for the ticks until it has.
//
//   approach = max( |C - x| - reach,  the way to where the patch's normal cone may face C )   over the places x of the patch's ball
//
//   C  finger's centre [m], reach  how far from it contacts are wanted [m];  a patch matters once the centre has moved by its approach [m]
//
// A list of neighbours as in molecular dynamics (L. Verlet, Phys. Rev. 159, 1967), ordered by approach: a tick looks at its first few only,
// and the tree is asked again when the centre has moved by the horizon. What faces along the followed contacts' normals within half of the
// angle at which two contacts count as two is left out, as whole branches of the tree: while those normals have turned by no more than the
// other half, it can't hold another contact. So on a smooth surface the list is short or empty, however fine the mesh is.
#pragma once
#include <cstdint>
#include <vector>

#include "contact/surface/four_lanes.h"
#include "contact/surface/surface_contact.h"

namespace pincer::contact {

constexpr double kApart = 0.998;  // cosine of 3.6 degrees: two contacts differ by more in their normals
constexpr double kHalfApart = ConesAlong::kHalfApart;
constexpr double kLookHorizon = 1.0 / 8;  // the way for which a look holds, of its reach

struct NearPart {
  std::int32_t place;  // in the search's order
  float approach;      // [m], rounded down
  float skipped;       // the way until it need not be looked at, as far as it is known: no less [m]
};

struct NearParts {
  std::uint64_t net = 0;  // the mesh's fingerprint; 0: of none
  SurfaceLook look;       // its centre, reach and normals; the horizon is shorter than asked for where more than kMostParts are near
  std::vector<NearPart> parts;
};

// Whether `parts` are those of the look.
inline bool areOf(const NearParts& parts, std::uint64_t net, const SurfaceLook& look) {
  return parts.net == net && parts.look.p_BC == look.p_BC && parts.look.reach == look.reach && parts.look.n == look.n;
}

class SurfaceNet;
class SurfaceSearch;

// All that is near the look. Allocates nothing in a NearParts that has room.
void findNearParts(const SurfaceNet& net, const SurfaceSearch& search, const SurfaceLook& look, NearParts& found);
constexpr std::size_t kMostParts = 256;

}  // namespace pincer::contact
