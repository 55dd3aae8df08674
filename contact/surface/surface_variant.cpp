#include "contact/surface/surface_variant.h"

#include "contact/error.h"

namespace pincer::contact {

ShellContact followContact(SurfaceVariant variant, const SurfaceNet& net, PatchCache& cache, const Vec3& C, const Foot& start) {
  switch (variant) {
    case SurfaceVariant::smooth:
    case SurfaceVariant::facet:
    case SurfaceVariant::force:
    case SurfaceVariant::smooth_published:
      return solveShell(net, cache, C, start);
  }
  return {};
}

void requireVariant(SurfaceVariant variant, const std::string& source) {
  if (variant == SurfaceVariant::smooth) return;
  throw InputError(source + ": of the shading variants only \"smooth\" is built. Use \"smooth\".");
}

}  // namespace pincer::contact
