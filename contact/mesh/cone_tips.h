// cone_tips: vertices that are the tip of a round cone: no edge there is sharp, yet the surface has no tangent plane.
//
//   rulings g_i of a cone of half angle alpha about a:  g_i . a = -cos(alpha)
//   found by least squares:  g_i . y = -1,  a = y / |y|
//   the ball of radius rho in it:  centre c = p - rho a / sin(alpha),  touched on ruling i at  p + rho g_i / tan(alpha)
//
//   p  tip [m], g_i  unit direction to neighbour i [-]; frame B
// A vertex of a coarse ball looks much the same; it isn't a tip, since the shading normals at its neighbours
// aren't at right angles to the way there.
#pragma once
#include <cstdint>
#include <optional>
#include <vector>

#include "pincer/contact/mesh/connectivity.h"
#include "pincer/contact/triangle_mesh.h"

namespace pincer::contact {

struct ConeTip {
  Vec3 axis;        // away from the rulings
  double sin, cos;  // of alpha
  double s;         // +1: the solid is inside the cone, -1: outside (a pit)
  Vec3 touch(const Vec3& ruling) const { return cos / sin * ruling; }  // (place - p) / rho
  Vec3 centre() const { return -axis / sin; }                          // (c - p) / rho
};

// `corners_at`: the corners 3 t + i at the vertex. Empty unless the tip's facets lean by more than
// `least_lean` [rad] from its tangent plane.
std::optional<ConeTip> findConeTip(const TriangleMesh& mesh, const CornerNormals& corners,
                                   const std::vector<std::int32_t>& corners_at, double least_lean);

}  // namespace pincer::contact
