#include "contact/surface/near_parts.h"

#include <algorithm>

#include "contact/surface/outward_float.h"
#include "contact/surface/surface_search.h"

namespace pincer::contact {

namespace {

constexpr double kAtOnce = 1e-300;  // a horizon that only what matters now is within [m]

bool comesFirst(const NearPart& a, const NearPart& b) { return a.approach < b.approach || (a.approach == b.approach && a.place < b.place); }

// Keeps the nearer half, and what is as near as its last; the horizon is where the others begin.
void halve(NearParts& found) {
  std::sort(found.parts.begin(), found.parts.end(), comesFirst);
  found.look.horizon = found.parts[kMostParts / 2].approach;
  const auto end =
      std::find_if(found.parts.begin(), found.parts.end(), [&](const NearPart& p) { return !(p.approach < found.look.horizon); });
  found.parts.erase(end, found.parts.end());
}

// Where too many parts matter at once (near the middle of a bowl): those where the flat mesh is nearest among its neighbours, vouched for at this place alone.
void keepMinima(const SurfaceNet& net, const SurfaceSearch& search, NearParts& found) {
  found.look.horizon = 0;
  search.visitParts(found.look.p_BC, found.look.reach, kAtOnce, {}, [&](std::int32_t place, double) {
    if (found.parts.size() < kMostParts && search.minimumOn(net, place, found.look.p_BC, found.look.reach))
      found.parts.push_back({place, 0, 0});
  });
}

}  // namespace

void findNearParts(const SurfaceNet& net, const SurfaceSearch& search, const SurfaceLook& look, NearParts& found) {
  found.net = net.fingerprint();
  found.look = look;
  found.look.horizon = kLookHorizon * look.reach;
  found.parts.clear();
  const ConesAlong passed(look.n);
  search.visitParts(look.p_BC, look.reach, found.look.horizon, passed, [&](std::int32_t place, double approach) {
    if (found.parts.size() == kMostParts) halve(found);
    const float rounded = below(approach);
    if (approach < found.look.horizon) found.parts.push_back({place, rounded, rounded});
  });
  std::sort(found.parts.begin(), found.parts.end(), comesFirst);
  if (!(found.look.horizon > 0)) keepMinima(net, search, found);
}

}  // namespace pincer::contact
