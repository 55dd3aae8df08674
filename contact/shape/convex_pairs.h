// convex_pairs: contact points of two convex solids, primitives or hulls.
#pragma once
#include "pincer/contact/pair_query.h"

namespace pincer::contact {

// As collideShapes (pair_query.h), for shapes that are both convex. Allocates nothing.
void collideConvex(const Shape& a, const Pose& X_WA, const Shape& b, const Pose& X_WB, double margin,
                   const LastPoints& last, PairPoints& out);

// Of a fingertip that is the convex `core` at X_BF with a ball of radius `rounding` >= 0 [m] about it,
// with the convex `body`: points in the body's frame B, normals out of the body. `last` as
// that of collideShapes, in B. Allocates nothing.
void collidePadWithConvex(const Shape& core, double rounding, const Pose& X_BF, const Shape& body, double margin,
                          const LastPoints& last, PairPoints& out);

}  // namespace pincer::contact
