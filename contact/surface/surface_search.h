// surface_search: places of a whole surface that a point may be in contact with, for starting (and guarding) the shell solver.
//
// The tree's boxes hold the patches' control nets, so a patch that bulges out of its triangle isn't missed, and each has a normal cone
// (normal_cone.h), so that only parts that may face the point are looked at: few, wherever a surface isn't a bowl about that point, and
// no more of a fine mesh than of a coarse one. A cone holds the patch's shading normals and its facet's; along sharp edges and at their
// ends also the other sides', for there the contact's normal may be any between them; at borders it may be any at all.
// Within a leaf a patch is skipped by its own ball and cone, then by its flat triangle less the patch's bulge (C. Ericson, "Real-Time
// Collision Detection", 2005, section 5.1.5); what is left is evaluated over the triangle's closest point. Where all local minima of the
// distance are wanted, a triangle counts only if its closest point is one of the flat mesh: no neighbour leads nearer.
#pragma once
#include <cstdint>
#include <functional>
#include <optional>
#include <vector>

#include "contact/surface/facing_tree.h"
#include "contact/surface/flat_minimum.h"
#include "contact/surface/shell_solver.h"
#include "contact/surface/surface_net.h"

namespace pincer::contact {

struct SurfaceSeed {
  Foot foot;
  double distance;     // from the point searched for to the patch at `foot` [m]: an upper bound of the distance to the surface
  bool found = false;  // false: nothing within the bound
};

// A patch in single precision, rounded outwards.
struct PatchBounds {
  std::array<float, 3> centre;
  float radius;  // of a ball that holds the patch [m]
  float bulge;   // no point of the patch is further from the flat triangle [m]
  float hollow;  // the largest concave curvature along its edges [1/m], 0 where convex; infinity with a concave crease
  FacingTest cone;

  Vec3 middle() const { return {centre[0], centre[1], centre[2]}; }
  // Whether a place of it may be nearer to `p` than `bound` and face it.
  bool mayHold(const Vec3& p, double bound, Facing facing) const;
  // How far `p` has to move at least for that, to the front [m].
  double approach(const Vec3& p, double bound) const;
};

class SurfaceSearch {
 public:
  // Looks at every patch once, and shows it to `inspector`. `progress` is told the share of the work done.
  SurfaceSearch(const SurfaceNet& net, NetInspector& inspector, const std::function<void(double)>& progress);

  // The best place nearer than `bound` [m]. Looks at 2000 patches at most, which a finger can only exceed near the centre of a spherical
  // bowl, where all places are equally near. Allocates nothing.
  SurfaceSeed nearest(const SurfaceNet& net, PatchCache& cache, const Vec3& p, double bound, Facing facing) const;

  // Calls visit(place, approach) on the patches that `p` may come to be nearer to than `reach` and to face before it has moved by `horizon` > 0
  // [m], which may shrink meanwhile, each with how far it has to move for that at least. Branches of the tree and patches for whose cone
  // isPassed(cone) are left out. Allocates nothing.
  template <class IsPassed, class Visit>
  void visitParts(const Vec3& p, double reach, const double& horizon, IsPassed&& isPassed, Visit&& visit) const;
  const PatchBounds& part(std::int32_t place) const { return leaves_[static_cast<std::size_t>(place)]; }
  std::int32_t triangleAt(std::int32_t place) const { return tree_.order()[static_cast<std::size_t>(place)]; }

  // The place of that patch's flat triangle that is nearest to `p`, if it is nearer than `reach` (less what the patch bulges), `p` is in
  // front, and no neighbour leads nearer.
  std::optional<Foot> minimumOn(const SurfaceNet& net, std::int32_t place, const Vec3& p, double reach) const;

  // How far `p` has to move at least until there is one, rounded down [m].
  float wayToMinimumOn(const SurfaceNet& net, std::int32_t place, const Vec3& p, double reach) const;

  // Whether the flat triangles hide `a` from `b`. Allocates nothing.
  bool isHidden(const SurfaceNet& net, const Vec3& a, const Vec3& b) const;

  std::size_t memoryBytes() const { return tree_.memoryBytes() + leaves_.capacity() * sizeof(Leaf); }

 private:
  using Leaf = PatchBounds;
  FacingTree tree_;
  std::vector<Leaf> leaves_;  // in the tree's order
};

inline bool PatchBounds::mayHold(const Vec3& p, double bound, Facing facing) const {
  double centre2 = 0, along = 0;
  for (std::size_t k = 0; k < 3; ++k) {
    const double D = p[static_cast<int>(k)] - centre[k];
    centre2 += D * D;
    along += cone.axis[k] * D;
  }
  const double reach = bound + radius;
  if (centre2 >= reach * reach) return false;
  return cone.mayFace(along, centre2, radius) || (facing == Facing::both && cone.mayFace(-along, centre2, radius));
}

inline double PatchBounds::approach(const Vec3& p, double bound) const {
  double centre2 = 0, along = 0;
  for (std::size_t k = 0; k < 3; ++k) {
    const double D = p[static_cast<int>(k)] - centre[k];
    centre2 += D * D;
    along += cone.axis[k] * D;
  }
  return std::max(cone.approach(along, centre2, radius), std::sqrt(centre2) - radius - bound);
}

template <class IsPassed, class Visit>
void SurfaceSearch::visitParts(const Vec3& p, double reach, const double& horizon, IsPassed&& isPassed, Visit&& visit) const {
  tree_.visitNear(p, reach, horizon, isPassed, [&](std::int32_t place) {
    const Leaf& at = part(place);
    const double approach = at.approach(p, reach);
    if (approach < horizon && !isPassed(at.cone)) visit(place, approach);
  });
}

}  // namespace pincer::contact
