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
  FacingTest cone;

  Vec3 middle() const { return {centre[0], centre[1], centre[2]}; }
  // Whether a place of it may be nearer to `p` than `bound` and face it or a point within `around`.
  bool mayHold(const Vec3& p, double bound, double around, Facing facing) const;
};

class SurfaceSearch {
 public:
  // Looks at every patch once, and shows it to `inspector`. `progress` is told the share of the work done.
  SurfaceSearch(const SurfaceNet& net, NetInspector& inspector, const std::function<void(double)>& progress);

  // The best place nearer than `bound` [m]. Looks at 2000 patches at most, which a finger can only exceed near the centre of a spherical
  // bowl, where all places are equally near. Allocates nothing.
  SurfaceSeed nearest(const SurfaceNet& net, PatchCache& cache, const Vec3& p, double bound, Facing facing) const;

  // Calls visit(foot) on the places nearer to `p` than `bound` [m] where the flat triangles' distance from it is least among their
  // neighbours', with `p` in front; nearer leaves first, until it returns false. Patches with `is_known(triangle, part)` are passed over.
  // Returns whether there is nothing else: whether each patch that is nearer than bound + around and may face a point within `around` [m]
  // of `p` is known. Allocates nothing.
  template <class IsKnown, class Visit>
  bool visitMinima(const SurfaceNet& net, const Vec3& p, double bound, double around, IsKnown&& is_known, Visit&& visit) const;

  // Whether the flat triangles hide `a` from `b`. Allocates nothing.
  bool isHidden(const SurfaceNet& net, const Vec3& a, const Vec3& b) const;

  std::size_t memoryBytes() const { return tree_.memoryBytes() + leaves_.capacity() * sizeof(Leaf); }

 private:
  using Leaf = PatchBounds;
  const Leaf& leaf(std::int32_t place) const { return leaves_[static_cast<std::size_t>(place)]; }
  std::int32_t triangleAt(std::int32_t place) const { return tree_.order()[static_cast<std::size_t>(place)]; }

  FacingTree tree_;
  std::vector<Leaf> leaves_;  // in the tree's order
};

inline bool PatchBounds::mayHold(const Vec3& p, double bound, double around, Facing facing) const {
  double centre2 = 0, along = 0;
  for (std::size_t k = 0; k < 3; ++k) {
    const double D = p[static_cast<int>(k)] - centre[k];
    centre2 += D * D;
    along += cone.axis[k] * D;
  }
  const double reach = bound + radius, R = radius + around;
  if (centre2 >= reach * reach) return false;
  return cone.mayFace(along, centre2, R) || (facing == Facing::both && cone.mayFace(-along, centre2, R));
}

template <class IsKnown, class Visit>
bool SurfaceSearch::visitMinima(const SurfaceNet& net, const Vec3& p, double bound, double around, IsKnown&& is_known,
                                Visit&& visit) const {
  const double outer = bound + around, outer2 = outer * outer;
  bool is_all = true;
  tree_.visitFacing(p, outer2, around, Facing::front, [&](std::int32_t place) {
    const Leaf& at = leaf(place);
    if (!at.mayHold(p, outer, around, Facing::front)) return true;
    const std::int32_t triangle = triangleAt(place);
    if (is_known(triangle, at)) return true;
    const FlatPoint flat = closestOnFacet(net, triangle, p);
    const double reach = bound + at.bulge, outer_reach = outer + at.bulge;
    if (flat.distance2 >= outer_reach * outer_reach) return true;
    is_all = false;
    if (flat.distance2 >= reach * reach || !isFlatMinimum(net, triangle, flat, p)) return true;
    return visit(Foot{triangle, flat.b});
  });
  return is_all;
}

}  // namespace pincer::contact
