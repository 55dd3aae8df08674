#include "pincer/contact/surface/ease.h"

#include "pincer/contact/surface/tolerances.h"

namespace pincer::contact {

using State = HeldContact::State;

// Around an edge the overlap d changes by d / h of the centre's way at most, on anything rounder and in any hollow that
// the finger fits into by less, straight down by all of it.
bool TouchingBall::continues(const SurfaceSlot& kept, const ShellContact& contact) const {
  constexpr double kSlack = 2;     // for shading normals, which turn faster than the surface here and there
  constexpr double kMostTurn = 5;  // of d / h, which has no bound where the centre comes to the surface
  constexpr double kStill = 1e-5;  // of r
  if (!eases) return true;
  const double before = std::max(0.0, r - heightBefore(kept)), now = std::max(0.0, r - contact.h);
  const double turn = now < kMostTurn * contact.h ? std::max(1.0, now / contact.h) : kMostTurn;
  return (now * contact.n - before * kept.n_B).norm() <= kSlack * turn * moved + kStill * r;
}

void EasedContacts::moveOn(int slot, const ShellContact& contact) {
  if (contact.converged && ball_.continues(kept(slot), contact) && !isListed(contact)) return keep(slot, contact);
  lose(slot);
}

void EasedContacts::keep(int slot, const ShellContact& contact) {
  had_contacts_ = true;
  held(slot) = {State::followed, false, std::max(0.0, kept(slot).ease - ball_.moved), contact};
}

// Fades for as long as it would push, and is eased away by as much as the centre moves.
void EasedContacts::lose(int slot) {
  had_contacts_ = true;
  HeldContact& lost = held(slot) = {State::fades, false, kept(slot).ease + ball_.moved, planeOf(slot)};
  if (lost.shown() >= ball_.r) lost.state = State::none;
}

ShellContact EasedContacts::onItsSide(const SurfaceSlot& kept, const ShellContact& contact) const {
  if (contact.foot.isOnFace() || !contact.converged || !(contact.h < 0 && ball_.heightBefore(kept) > 0)) return contact;
  ShellContact turned = contact;
  turned.n = -contact.n;
  turned.h = -contact.h;
  return ball_.continues(kept, turned) ? turned : contact;
}

int EasedContacts::alone() const {
  if (count(State::none) != kMaxSurfaceContacts - 1) return -1;
  for (int slot = 0; slot < kMaxSurfaceContacts; ++slot) {
    if (at(slot).isFollowed()) return slot;
  }
  return -1;
}

bool EasedContacts::isListed(const ShellContact& contact) const {
  return isAny([&](const HeldContact& other) {
    return (ball_.placeOf(other.contact) - ball_.placeOf(contact)).norm() < kOnePlace * ball_.r;
  });
}

double EasedContacts::nearestHeight() const {
  double h = kInfinity;
  for (const HeldContact& f : held_) h = f.isFollowed() ? std::min(h, f.contact.h) : h;
  return h;
}

// Where none may yield: of those that would be touched, for it has to be told that they are left out.
double EasedContacts::heightToBeat() const {
  if (hasRoom()) return kInfinity;
  double highest = 0;
  for (const HeldContact& f : held_) highest = mayYield(f) ? std::max(highest, f.contact.h) : highest;
  return highest > 0 ? highest : ball_.r;
}

// Its overlap begins at zero, but for the way that the finger can have come closer.
HeldContact EasedContacts::newOne(const ShellContact& contact) const {
  const double overlap = ball_.eases && had_contacts_ ? ball_.r - contact.h - ball_.moved : 0;
  return {State::followed, true, std::max(0.0, overlap), contact};
}

// A slot for a new contact; null without. Of two that fade the first then pushes as both did.
HeldContact* EasedContacts::room() {
  HeldContact* fading = nullptr;
  for (HeldContact& f : held_) {
    if (f.state == State::none) return &f;
  }
  for (HeldContact& f : held_) {
    if (f.state != State::fades) continue;
    if (!fading) {
      fading = &f;
      continue;
    }
    ShellContact& plane = fading->contact;
    const Vec3 push = (ball_.r - fading->shown()) * plane.n + (ball_.r - f.shown()) * f.contact.n;
    if (push.norm() > 0) plane.n = push.normalized();
    plane.h = ball_.r - push.norm();
    fading->ease = 0;
    return &f;
  }
  return nullptr;
}

// The walls of a hole hardly wider than the finger leave room for its floor.
bool EasedContacts::admit(const ShellContact& contact) {
  if (HeldContact* const free = room()) {
    *free = newOne(contact);
    return true;
  }
  HeldContact* highest = nullptr;
  for (HeldContact& other : held_) {
    const bool may_go = mayYield(other) && other.contact.h > contact.h + (other.is_new ? 0 : kOnePlace * ball_.r);
    if (may_go && (!highest || other.contact.h > highest->contact.h)) highest = &other;
  }
  const bool is_touched_left_out = highest ? highest->shown() < ball_.r : contact.h < ball_.r;
  if (highest) *highest = newOne(contact);
  return !is_touched_left_out;
}

void EasedContacts::admitNearest(const ShellContact& contact) {
  HeldContact* const free = room();
  *(free ? free : &held_.back()) = newOne(contact);
}

ShellContact EasedContacts::planeOf(int slot) const {
  const SurfaceSlot& plane = kept(slot);
  return {footOf(plane), plane.n_B, (ball_.C - plane.p_BS).dot(plane.n_B), false, {}};
}

int EasedContacts::deepestFading() const {
  int deepest = -1;
  for (int slot = 0; slot < kMaxSurfaceContacts; ++slot) {
    if (at(slot).state == State::fades && (deepest < 0 || at(slot).shown() < at(deepest).shown())) deepest = slot;
  }
  return deepest;
}

void EasedContacts::dropFading() {
  for (HeldContact& f : held_) f.state = f.state == State::fades && !ball_.eases ? State::none : f.state;
}

const ShellContact& EasedContacts::answer(SurfaceContacts& found, std::uint32_t& status) {
  std::array<int, kMaxSurfaceContacts> order = {0, 1, 2};
  const auto height = [&](int slot) { return at(slot).state == State::none ? kInfinity : at(slot).shown(); };
  std::sort(order.begin(), order.end(),
            [&](int a, int b) { return height(a) < height(b) || (height(a) == height(b) && a < b); });
  for (const int slot : order) {
    const HeldContact& f = at(slot);
    SurfaceSlot& kept = slots_[static_cast<std::size_t>(slot)];
    if (f.state == State::none || (found.count > 0 && f.shown() >= ball_.reach)) {
      if (kept.triangle >= 0) kept = {};
      continue;
    }
    const bool fades = f.state == State::fades;
    if (fades || f.ease > 0) status |= kQueryEased;
    const ShellContact& c = f.contact;
    const Vec3 S = ball_.placeOf(c);
    kept = {c.foot.triangle, fades, c.foot.b[1], c.foot.b[2], f.ease, S, c.n, c.motion.du, c.motion.dv};
    if (found.count > 0 && f.shown() >= ball_.shown) continue;
    found.points[static_cast<std::size_t>(found.count++)] = {S, c.n, f.shown() - ball_.r,
                                                             static_cast<std::uint32_t>(slot)};
  }
  return at(order[0]).contact;
}

}  // namespace pincer::contact
