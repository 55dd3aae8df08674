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
  const LookParts& parts = lookParts();
  const auto isWhole = [&](const NearParts& near, const SurfaceLook& of) {
    return areOf(near, surface_.net.fingerprint(), of) && near.is_whole;
  };
  return isWhole(parts.now, look) && parts.now.due > gone_ && (!isPastHalf() || isWhole(parts.ahead, tracker_.ahead));
}

bool Lookout::isQuietAround(int slot, const Vec3& n) const {
  const auto normalIn = [&](int other) -> Vec3 { return other == slot ? n : Vec3(Vec3::Zero()); };
  return isGoodFor(tracker_.look, true, normalIn) && !hasTurnedHalf(normalIn);
}

// True if what the look found is still all that there can be: near enough, and what it left out still belongs to the
// same contacts.
template <class NormalIn>
bool Lookout::isGoodFor(const SurfaceLook& look, bool is_alone, const NormalIn& normalIn) const {
  if (!(wayFrom(look) < look.horizon) || (look.is_alone && !is_alone)) return false;
  const double least = look.is_alone ? LoneContact::kCosBeta : kHalfApart;
  for (int slot = 0; slot < kMaxSurfaceContacts; ++slot) {
    const Vec3& n = look.n[static_cast<std::size_t>(slot)];
    if (!isUnset(n) && !(normalIn(slot).dot(n) > least)) return false;
  }
  return true;
}

bool Lookout::isGood(const SurfaceLook& look) const {
  return isGoodFor(look, contacts_.isAlone(), [&](int slot) { return contacts_.normalIn(slot); });
}

// True if a contact's normal has turned by half of what it may until the look ends.
template <class NormalIn>
bool Lookout::hasTurnedHalf(const NormalIn& normalIn) const {
  constexpr double kQuarterApart = 0.999876;  // cosine of half of kHalfApart's angle
  const SurfaceLook& look = tracker_.look;
  if (look.is_alone) return false;
  for (int slot = 0; slot < kMaxSurfaceContacts; ++slot) {
    const Vec3& n = look.n[static_cast<std::size_t>(slot)];
    if (!isUnset(n) && normalIn(slot).dot(n) < kQuarterApart) return true;
  }
  return false;
}

bool Lookout::isPastHalf() const { return wayFrom(tracker_.look) > 0.5 * tracker_.look.horizon; }

// Time to work on the next one.
bool Lookout::isEnding() const {
  return isPastHalf() || hasTurnedHalf([&](int slot) { return contacts_.normalIn(slot); });
}

// A look that finds that nothing but the followed contact can matter for a while.
bool Lookout::lookAlone() {
  constexpr double kLeast = 1.0 / 16, kMost = 1.0 / 4;  // ways worth the look, of its reach
  if (surface_.variant != SurfaceVariant::smooth || !contacts_.isAlone()) return false;
  const FollowedContact& f = contacts_.list().front();
  const double reach = ball_.reach;
  const double way = search_.wayAlone(ball_.C, f.contact.n, f.contact.h, reach, kLeast * reach, kMost * reach);
  if (!(way > 0)) return false;
  tracker_.look = {.p_BC = ball_.C, .reach = reach, .horizon = way, .vouched = way, .is_alone = true};
  tracker_.look.n[static_cast<std::size_t>(f.slot)] = f.contact.n;
  tracker_.ahead = {};
  return true;
}

SurfaceLook Lookout::lookFrom(const Vec3& p_BC) const {
  SurfaceLook look{.p_BC = p_BC, .reach = ball_.reach, .horizon = kLookHorizon * ball_.reach};
  for (const FollowedContact& f : contacts_.list()) {
    if (!f.fades && turnsSlowly(f.contact)) look.n[static_cast<std::size_t>(f.slot)] = f.contact.n;
  }
  return look;
}

// From where the centre will be when the look that is half over ends, with the normals that the contacts will have.
SurfaceLook Lookout::lookAtEnd() const {
  const SurfaceLook& now = tracker_.look;
  SurfaceLook look = lookFrom(ball_.C + (ball_.C - now.p_BC));
  for (std::size_t slot = 0; slot < look.n.size(); ++slot) {
    if (!isUnset(look.n[slot]) && !isUnset(now.n[slot])) look.n[slot] = (2 * look.n[slot] - now.n[slot]).normalized();
  }
  return look;
}

// True if the contact's normal turns by less than kHalfApart over a look's horizon, as far as its patch tells; on edges
// it turns fast.
bool Lookout::turnsSlowly(const ShellContact& contact) const {
  constexpr double kMostTurn = 0.04;  // [rad]
  if (!contact.foot.isOnFace()) return false;
  const Patch& patch = surface_.net.cell(contact.foot.triangle, surface_.cache).patch;
  for (int i = 0; i < 3; ++i) {
    const double k = concaveCurvature(patch, i);
    if (!(std::abs(k) * kLookHorizon * ball_.reach < kMostTurn * (1 - k * contact.h))) return false;
  }
  return true;
}

// Begins the next look from where the centre will be when this one ends, or carries it on.
void Lookout::lookAhead() {
  constexpr int kVisits = 64;  // per query: some 3 us
  if (!(tracker_.ahead.horizon > 0)) tracker_.ahead = lookAtEnd();
  carryOn(tracker_.ahead, kVisits, lookParts().ahead);
}

// True if the look ahead can take over, and does.
bool Lookout::takeAhead() {
  if (!(tracker_.ahead.horizon > 0) || !isGood(tracker_.ahead)) return false;
  take(tracker_.ahead);
  return isGood(tracker_.look);
}

// The look to live from, whole, with what is known of the last one's parts.
void Lookout::take(SurfaceLook look) {
  tracker_.look = look;
  tracker_.ahead = {};
  tracker_.tried = 0;
  LookParts& parts = lookParts();
  std::swap(parts.now, parts.ahead);
  tracker_.look.horizon = nearParts().look.horizon;
  takeDues(parts.ahead, parts.now);
}

NearParts& Lookout::carryOn(const SurfaceLook& look, int visits, NearParts& near) {
  if (!areOf(near, surface_.net.fingerprint(), look)) beginNearParts(surface_.net, look, near);
  continueNearParts(surface_.net, search_, goneAt(look), visits, near);
  return near;
}

// Due times are forgotten where the tracker comes from elsewhere than from the last query with this cache: set back, or
// copied.
LookParts& Lookout::lookParts() {
  LookParts& parts = surface_.cache.partsOf(tracker_);
  if (parts.gone != tracker_.gone || parts.p_BC != tracker_.p_BC_last) {
    forgetDues(goneAt(parts.now.look), parts.now);
    forgetDues(goneAt(parts.ahead.look), parts.ahead);
    parts.gone = tracker_.gone;
    parts.p_BC = tracker_.p_BC_last;
  }
  return parts;
}

}  // namespace pincer::contact
