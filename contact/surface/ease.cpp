#include "pincer/contact/surface/ease.h"

#include "pincer/contact/surface/tolerances.h"

namespace pincer::contact {

void EasedContacts::moveOn(int slot, const ShellContact& contact) {
  const SurfaceSlot& before = kept(slot);
  const bool continued = contact.converged && continues(before, contact);
  if (continued && !isListed(contact)) {
    had_contacts_ = true;
    return keep(slot, contact);
  }
  lose(slot);
  const bool is_behind = !(contact.h > 0 || heightBefore(before) <= 0);  // none slides to behind the surface
  if (contact.converged && !continued && !is_behind) slid_.push_back(contact);
}

void EasedContacts::lose(int slot) {
  had_contacts_ = true;
  lost_.push_back(slot);
}

void EasedContacts::settle() {
  for (const ShellContact& contact : slid_) {
    if (!isListed(contact) && hasFreeSlot()) addNew(contact);
  }
}

ShellContact EasedContacts::onItsSide(const SurfaceSlot& kept, const ShellContact& contact) const {
  if (contact.foot.isOnFace() || !contact.converged || !(contact.h < 0 && heightBefore(kept) > 0)) return contact;
  ShellContact turned = contact;
  turned.n = -contact.n;
  turned.h = -contact.h;
  return continues(kept, turned) ? turned : contact;
}

// Around an edge the overlap d changes by d / h of the centre's way at most, on anything rounder and in any hollow that
// the finger fits into by less, straight down by all of it.
bool EasedContacts::continues(const SurfaceSlot& kept, const ShellContact& contact) const {
  constexpr double kSlack = 2;     // for shading normals, which turn faster than the surface here and there
  constexpr double kMostTurn = 5;  // of d / h, which has no bound where the centre comes to the surface
  constexpr double kStill = 1e-5;  // of r
  if (!ball_.eases) return true;
  const double before = std::max(0.0, ball_.r - heightBefore(kept)), now = std::max(0.0, ball_.r - contact.h);
  const double turn = now < kMostTurn * contact.h ? std::max(1.0, now / contact.h) : kMostTurn;
  return (now * contact.n - before * kept.n_B).norm() <= kSlack * turn * ball_.moved + kStill * ball_.r;
}

bool EasedContacts::isListed(const ShellContact& contact) const {
  return isAny([&](const FollowedContact& other) {
    return (ball_.placeOf(other.contact) - ball_.placeOf(contact)).norm() < kOnePlace * ball_.r;
  });
}

double EasedContacts::nearestHeight() const {
  double h = kInfinity;
  for (const FollowedContact& f : list_) h = f.fades ? h : std::min(h, f.contact.h);
  return h;
}

double EasedContacts::heightToYield() const {
  double highest = 0;
  for (const FollowedContact& f : list_) highest = mayYield(f) ? std::max(highest, f.contact.h) : highest;
  return highest;
}

// Its overlap begins at zero, but for the way that the finger can have come closer.
void EasedContacts::addNew(const ShellContact& contact) {
  list_.push_back({contact, takeSlot(), true, false, easeOfNew(contact)});
}

double EasedContacts::easeOfNew(const ShellContact& contact) const {
  return ball_.eases && had_contacts_ ? std::max(0.0, ball_.r - contact.h - ball_.moved) : 0;
}

// The walls of a hole hardly wider than the finger leave room for its floor.
void EasedContacts::admit(const ShellContact& contact) {
  if (!list_.isFull()) return addNew(contact);
  FollowedContact* highest = nullptr;
  for (FollowedContact& other : list_) {
    const bool may_go = mayYield(other) && other.contact.h > contact.h + (other.is_new ? 0 : kOnePlace * ball_.r);
    if (may_go && (!highest || other.contact.h > highest->contact.h)) highest = &other;
  }
  if (highest) *highest = {contact, highest->slot, true, false, easeOfNew(contact)};
}

void EasedContacts::admitNearest(const ShellContact& contact) {
  if (list_.isFull()) list_.pop_back();
  addNew(contact);
}

ShellContact EasedContacts::planeOf(int slot) const {
  const SurfaceSlot& plane = kept(slot);
  return {footOf(plane), plane.n_B, (ball_.C - plane.p_BS).dot(plane.n_B), false, {}};
}

int EasedContacts::deepestLost() const {
  return *std::min_element(lost_.begin(), lost_.end(), [&](int a, int b) { return heightOfLost(a) < heightOfLost(b); });
}

void EasedContacts::fadeLost() {
  if (!ball_.eases) return;
  for (const int slot : lost_) {
    if (list_.isFull()) return;
    if (isTaken(slot)) continue;
    const FollowedContact plane{planeOf(slot), slot, false, true, kept(slot).ease + ball_.moved};
    if (plane.shown() < ball_.r) list_.push_back(plane);
  }
}

bool EasedContacts::isTaken(int slot) const {
  return std::any_of(list_.begin(), list_.end(), [&](const FollowedContact& f) { return f.slot == slot; });
}

// True if a slot that was lost still pushes, and nothing has taken it.
bool EasedContacts::isFading(int slot) const {
  return std::find(lost_.begin(), lost_.end(), slot) != lost_.end() && !isTaken(slot) && pushes(slot);
}

// One in which nothing is followed nor fades; -1 without.
int EasedContacts::spareSlot() const {
  for (int slot = 0; slot < kMaxSurfaceContacts; ++slot) {
    if (!isTaken(slot) && !isFading(slot)) return slot;
  }
  return -1;
}

bool EasedContacts::hasFreeSlot() const {
  return spareSlot() >= 0 || std::count_if(lost_.begin(), lost_.end(), [&](int slot) { return isFading(slot); }) > 1;
}

// For a new contact. Without a spare one, two that fade are joined: one plane pushes as both did.
int EasedContacts::takeSlot() {
  if (const int spare = spareSlot(); spare >= 0) return spare;
  int slot = -1, other = -1;
  for (const int lost : lost_) {
    if (!isFading(lost)) continue;
    other = slot;
    slot = lost;
  }
  if (other >= 0) join(other, slot);
  return slot;
}

// The other one pushes no more, whatever becomes of the contact that it makes room for.
void EasedContacts::join(int slot, int other) {
  const double r = ball_.r;
  const Vec3 push = (r - heightOfLost(slot)) * kept(slot).n_B + (r - heightOfLost(other)) * kept(other).n_B;
  SurfaceSlot& joined = slotAt(slot);
  if (push.norm() > 0) joined.n_B = push.normalized();
  joined.p_BS = ball_.C - (r - push.norm()) * joined.n_B;
  joined.ease = 0;
  slotAt(other).ease = kInfinity;
}

void EasedContacts::answer(SurfaceContacts& found, std::uint32_t& status) {
  std::sort(list_.begin(), list_.end(), [](const FollowedContact& a, const FollowedContact& b) {
    return a.shown() < b.shown() || (a.shown() == b.shown() && a.slot < b.slot);
  });
  std::array<bool, kMaxSurfaceContacts> stays = {};
  for (const FollowedContact& f : list_) {
    if (found.count > 0 && f.shown() >= ball_.reach) continue;
    if (f.fades || f.ease > 0) status |= kQueryEased;
    const ShellContact& c = f.contact;
    const Vec3 S = ball_.placeOf(c);
    stays[static_cast<std::size_t>(f.slot)] = true;
    slotAt(f.slot) = {c.foot.triangle, f.fades, c.foot.b[1], c.foot.b[2], f.ease, S, c.n, c.motion.du, c.motion.dv};
    if (found.count > 0 && f.shown() >= ball_.shown) continue;
    found.points[static_cast<std::size_t>(found.count++)] = {S, c.n, f.shown() - ball_.r,
                                                             static_cast<std::uint32_t>(f.slot)};
  }
  for (int slot = 0; slot < kMaxSurfaceContacts; ++slot) {
    if (!stays[static_cast<std::size_t>(slot)] && kept(slot).triangle >= 0) slotAt(slot) = {};
  }
}

}  // namespace pincer::contact
