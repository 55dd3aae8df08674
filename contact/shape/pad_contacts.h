// pad_contacts: where a fingertip with flat faces or a straight side touches a shape, as a patch of up to four points.
//
//   tip = K + ball(rho)        K the hull of a pad's points or a capsule's segment, rho its rounding (finger_shape.h)
//
// The facet of K that faces the body and the body's own are laid over each other as those of two bodies are
// (facet_overlap.h), with gaps that are less by rho: tilt and torsion follow from the points. Points are named by
// corners and edges of the two, and stay while these touch. A capsule touches convex bodies so, as one of them does:
// along a wall or an edge that is shorter than the tip with both of its ends. Elsewhere its own ends do.
//
// | body | points | where |
// |---|---|---|
// | box, capsule, cylinder, hull | facets laid over each other | convex_pairs.h |
// | half-space, dish | the pad's extreme points | pair_query.h |
// | mesh | its flat triangles' features (up to eight), see padOnMesh | mesh_pairs.h |
// | sphere | none: one nearest point is all there is | finger_query.h |
#pragma once
#include "pincer/contact/finger_shape.h"
#include "pincer/contact/pair_query.h"

namespace pincer::contact {

// A capsule's points, as padOnShape's; none where the body isn't convex.
void capsuleOnShape(const CapsuleTip& capsule, const Pose& X_BF, const Shape& body, double margin, const Vec3& last_n_B,
                    PairPoints& out);

// The points nearer than `margin` >= 0 [m], in the body's frame B, normals out of the body, sorted by
// feature; none for spheres. `last_n_B`: a normal of the last ones, or zero: where the search begins.
// Allocates nothing once a mesh's features are built.
void padOnShape(const PadTip& pad, const Pose& X_BF, const Shape& body, double margin, const Vec3& last_n_B,
                PatchCache& cache, PairPoints& out);

}  // namespace pincer::contact
