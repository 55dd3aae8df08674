#include "pincer/engine/world/tried_impulses.h"

#include "pincer/engine/solve/few_contacts.h"

namespace pincer::engine {

void keepTried(WorldScratch& scratch) {
  const std::size_t all = scratch.contacts.size() + scratch.sleep.contacts.size();
  if (all <= static_cast<std::size_t>(kFewContacts) || !(scratch.h > 0)) return;
  scratch.tried.clear();
  for (const Contact& c : scratch.contacts)
    scratch.tried.push_back({c.id, c.closing ? 0 : scratch.h, c.impulse_W, c.r});
}

void startFromTried(WorldScratch& scratch) {
  if (scratch.tried.empty() || !(scratch.h > 0)) return;
  auto tried = scratch.tried.begin();
  for (std::size_t i = 0; i < scratch.contacts.size(); ++i) {
    const Contact& c = scratch.contacts[i];
    while (tried != scratch.tried.end() && tried->id < c.id) ++tried;
    if (tried == scratch.tried.end()) return;
    if (tried->id != c.id) continue;
    const double scale = tried->h > 0 ? scratch.h / tried->h : 1;
    // in the same frame to the bit: what stays as it was must rest
    const bool is_same_frame = c.R_WC * tried->r.head<3>() == tried->impulse_W;
    const Vec3 impulse_C = is_same_frame ? Vec3(tried->r.head<3>()) : Vec3(c.R_WC.transpose() * tried->impulse_W);
    double* const r = scratch.r.data() + scratch.first_row[i];
    const int rows = scratch.first_row[i + 1] - scratch.first_row[i];
    for (int k = 0; k < rows; ++k) r[k] = scale * (k < kTorsionRow ? impulse_C[k] : tried->r[k]);
  }
}

}  // namespace pincer::engine
