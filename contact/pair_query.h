// pair_query: where two bodies touch, as up to four points.
//
//   p_W  halfway between the two surfaces, n_W the unit normal out of shape b towards a,
//        phi the gap there [m] (negative: overlap)
//
// | pair | method | where |
// |---|---|---|
// | sphere and anything | nearest point; on a mesh, the smooth surface | closed_forms.h, smooth_mesh.h |
// | solid and half-space or dish | extreme points; of a mesh, the corners of its hull | extreme_points.h |
// | box, capsule, cylinder, hull with each other | least overlap, then facets laid over
// each other | separation.h, facet_overlap.h |
// | mesh and box, capsule, cylinder, hull | closest features, led to its smooth surface | mesh_pairs.h, smooth_lead.h |
// | mesh and mesh | closest features of the flat triangles | mesh_mesh.h |
// Half-spaces, dishes and other meshes feel a mesh as its corners or flat triangles: the bulge of its smooth surface
// between the corners, about e^2 k / 8 for edge length e [m] and curvature k [1/m], is not seen. (A sphere of 20 mm
// radius with edges of 5 mm sinks up to 0.16 mm deeper than its smooth surface.)
#pragma once
#include <array>
#include <cstdint>

#include "pincer/contact/math.h"
#include "pincer/contact/shape.h"
#include "pincer/contact/surface_contact.h"

namespace pincer::contact {

struct PairPoint {
  Vec3 p_W = Vec3::Zero();
  Vec3 n_W = Vec3::UnitZ();
  double phi = 0;
  // which corner, end or rim point of the pair this is: the same from tick to tick, so that solvers warm-start
  std::uint32_t feature = 0;
};

constexpr int kMaxPairPoints = 8;  // of two convex solids, or of a solid on a support, up to four

// A pair's points of the last tick, as far as the next one needs them; none: zero and 0.
struct LastPoints {
  Vec3 n_W = Vec3::Zero();  // normal of one of them
  std::array<std::uint32_t, kMaxPairPoints> features{};
  int count = 0;
  std::uint32_t carrying = 0;  // bit k: the point of features[k] pushed

  enum class Role : std::uint8_t { kNone, kKept, kCarried };  // of a point in the last tick

  void add(std::uint32_t feature, bool carried) {
    if (count == kMaxPairPoints) return;
    carrying |= static_cast<std::uint32_t>(carried) << count;
    features[static_cast<std::size_t>(count++)] = feature;
  }
  Role roleOf(std::uint32_t feature) const {
    for (int k = 0; k < count; ++k) {
      if (features[static_cast<std::size_t>(k)] == feature) return carrying >> k & 1 ? Role::kCarried : Role::kKept;
    }
    return Role::kNone;
  }
  LastPoints flipped() const { return {-n_W, features, count, carrying}; }
};

struct PairPoints {
  std::array<PairPoint, kMaxPairPoints> points;
  int count = 0;
};

// Builds now what collideShapes would build at the first touch (a mesh's flat features), so that no tick allocates.
void preparePair(const Shape& a, const Shape& b);

// The points of a and b that are closer than `margin` >= 0 [m], written to `out` (sorted by feature). Of many
// candidates the deepest are kept, then those on which the solid would land first if it rocked (point_choice.h,
// mesh_pairs.h); of a mesh's points whose gaps differ by less than 1e-6 m the one of the lowest feature counts as
// the deepest, so that it is the same from tick to tick. Every two shapes are answered for, but two supports
// (half-space, dish), which are both static, have no point. Convex pairs of one kind of shape, and two meshes, are
// symmetric in a and b to round-off; all others exactly.
// `last`: its normal, where it isn't zero, is where the search of two convex solids begins. It spares most of the
// search where the pair has hardly moved; the answer depends on it by round-off only, whatever it is, but where several
// ways out of an overlap are equally short. Of more points than are kept, those of its features stay for as long as no
// other is much better (point_choice.h). Allocates nothing; `cache` is memory only.
void collideShapes(const Shape& a, const Pose& X_WA, const Shape& b, const Pose& X_WB, double margin, PatchCache& cache,
                   PairPoints& out, const LastPoints& last = {});

// Radius of the smallest sphere about the shape's own origin that holds it [m]; infinity for HalfSpace and Dish.
double boundingRadius(const Shape& shape);

}  // namespace pincer::contact
