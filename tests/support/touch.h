// touch: the main contact of a finger on a mesh, for tests that need no other; with a cache per thread.
#pragma once
#include "pincer/contact/smooth_mesh.h"
#include "pincer/contact/surface/patch_cache.h"

namespace pincer::contact {

inline SurfaceContact touch(const SmoothMesh& mesh, const Vec3& p_BC, double r, SurfaceTracker& tracker) {
  thread_local PatchCache cache(256);
  return mesh.querySphere(p_BC, r, 0, tracker, cache).main();
}

}  // namespace pincer::contact
