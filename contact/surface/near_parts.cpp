#include "contact/surface/near_parts.h"

#include <algorithm>
#include <array>

#include "contact/surface/outward_float.h"
#include "contact/surface/surface_search.h"

namespace pincer::contact {

namespace {

constexpr double kAtOnce = 1e-300;  // a horizon that only what matters now is within [m]

// A type of its own, so that sorting calls no function.
struct ComesFirst {
  bool operator()(const NearPart& a, const NearPart& b) const {
    return a.approach < b.approach || (a.approach == b.approach && a.place < b.place);
  }
};

// Keeps the nearer half, and what is as near as its last; the horizon is where the others begin.
void halve(NearParts& found) {
  std::sort(found.parts.begin(), found.parts.end(), ComesFirst());
  found.look.horizon = found.parts[kMostParts / 2].approach;
  const auto end =
      std::find_if(found.parts.begin(), found.parts.end(), [&](const NearPart& p) { return !(p.approach < found.look.horizon); });
  found.parts.erase(end, found.parts.end());
}

// Where too many parts matter at once (near the middle of a bowl): those where the flat mesh is nearest among its neighbours, vouched for at this place alone.
void keepMinima(const SurfaceNet& net, const SurfaceSearch& search, double gone_at_look, NearParts& found) {
  found.look.horizon = 0;
  search.visitParts(found.look.p_BC, found.look.reach, kAtOnce, {}, [&](std::int32_t place, double) {
    if (found.parts.size() < kMostParts && search.minimumOn(net, place, found.look.p_BC, found.look.reach))
      found.parts.push_back({place, 0, gone_at_look});
  });
}

// Parts by their places: a hash table half full at most.
class PlaceIndex {
 public:
  explicit PlaceIndex(const std::vector<NearPart>& parts) : parts_(parts) {
    for (std::size_t i = 0; i < parts.size(); ++i) {
      std::size_t k = static_cast<std::size_t>(parts[i].place) % kSize;
      while (number_[k] != 0) k = (k + 1) % kSize;
      number_[k] = static_cast<std::uint16_t>(i + 1);
    }
  }
  const NearPart* find(std::int32_t place) const {
    for (std::size_t k = static_cast<std::size_t>(place) % kSize; number_[k] != 0; k = (k + 1) % kSize) {
      const NearPart& part = parts_[number_[k] - 1u];
      if (part.place == place) return &part;
    }
    return nullptr;
  }

 private:
  static constexpr std::size_t kSize = 2 * kMostParts;
  const std::vector<NearPart>& parts_;
  std::array<std::uint16_t, kSize> number_{};  // of a part, from 1; 0: none
};

}  // namespace

void beginNearParts(const SurfaceNet& net, const SurfaceLook& look, NearParts& found) {
  found.net = net.fingerprint();
  found.look = look;
  found.look.horizon = kLookHorizon * look.reach;
  found.parts.clear();
  found.due = 0;
  found.walk = {};
  found.is_whole = false;
}

void continueNearParts(const SurfaceNet& net, const SurfaceSearch& search, double gone_at_look, int most, NearParts& found) {
  if (found.is_whole) return;
  const SurfaceLook& look = found.look;
  const ConesAlong passed(look.n);
  search.walkParts(look.p_BC, look.reach, found.look.horizon, passed, found.walk, most, [&](std::int32_t place, double approach) {
    if (found.parts.size() == kMostParts) halve(found);
    const float rounded = below(approach);
    if (approach < found.look.horizon) found.parts.push_back({place, rounded, gone_at_look + rounded});
  });
  if (!found.walk.isOver()) return;
  std::sort(found.parts.begin(), found.parts.end(), ComesFirst());
  if (!(found.look.horizon > 0)) keepMinima(net, search, gone_at_look, found);
  found.is_whole = true;
}

void forgetDues(double gone_at_look, NearParts& parts) {
  for (NearPart& part : parts.parts) part.due = gone_at_look + part.approach;
  parts.due = 0;
}

void takeDues(const NearParts& from, NearParts& to) {
  if (from.net != to.net) return;
  const PlaceIndex index(from.parts);
  for (NearPart& part : to.parts) {
    if (const NearPart* known = index.find(part.place)) part.due = std::max(part.due, known->due);
  }
  to.due = 0;
}

}  // namespace pincer::contact
