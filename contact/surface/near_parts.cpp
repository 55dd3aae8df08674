#include "pincer/contact/surface/near_parts.h"

#include <algorithm>
#include <array>

#include "pincer/contact/functions/invariants.h"
#include "pincer/contact/surface/outward_float.h"
#include "pincer/contact/surface/surface_search.h"

namespace pincer::contact {

namespace {

constexpr double kAtOnce = 1e-300;  // a horizon that only what matters now is within [m]

// Keeps the nearer half; the horizon is where the others begin.
void halve(NearParts& found) {
  std::array<double, kMostParts> approaches;
  std::transform(found.parts.begin(), found.parts.end(), approaches.begin(), [](const NearPart& p) { return p.due; });
  const auto middle = approaches.begin() + kMostParts / 2;
  std::nth_element(approaches.begin(), middle, approaches.end());
  found.look.horizon = *middle;
  std::erase_if(found.parts, [&](const NearPart& p) { return !(p.due < found.look.horizon); });
}

// Where too many parts matter at once (near the middle of a bowl): those where the flat mesh is nearest among its
// neighbours, vouched for at this place alone.
void keepMinima(const SurfaceNet& net, const SurfaceSearch& search, NearParts& found) {
  found.look.horizon = 0;
  search.visitParts(found.look.p_BC, found.look.reach, kAtOnce, {}, [&](std::int32_t place, double) {
    if (found.parts.size() < kMostParts && search.minimumOn(net, place, found.look.p_BC, found.look.reach))
      found.parts.push_back({place, 0});
  });
}

}  // namespace

void listNearParts(const SurfaceNet& net, const SurfaceSearch& search, const SurfaceLook& look, NearParts& found) {
  PINCER_ASSERT(!(look.reach <= 0));
  found.net = net.fingerprint();
  found.look = look;
  found.look.horizon = kLookHorizon * look.reach;
  found.parts.clear();
  found.gone = 0;
  found.p_BC = look.p_BC;
  found.reach = look.reach;
  search.visitParts(look.p_BC, look.reach, found.look.horizon, ConesAlong(look.n),
                    [&](std::int32_t place, double approach) {
                      if (found.parts.size() == kMostParts) halve(found);
                      PINCER_ASSERT(found.parts.size() < found.parts.capacity());  // the tick allocates nothing
                      if (approach < found.look.horizon) found.parts.push_back({place, below(approach)});
                    });
  if (!(found.look.horizon > 0)) keepMinima(net, search, found);
}

}  // namespace pincer::contact
