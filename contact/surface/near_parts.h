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
// Each part has its own `due`: until then it can't matter, so a tick looks at those only that are due.
//
// All of this is scratch: the parts are a function of mesh and look, and what isn't due would be found not to matter.
// So no answer depends on what is due when, nor on whether the list had to be made anew.
#pragma once
#include <algorithm>
#include <cstdint>
#include <vector>

#include "pincer/contact/surface/tolerances.h"
#include "pincer/contact/surface_contact.h"

namespace pincer::contact {

constexpr std::size_t kMostParts = 512;  // of a list; a full one keeps its nearer half

struct NearPart {
  std::int32_t place;  // in the search's order
  double due;          // the way from the look on at which it may matter, no later [m]
};

// Of one finger.
struct NearParts {
  std::uint64_t net = 0;  // the mesh's fingerprint; 0: of none
  // its centre, reach and normals; the horizon is shorter than asked for where more than kMostParts are near
  SurfaceLook look;
  std::vector<NearPart> parts;  // by place, as the tree has them
  // the way since the look, and how far the reach has grown [m]; to where
  double gone = 0;
  Vec3 p_BC = Vec3::Zero();
  double reach = 0;

  // True if they are those of that look.
  bool areOf(std::uint64_t mesh, const SurfaceLook& other) const {
    return net == mesh && look.p_BC == other.p_BC && look.reach == other.reach && look.n == other.n;
  }
  void advance(const Vec3& to, double reach_there) {
    gone += (to - p_BC).norm() + std::max(0.0, reach_there - reach);
    p_BC = to;
    reach = reach_there;
  }
};

class SurfaceNet;
class SurfaceSearch;

// Lists the parts of a look. Allocates nothing in a NearParts that has room.
void listNearParts(const SurfaceNet& net, const SurfaceSearch& search, const SurfaceLook& look, NearParts& found);

}  // namespace pincer::contact
