#include "pincer/engine/world/friction_shares.h"

#include <algorithm>
#include <span>

#include "pincer/engine/solve/cone.h"
#include "pincer/engine/solve/stuck_contacts.h"
#include "pincer/engine/world/stick_bias.h"

namespace pincer::engine {
namespace {

constexpr double kWorthwhile = 0.9;  // of the use, at most: shares that do as well stay, to the bit

// Of the contacts of one fingertip with one body those that push.
class Face {
 public:
  Face(std::span<const Contact> contacts, int first, WorldScratch& scratch)
      : contacts_(contacts), first_(first), scratch_(scratch) {}

  // False where they aren't a face.
  bool measure() {
    const Contact* lead = nullptr;
    bool is_face = true;
    forEachPushing([&](const Contact& c, const double* r, int rows) {
      if (!lead) lead = &c;
      is_face = is_face && rows <= kPointRows + 1 && c.n_W().dot(lead->n_W()) > kSamePlane;
      const double w = c.mu * r[kNormalRow];
      weight_ += w;
      centre_W_ += w * c.p_W;
      force_W_ += r[0] * c.R_WC.col(0) + r[1] * c.R_WC.col(1);
    });
    if (!is_face || !(weight_ > 0)) return false;
    centre_W_ /= weight_;
    double moment = 0, spread = 0;
    forEachPushing([&](const Contact& c, const double* r, int rows) {
      const Vec3 rho_W = c.p_W - centre_W_;
      const double e = rows > kTorsionRow ? radiusOf(c, kTorsionRow) : 0, w = c.mu * r[kNormalRow];
      moment +=
          c.n_W().dot(rho_W.cross(r[0] * c.R_WC.col(0) + r[1] * c.R_WC.col(1))) + (e > 0 ? e * r[kTorsionRow] : 0);
      spread += w * (rho_W.squaredNorm() + e * e);
    });
    turn_ = spread > 0 ? moment / spread : 0;
    return true;
  }

  // As a rule none is, and then nothing else need be known.
  bool isUsedUp() {
    bool is_used_up = false;
    forEachPushing([&](const Contact& c, const double* r, int rows) {
      const double enough = kStuckFrictionUsed * c.mu * r[kNormalRow];
      is_used_up = is_used_up || tangentNorm2(r, rows) > enough * enough;
    });
    return is_used_up;
  }
  // The largest use of friction, squared.
  double used2() {
    double used2 = 0;
    forEachPushing([&](const Contact& c, const double* r, int rows) { used2 = std::max(used2, usedBy(c, r, rows)); });
    return used2;
  }
  double usedByShares2() {
    double used2 = 0;
    forEachPushing([&](const Contact& c, const double* r, int rows) {
      const ContactVector shared = shareOf(c, r, rows);
      used2 = std::max(used2, usedBy(c, shared.data(), rows));
    });
    return used2;
  }
  void share() {
    forEachPushing([&](const Contact& c, double* r, int rows) {
      const ContactVector shared = shareOf(c, r, rows);
      std::copy(shared.data(), shared.data() + rows, r);
    });
  }

 private:
  template <class Act>
  void forEachPushing(const Act& act) {
    for (std::size_t i = 0; i < contacts_.size(); ++i) {
      const Contact& c = contacts_[i];
      double* const r = scratch_.r.data() + scratch_.first_row[static_cast<std::size_t>(first_) + i];
      if (r[kNormalRow] > 0 && c.mu > 0) act(c, r, rowsOf(c.material));
    }
  }

  static double usedBy(const Contact& c, const double* r, int rows) {
    const double most = c.mu * r[kNormalRow];
    return tangentNorm2(r, rows) / (most * most);
  }

  ContactVector shareOf(const Contact& c, const double* r, int rows) const {
    const double w = c.mu * r[kNormalRow];
    const Vec3 share_W = w * (force_W_ / weight_ + turn_ * c.n_W().cross(c.p_W - centre_W_));
    ContactVector shared = ContactVector::Zero();
    shared[0] = c.R_WC.col(0).dot(share_W);
    shared[1] = c.R_WC.col(1).dot(share_W);
    shared[kNormalRow] = r[kNormalRow];
    if (rows > kTorsionRow) shared[kTorsionRow] = w * radiusOf(c, kTorsionRow) * turn_;
    return shared;
  }

  const std::span<const Contact> contacts_;
  const int first_;
  WorldScratch& scratch_;
  double weight_ = 0, turn_ = 0;
  Vec3 centre_W_ = Vec3::Zero(), force_W_ = Vec3::Zero();
};

void shareOn(std::span<const Contact> contacts, int first, WorldScratch& scratch) {
  Face face(contacts, first, scratch);
  if (!face.isUsedUp() || !face.measure()) return;
  if (face.usedByShares2() < kWorthwhile * kWorthwhile * face.used2()) face.share();
}

}  // namespace

void shareFriction(WorldScratch& scratch) {
  const std::span<const Contact> contacts = scratch.contacts;
  for (std::size_t first = 0; first < contacts.size();) {
    std::size_t end = first + 1;
    while (end < contacts.size() && isOfSameTwo(contacts[first], contacts[end])) ++end;
    if (end > first + 1 && contacts[first].a.kind == SideKind::kPoint)
      shareOn(contacts.subspan(first, end - first), static_cast<int>(first), scratch);
    first = end;
  }
}

}  // namespace pincer::engine
