#include <algorithm>

#include "pincer/contact/surface/lone_contact.h"
#include "pincer/contact/surface/lookout.h"
#include "pincer/contact/surface/shell_face.h"

namespace pincer::contact {

namespace {

bool isUnset(const Vec3& v) { return v[0] == 0 && v[1] == 0 && v[2] == 0; }

}  // namespace

bool Lookout::isNothingDue() {
  const SurfaceLook& look = tracker_.look;
  if (look.is_alone) return wayFrom(look) < look.horizon;
  const NearParts& near = surface_.cache.partsOf(tracker_);
  return near.areOf(surface_.net.fingerprint(), look) && near.gone == tracker_.gone &&
         near.p_BC == tracker_.p_BC_last && near.due > gone_;
}

bool Lookout::isQuietAround(int slot, const Vec3& n) const {
  return isGood(true, [&](int other) -> Vec3 { return other == slot ? n : Vec3(Vec3::Zero()); });
}

// True if what the look found is still all that there can be: near enough, and what it left out still belongs to the
// same contacts.
template <class NormalIn>
bool Lookout::isGood(bool is_alone, const NormalIn& normalIn) const {
  const SurfaceLook& look = tracker_.look;
  if (!(wayFrom(look) < look.horizon) || (look.is_alone && !is_alone)) return false;
  const double least = look.is_alone ? LoneContact::kCosBeta : kHalfApart;
  for (int slot = 0; slot < kMaxSurfaceContacts; ++slot) {
    const Vec3& n = look.n[static_cast<std::size_t>(slot)];
    if (!isUnset(n) && !(normalIn(slot).dot(n) > least)) return false;
  }
  return true;
}

void Lookout::lookOut() {
  if (!isGood(contacts_.isAlone(), [&](int slot) { return contacts_.normalIn(slot); }) && !lookAlone()) {
    tracker_.look = lookFromHere();
    tracker_.tried = 0;
  }
  if (tracker_.look.is_alone) return;
  NearParts& near = nearParts();
  const bool are_all = isEveryonesTurn();
  if (!(near.due > gone_) || are_all) examineDue(near, are_all);
  if (!are_all && isEveryonesTurn()) examineDue(near, true);
}

// A look that finds that nothing but the followed contact can matter for a while.
bool Lookout::lookAlone() {
  if (surface_.variant != SurfaceVariant::smooth || !contacts_.isAlone()) return false;
  const FollowedContact& f = contacts_.list().front();
  const double reach = ball_.reach;
  const double way =
      search_.wayAlone(ball_.C, f.contact.n, f.contact.h, reach, kLeastAlone * reach, kMostAlone * reach);
  if (!(way > 0)) return false;
  tracker_.look = {.p_BC = ball_.C, .reach = reach, .horizon = way, .is_alone = true};
  tracker_.look.n[static_cast<std::size_t>(f.slot)] = f.contact.n;
  return true;
}

SurfaceLook Lookout::lookFromHere() const {
  SurfaceLook look{.p_BC = ball_.C, .reach = ball_.reach, .horizon = kLookHorizon * ball_.reach};
  for (const FollowedContact& f : contacts_.list()) {
    if (!f.fades && turnsSlowly(f.contact)) look.n[static_cast<std::size_t>(f.slot)] = f.contact.n;
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

// The parts near the tracker's look. What is due when is forgotten where the tracker comes from elsewhere than from the
// last query with this memory: set back, or copied.
NearParts& Lookout::nearParts() {
  NearParts& near = surface_.cache.partsOf(tracker_);
  if (!near.areOf(surface_.net.fingerprint(), tracker_.look)) {
    listNearParts(surface_.net, search_, tracker_.look, goneAt(tracker_.look), near);
    ++cost_.looks;
  } else if (near.gone != tracker_.gone || near.p_BC != tracker_.p_BC_last) {
    forgetDues(goneAt(tracker_.look), near);
  }
  tracker_.look.horizon = near.look.horizon;
  return near;
}

}  // namespace pincer::contact
