#include "pincer/contact/surface/lookout.h"

#include <algorithm>

#include "pincer/contact/surface/lone_contact.h"
#include "pincer/contact/surface/shell_face.h"
#include "pincer/contact/surface/tolerances.h"

namespace pincer::contact {

namespace {

bool isUnset(const Vec3& v) { return v[0] == 0 && v[1] == 0 && v[2] == 0; }

}  // namespace

void Lookout::findOthers(EasedContacts& contacts) {
  contacts_ = &contacts;
  if (!contacts_->follows() && contacts_->fades()) findLost();
  if (!(contacts_->nearestHeight() < ball_.reach) && !contacts_->fades()) findNearest();
  contacts_->dropFading();
  if (contacts_->nearestHeight() < ball_.reach) lookOut();
}

// Without any contact left: what else faces the finger; or a place on the side that it is on; or the plane that it was.
void Lookout::findLost() {
  lookOut();
  if (!contacts_->follows()) {
    const ShellContact plane = contacts_->planeOf(contacts_->deepestFading());
    const auto isSameSide = [&](const ShellContact& c) {
      return c.converged && c.n.dot(plane.n) > 0 && std::abs(c.h - plane.h) < kSameDepth * ball_.r;
    };
    const SurfaceSeed seed = search_.nearest(surface_.net, surface_.cache, ball_.C, ball_.reach, Facing::front);
    ShellContact found;
    if (seed.found) found = follow(surface_, ball_.C, ball_.r, seed.foot);
    if (seed.found && !isSameSide(found)) found = straightTo(surface_, ball_.C, seed);
    if (!isSameSide(found)) return holdLost();
    contacts_->admit(found);
  }
  tracker_.status |= kQueryReseeded;
  ++cost_.reseeds;
}

// Its plane stays, whole. An open border stays as a wire: a finger that is led in under the sheet is pushed away from
// it until it is clear.
void Lookout::holdLost() {
  const int slot = contacts_->deepestFading();
  const auto wire = ball_.eases ? wireUnder(surface_, ball_.C, ball_.r, contacts_->kept(slot)) : std::nullopt;
  if (wire) {
    contacts_->keep(slot, *wire);
    tracker_.status |= kQueryReseeded;
    ++cost_.reseeds;
  } else {
    contacts_->hold(slot);
    tracker_.status |= kQueryHeldDirection;
    ++cost_.held;
  }
}

void Lookout::findNearest() {
  const ShellContact nearest = nearestWithin(contacts_->nearestHeight());
  if (contacts_->follows() && (!nearest.converged || contacts_->isListed(nearest))) return;
  contacts_->admitNearest(nearest);
  if (nearest.converged) return;
  tracker_.status |= kQueryHeldDirection;
  ++cost_.held;
}

// The nearest solution; not converged if there is none nearer than `bound`. In free space a seed that leads to no
// solution as near (shading normals may point past the nearest place by a few degrees) stands for itself: far from
// contact the distance counts, not the direction. So does one in overlap that leads to none at all, on a ridge between
// two of a hollow that the finger is too large for.
ShellContact Lookout::nearestWithin(double bound) {
  const SurfaceSeed seed =
      search_.nearest(surface_.net, surface_.cache, ball_.C, bound, tracker_.has_centre ? Facing::front : Facing::both);
  if (!seed.found) return {};
  ShellContact contact = follow(surface_, ball_.C, ball_.r, seed.foot);
  const bool strayed = !contact.converged || std::abs(contact.h) > seed.distance + kStrayed * ball_.r;
  if (strayed && seed.distance > ball_.r) return straightTo(surface_, ball_.C, seed);
  if (!contact.converged) {
    contact = straightTo(surface_, ball_.C, seed);
    tracker_.status |= kQueryReseeded;
    ++cost_.reseeds;
  }
  contact.converged = contact.converged && std::abs(contact.h) < bound;
  return contact;
}

void Lookout::remember(const ShellContact& main) {
  constexpr double kTold = 2;  // turns: what was left out has its next one meanwhile
  if (contacts_ && !contacts_->hasRoom() && tracker_.left_out <= kTold * ball_.turn)
    tracker_.status |= kQueryContactsDropped;
  if (main.h > 0) {
    tracker_.p_BC = ball_.C;
    tracker_.has_centre = true;
  } else if (main.h <= 0 && tracker_.has_centre) {
    tracker_.p_BC = ball_.placeOf(main) + ball_.r * main.n;
  }
  tracker_.p_BC_last = ball_.C;
  tracker_.reach = ball_.reach;
  tracker_.turn += share_;
  tracker_.left_out += ball_.gone;
}

bool Lookout::isNear() const {
  const SurfaceLook& look = tracker_.look;
  return (ball_.C - look.p_BC).norm() + std::max(0.0, ball_.reach - look.reach) < look.horizon;
}

// True if what the look found is still all that there can be: near enough, and what it left out still belongs to the
// same contacts.
template <class NormalIn>
bool Lookout::isGood(bool is_alone, NormalIn&& normalIn) const {
  const SurfaceLook& look = tracker_.look;
  if (!isNear() || (look.is_alone && !is_alone)) return false;
  const double least = look.is_alone ? LoneContact::kCosBeta : kHalfApart;
  for (int slot = 0; slot < kMaxSurfaceContacts; ++slot) {
    const Vec3& n = look.n[static_cast<std::size_t>(slot)];
    if (!isUnset(n) && !(normalIn(slot).dot(n) > least)) return false;
  }
  return true;
}

bool Lookout::isGoodAlone(int slot, const Vec3& n) const {
  return isGood(true, [&](int other) -> Vec3 { return other == slot ? n : Vec3(Vec3::Zero()); });
}

void Lookout::lookOut() {
  const auto normalIn = [&](int slot) -> Vec3 {
    return contacts_->at(slot).isFollowed() ? contacts_->at(slot).contact.n : Vec3(Vec3::Zero());
  };
  if (!isGood(contacts_->alone() >= 0, normalIn) && !lookAlone()) tracker_.look = lookFromHere();
  if (tracker_.look.is_alone) return;
  NearParts& near = surface_.cache.partsOf(tracker_);
  if (!near.areOf(surface_.net.fingerprint(), tracker_.look)) {
    listNearParts(surface_.net, search_, tracker_.look, near);
    ++cost_.looks;
  }
  tracker_.look.horizon = near.look.horizon;
  near.advance(ball_.C, ball_.reach);
  examineNear(near);
}

// A look that finds that nothing but the followed contact can matter for a while.
bool Lookout::lookAlone() {
  const int slot = contacts_->alone();
  if (surface_.variant != SurfaceVariant::smooth || slot < 0) return false;
  const ShellContact& c = contacts_->at(slot).contact;
  const double reach = ball_.reach;
  const double way = search_.wayAlone(ball_.C, c.n, c.h, reach, kLeastAlone * reach, kMostAlone * reach);
  if (!(way > 0)) return false;
  tracker_.look = {.p_BC = ball_.C, .reach = reach, .horizon = way, .is_alone = true};
  tracker_.look.n[static_cast<std::size_t>(slot)] = c.n;
  return true;
}

SurfaceLook Lookout::lookFromHere() const {
  SurfaceLook look{.p_BC = ball_.C, .reach = ball_.reach, .horizon = kLookHorizon * ball_.reach};
  for (int slot = 0; slot < kMaxSurfaceContacts; ++slot) {
    const HeldContact& f = contacts_->at(slot);
    if (f.isFollowed() && turnsSlowly(f.contact)) look.n[static_cast<std::size_t>(slot)] = f.contact.n;
  }
  return look;
}

// True if the contact's normal turns by less than kHalfApart over a look's horizon, as far as its patch tells; on edges
// it turns fast.
bool Lookout::turnsSlowly(const ShellContact& contact) const {
  if (!contact.foot.isOnFace()) return false;
  const Patch& patch = surface_.net.cell(contact.foot.triangle, surface_.cache).patch;
  for (int i = 0; i < 3; ++i) {
    const double k = concaveCurvature(patch, i);
    if (!(std::abs(k) * kLookHorizon * ball_.reach < kHalfApartSine * (1 - k * contact.h))) return false;
  }
  return true;
}

}  // namespace pincer::contact
