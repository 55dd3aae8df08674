// surface_search: places of a whole surface that a point may be in contact with, for
// starting (and guarding) the shell solver.
//
// The tree's boxes hold the patches' control nets, so a patch that bulges out of its triangle isn't missed, and each
// has a normal cone (normal_cone.h), so that only parts that may face the point are looked at: few, wherever a surface
// isn't a bowl about that point, and no more of a fine mesh than of a coarse one. A patch's cone holds its shading
// normals and its facet's, and those of sharp edges and their ends, for contact there may have any normal between their
// sides; at borders it may be any at all. An edge whose normals spread by more than 30 degrees is a part of its own,
// unless there are so many that they would double the memory: else each patch between two rims would face everything.
// Within a leaf a part is skipped by its own ball and cone, then by its flat triangle less the patch's bulge (C.
// Ericson, "Real-Time Collision Detection", 2005, section 5.1.5); what is left is evaluated over the triangle's
// closest point. Where all local minima of the distance are wanted, a triangle counts only if its closest point is one
// of the flat mesh: no neighbour leads nearer.
#pragma once
#include <array>
#include <cstdint>
#include <functional>
#include <optional>
#include <vector>

#include "pincer/contact/surface/facing_tree.h"
#include "pincer/contact/surface/flat_minimum.h"
#include "pincer/contact/surface/shell_solver.h"
#include "pincer/contact/surface/surface_net.h"

namespace pincer::contact {

struct SurfaceSeed {
  Foot foot;
  // from the point searched for to the patch at `foot` [m]: an upper bound of the distance to the surface
  double distance;
  bool found = false;  // false: nothing within the bound
};

// A patch, or a sharp edge, in single precision, rounded outwards.
struct PatchBounds {
  std::array<float, 3> centre;
  float radius;  // of a ball that holds it [m]
  float bulge;   // no point of the patch is further from the flat triangle [m]
  float hollow;  // the largest concave curvature along its edges [1/m], 0 where convex; infinity with a concave crease
  FacingTest cone;

  Vec3 middle() const { return {centre[0], centre[1], centre[2]}; }
  // True if a place of it may be nearer to `p` than `bound` and face it.
  bool mayHold(const Vec3& p, double bound, Facing facing) const;
  // How far `p` has to move at least for that, to the front [m].
  double approach(const Vec3& p, double bound) const;
};

class SurfaceSearch {
 public:
  // Looks at every patch once, and shows it to `inspector`. `progress` is told the share of the work done.
  SurfaceSearch(const SurfaceNet& net, NetInspector& inspector, const std::function<void(double)>& progress);

  // The best place nearer than `bound` [m]. Looks at 2000 patches at most, which a finger can only exceed near the
  // centre of a spherical bowl, where all places are equally near. Allocates nothing.
  SurfaceSeed nearest(const SurfaceNet& net, PatchCache& cache, const Vec3& p, double bound, Facing facing) const;

  // Calls visit(place, approach) on the patches that `p` may come to be nearer to than `reach` and to face before it
  // has moved by `horizon` > 0 [m], which may shrink meanwhile, each with how far it has to move for that at least.
  // Branches of the tree and patches whose cones are `passed` are left out. Allocates nothing.
  template <class Visit>
  void visitParts(const Vec3& p, double reach, const double& horizon, const ConesAlong& passed, Visit&& visit) const;
  PatchBounds part(std::int32_t place) const { return group(place / kLanes).at(place % kLanes); }
  double bulge(std::int32_t place) const { return group(place / kLanes).bulge[place % kLanes]; }
  // the largest [m]; 0 where round-off is all that patches differ from their triangles by
  double bulge() const { return bulge_; }
  // The place's triangle; a sharp edge's first one.
  std::int32_t triangleAt(std::int32_t place) const { return trianglesAt(place)[0]; }
  // The triangles that the place belongs to: a sharp edge's two, or twice the only one.
  std::array<std::int32_t, 2> trianglesAt(std::int32_t place) const {
    const std::int32_t item = tree_.order()[static_cast<std::size_t>(place)];
    if (item < triangles_) return {item, item};
    return edge_triangles_[static_cast<std::size_t>(item - triangles_)];
  }

