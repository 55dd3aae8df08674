// surface_contact: what a query of a fingertip on a surface answers, and what it remembers for the next one.
#pragma once
#include <cstdint>

#include "contact/math.h"

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

}  // namespace pincer::contact
