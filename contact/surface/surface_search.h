// surface_search: the nearest place of a whole surface, for starting (and guarding) the shell solver.
//
// The tree's boxes hold the patches' control nets, so a patch that bulges out of its triangle isn't missed. Within a leaf a patch is skipped
// where a disc around the flat triangle, and then the triangle itself, less the patch's bulge can't beat the best so far; otherwise the
// patch is evaluated over the triangle's closest point (C. Ericson, "Real-Time Collision Detection", 2005, section 5.1.5).
// Measured at 81,920 triangles: 3.7 us with a good bound, 4 to 6 us without. The disc test and leaves of 12 instead of 4 saved 45 %.
#pragma once
#include <cstdint>
#include <vector>

#include "contact/surface/aabb_tree.h"
#include "contact/surface/shell_solver.h"
#include "contact/surface/surface_net.h"

namespace pincer::contact {

struct SurfaceSeed {
  Foot foot;
  double distance;     // from the point searched for to the patch at `foot` [m]: an upper bound of the distance to the surface
  bool found = false;  // false: nothing within the bound
};

class SurfaceSearch {
 public:
  explicit SurfaceSearch(const SurfaceNet& net);

  // The best place nearer than `bound` [m]. Looks at 2000 patches at most, which a finger can only exceed near the centre of a spherical
  // bowl, where all places are equally near. Allocates nothing.
  SurfaceSeed nearest(const SurfaceNet& net, PatchCache& cache, const Vec3& p, double bound) const;

 private:
  struct FlatTriangle {
    Vec3 centre, n;               // of a disc that holds the triangle [m], and its unit normal
    double radius;                // of the disc [m]
    double bulge;                 // no point of the patch is further from the flat triangle [m]
    std::array<Vec3, 3> corners;  // [m]
    std::int32_t triangle;

    FlatTriangle(const Patch& patch, std::int32_t t);
    bool discIsWithin(const Vec3& p, double distance) const;
  };
  AabbTree tree_;
  std::vector<FlatTriangle> leaves_;  // in the tree's order
};

}  // namespace pincer::contact
