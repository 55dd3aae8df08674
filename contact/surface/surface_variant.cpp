#include "pincer/contact/surface/surface_variant.h"

#include "pincer/contact/surface/flat_contact.h"
#include "pincer/contact/surface/published_iteration.h"

namespace pincer::contact {

ShellContact followContact(SurfaceVariant variant, const SurfaceNet& net, PatchCache& cache, const Vec3& C, double r, const Foot& start) {
  switch (variant) {
    case SurfaceVariant::smooth:
      return solveShell(net, cache, C, start);
    case SurfaceVariant::facet:
    case SurfaceVariant::force:
      return followFlat(net, C, start);
    case SurfaceVariant::smooth_published:
      return followPublished(net, cache, C, r, start);
  }
  return {};
}

}  // namespace pincer::contact
