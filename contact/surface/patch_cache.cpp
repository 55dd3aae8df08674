#include "pincer/contact/surface/patch_cache.h"

#include <algorithm>
#include <bit>

#include "pincer/contact/functions/invariants.h"

namespace pincer::contact {

PatchCache::PatchCache(int cells)
    : places_(std::bit_ceil(static_cast<std::size_t>(std::max(cells, 1)))), last_(places_.size() - 1) {
  PINCER_DEMAND(cells > 0, "PatchCache: room for one patch at least");
  for (NearParts& near : parts_) near.parts.reserve(kMostParts);
}

void DeletePatchCache::operator()(PatchCache* cache) const { delete cache; }
PatchCacheHandle makePatchCache(int cells) { return PatchCacheHandle(new PatchCache(cells)); }

}  // namespace pincer::contact
