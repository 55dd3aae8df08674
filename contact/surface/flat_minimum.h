// flat_minimum: the place of a flat triangle nearest to a point, and whether
// the whole flat mesh is no nearer around it.
//
// A smooth surface's local minima of the distance lie near those of its triangles; these take a few products to find
// and no patch. Source of the closest point: C. Ericson, "Real-Time Collision Detection", 2005, section 5.1.5.
#pragma once
#include <array>

#include "pincer/contact/surface/surface_net.h"

namespace pincer::contact {

struct FlatPoint {
  std::array<double, 3> b;  // barycentric coordinates; exactly 0 for the corners that have no part in it
  double distance2;         // [m^2]
};

FlatPoint closestOnTriangle(const Vec3& a, const Vec3& b, const Vec3& c, const Vec3& p);
FlatPoint closestOnFacet(const SurfaceNet& net, std::int32_t triangle, const Vec3& p);

// True if no triangle beside this place leads nearer to `p`, and `p` is in front of
// it. `flat` is the triangle's closest point.
bool isFlatMinimum(const SurfaceNet& net, std::int32_t triangle, const FlatPoint& flat, const Vec3& p);

}  // namespace pincer::contact
