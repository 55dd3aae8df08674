// patch_cache: working memory for the patches that a query touches, and for those that a finger
// may come to touch, built when first needed.
//
// Direct-mapped: a triangle has one place, and takes it from whoever was there. A cell is a pure function of its
// mesh, and near parts of mesh and look, so no result depends on what a cache holds; several meshes may share one.
// Belongs to a scratch: one thread at a time.
#pragma once
#include <array>
#include <cstdint>
#include <vector>

#include "pincer/contact/surface/near_parts.h"
#include "pincer/contact/surface/surface_cell.h"

namespace pincer::contact {

class PatchCache {
 public:
  // Room for `cells` > 0 patches, rounded up to a power of two, about half a kilobyte each. A finger needs some dozens.
  explicit PatchCache(int cells = 1024);

  struct Place {
    std::uint64_t net = 0;       // the mesh's fingerprint
    std::int32_t triangle = -1;  // -1: empty
    SurfaceCell cell;
  };
  Place& placeOf(std::uint64_t net, std::int32_t triangle) {
    return places_[(static_cast<std::uint64_t>(triangle) ^ net) & last_];
  }

  // The place for what is near a finger.
  NearParts& partsOf(const SurfaceTracker& tracker) { return parts_[tracker.memory % parts_.size()]; }

 private:
  std::vector<Place> places_;
  std::uint64_t last_;               // place
  std::array<NearParts, 31> parts_;  // a prime, so that fingers of equally many memories have different ones
};

}  // namespace pincer::contact
