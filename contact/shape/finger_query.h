// finger_query: where a fingertip sphere touches a shape.
//
//   p_BS  the surface point, n_B the outward normal of the body there, both in the body's frame B
//   phi   signed gap between fingertip and surface [m]: phi = (p_BC - p_BS) . n_B - r, negative when they overlap
//
// For every shape the finger's centre lies on the normal over the surface point: p_BC = p_BS + (phi + r) n_B.
#pragma once
#include <cstdint>

#include "contact/math.h"
#include "contact/shape/shape.h"

namespace pincer::contact {

// Where the last query of one finger on one mesh ended; the next begins there. Closed forms don't use it. A plain value: part of the
// world's state, copied with snapshots. A default one means "search the whole mesh".
struct SurfaceTracker {
  std::int32_t triangle = -1;
  double u = 0, v = 0;       // barycentric coordinates of corners 1 and 2 of the triangle [-]
  std::uint32_t status = 0;  // bits of QueryStatus of the last query
};

enum QueryStatus : std::uint32_t {
  kQueryOk = 0,
  kQueryReseeded = 1u << 0,       // the warm start failed; the answer came from the tree (nothing was lost)
  kQueryHeldDirection = 1u << 1,  // no solution found: the last contact was kept. Remedy: refine or smooth the mesh there
};

struct SurfaceContact {
  Vec3 p_BS = Vec3::Zero();
  Vec3 n_B = Vec3::UnitZ();
  double phi = 0;  // [m]
};

// Contact of a sphere of radius `r` > 0 [m] centred at `p_BC` with `shape`. Total: for a centre on the medial axis of a primitive one of
// the nearest points is chosen, always the same one. Allocates nothing.
SurfaceContact querySphere(const Shape& shape, const Vec3& p_BC, double r, SurfaceTracker& tracker);

// A lower bound of phi that costs next to nothing (bounding sphere), for skipping fingers that are far away. [m]
double lowerBoundOfGap(const Shape& shape, const Vec3& p_BC, double r);

}  // namespace pincer::contact