  // The place of that patch's flat triangle that is nearest to `p`, if it is nearer than `reach` (less what the patch
  // bulges), `p` is in front, and no neighbour leads nearer.
  std::optional<Foot> minimumOn(const SurfaceNet& net, std::int32_t place, const Vec3& p, double reach) const;

  // How far `p` may move before it can come to face anything nearer than `reach` but the contact with the unit normal
  // `n` that it is at the height `h` over, at most `most`; 0 where that is less than `least` [m], or not known: near
  // edges, in hollows, on open surfaces (lone_contact.h). Allocates nothing.
  double wayAlone(const Vec3& p, const Vec3& n, double h, double reach, double least, double most) const;

  // True if the flat triangles hide `a` from `b`. Allocates nothing.
  bool isHidden(const SurfaceNet& net, const Vec3& a, const Vec3& b) const;

  std::size_t memoryBytes() const {
    return tree_.memoryBytes() + groups_.capacity() * sizeof(PatchGroup) +
           edge_triangles_.capacity() * sizeof(edge_triangles_[0]);
  }

 private:
  // The patches of a leaf side by side; of a lane without one the centre is at infinity.
  struct PatchGroup {
    std::array<Lanes, 3> centre;
    Lanes radius, bulge, hollow;
    LaneCones cones;

    void set(int lane, const PatchBounds& part);
    PatchBounds at(int lane) const {
      return {
          {centre[0][lane], centre[1][lane], centre[2][lane]}, radius[lane], bulge[lane], hollow[lane], cones.at(lane)};
    }
    // Which of them mayHold, after `p` has moved by less than `way` [m].
    LaneMask mayHold(const LanesPoint& p, Lanes bound, Lanes way, Facing facing) const;
  };
  void fillGroups(const std::vector<PatchBounds>& parts);
  const PatchGroup& group(std::int32_t leaf) const { return groups_[static_cast<std::size_t>(leaf)]; }

  // The tree's items are the triangles, then the sharp edges that are apart, by their two triangles.
  FacingTree tree_;
  std::int32_t triangles_ = 0;
  std::vector<std::array<std::int32_t, 2>> edge_triangles_;
  std::vector<PatchGroup> groups_;  // of the tree's leaves
  bool is_closed_ = false;
  double bulge_ = 0;
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

inline LaneMask SurfaceSearch::PatchGroup::mayHold(const LanesPoint& p, Lanes bound, Lanes way, Facing facing) const {
  Lanes centre2{}, along{};
  for (std::size_t k = 0; k < 3; ++k) {
    const Lanes D = p.x[k] - centre[k];
    centre2 += D * D;
    along += cones.axis[k] * D;
  }
  const Lanes R = radius + way, outer = bound + R;
  LaneMask may_face = cones.mayFace(along, centre2, R);
  if (facing == Facing::both) may_face |= cones.mayFace(-along, centre2, R);
  return may_face & (centre2 < outer * outer);
}

template <class Visit>
void SurfaceSearch::visitParts(const Vec3& p, double reach, const double& horizon, const ConesAlong& passed,
                               Visit&& visit) const {
  const LanesPoint x(p);
  const double rounded = tree_.rounding(p);
  tree_.visitNear(p, reach, horizon, passed, [&](std::int32_t leaf) {
    const PatchGroup& patches = group(leaf);
    const Lanes way = LanesPoint::toLanes(horizon + rounded);
    const LaneMask is_near =
        patches.mayHold(x, LanesPoint::toLanes(reach), way, Facing::front) & ~passed.hold(patches.cones);
    for (int lane = 0; lane < kLanes; ++lane) {
      if (!is_near[lane]) continue;
      const double approach = patches.at(lane).approach(p, reach);
      if (approach < horizon) visit(kLanes * leaf + lane, approach);
    }
  });
}

}  // namespace pincer::contact
