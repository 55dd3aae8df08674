// convex_pairs: contact points of two convex solids, primitives or hulls.
#pragma once
#include "pincer/contact/pair_query.h"

namespace pincer::contact {

// As collideShapes (pair_query.h), for shapes that are both convex. Allocates nothing.
void collideConvex(const Shape& a, const Pose& X_WA, const Shape& b, const Pose& X_WB, double margin, const Vec3& last_n_W,
                   PairPoints& out);

}  // namespace pincer::contact
