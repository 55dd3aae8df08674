#include <algorithm>

#include "contact/surface/lone_contact.h"
#include "contact/surface/near_parts.h"
#include "contact/surface/shell_face.h"
#include "contact/surface/surface_touch.h"

namespace pincer::contact {

namespace {

constexpr double kBesideKnown = 0.966;  // cosine of 15 degrees: a normal that far from a patch's still belongs to it
constexpr double kFits = 0.8;           // of the radius of the hollow: a finger no larger touches its inside at one place
constexpr double kAround = 1.0 / 16;    // of r: what lies nearer to a contact than this differs by no more than kApart in its normal

// Whether the place is on an edge or a vertex that this triangle has too.
bool isOnFeatureOf(const SurfaceNet& net, const Foot& foot, std::int32_t triangle) {
  if (*std::min_element(foot.b.begin(), foot.b.end()) > 0) return false;
  const auto& v = net.mesh().triangles[static_cast<std::size_t>(triangle)];
  bool shares_all = true;
  for (std::size_t i = 0; i < 3; ++i) {
    if (foot.b[i] == 0) continue;
    shares_all = shares_all && std::find(v.begin(), v.end(), net.mesh().triangles[static_cast<std::size_t>(foot.triangle)][i]) != v.end();
  }
  return shares_all;
}

bool isUnset(const Vec3& v) { return v[0] == 0 && v[1] == 0 && v[2] == 0; }

// Cosine of the angle between `n` and the nearest of the triangle's corner normals.
double closestNormal(const SurfaceNet& net, std::int32_t triangle, const Vec3& n) {
  return std::max({net.normal(triangle, 0).dot(n), net.normal(triangle, 1).dot(n), net.normal(triangle, 2).dot(n)});
}

}  // namespace

void SurfaceTouch::addFurther() {
  const bool is_new = !isLookGood();
  if (is_new && lookAlone()) return;
  if (is_new) lookAround();
  NearParts& near = nearParts();
  const double way = wayFromLook();
  for (const NearPart& part : near.parts) {
    if (part.approach > way || seen_.isFull()) break;
    if (part.skipped <= way) examine(part.place);
  }
  if (is_new) vouch(near);
}

// Whether what the last look found is still all that there can be: near enough, and what it left out still belongs to the same contacts.
bool SurfaceTouch::isLookGood() const {
  const SurfaceLook& look = tracker_.look;
  if (!(wayFromLook() < look.horizon) || (look.is_alone && !isAlone())) return false;
  for (int slot = 0; slot < kMaxSurfaceContacts; ++slot) {
    if (isUnset(look.n[at(slot)])) continue;
    const bool stays = std::any_of(list_.begin(), list_.end(), [&](const FollowedContact& f) {
      return f.slot == slot && !f.fades && staysOn(look, slot, f.contact.n);
    });
    if (!stays) return false;
  }
  return true;
}

// The same where all that is followed is the contact with the normal `n` in that slot.
bool SurfaceTouch::isLookGoodFor(int slot, const Vec3& n) const {
  const SurfaceLook& look = tracker_.look;
  if (!(wayFromLook() < look.horizon)) return false;
  for (int i = 0; i < kMaxSurfaceContacts; ++i) {
    if (!isUnset(look.n[at(i)]) && (i != slot || !staysOn(look, slot, n))) return false;
  }
  return true;
}

// Whether a followed contact with the normal `n` is still the one that the look saw in that slot.
bool SurfaceTouch::staysOn(const SurfaceLook& look, int slot, const Vec3& n) {
  return n.dot(look.n[at(slot)]) > (look.is_alone ? LoneContact::kCosBeta : kHalfApart);
}

bool SurfaceTouch::isAlone() const { return lost_.empty() && list_.size() == 1 && !list_.front().fades; }

// A look that finds that nothing but the followed contact can matter for a while.
bool SurfaceTouch::lookAlone() {
  constexpr double kLeast = 1.0 / 16, kMost = 1.0 / 4;  // ways worth the look, of its reach
  if (s_.variant != SurfaceVariant::smooth || !isAlone()) return false;
  const FollowedContact& f = list_.front();
  const double way = s_.search.wayAlone(C_, f.contact.n, f.contact.h, reach_, kLeast * reach_, kMost * reach_);
  if (!(way > 0)) return false;
  tracker_.look = {C_, reach_, way, way, true, {Vec3::Zero(), Vec3::Zero(), Vec3::Zero()}};
  tracker_.look.n[at(f.slot)] = f.contact.n;
  return true;
}

// The last look found all that there are here too.
bool SurfaceTouch::isVouched() const { return lost_.empty() && wayFromLook() < tracker_.look.vouched && isLookGood(); }

void SurfaceTouch::lookAround() {
  SurfaceLook& look = tracker_.look;
  look = {C_, reach_, 0, 0, false, {Vec3::Zero(), Vec3::Zero(), Vec3::Zero()}};
  for (const FollowedContact& f : list_) {
    if (!f.fades && turnsSlowly(f.contact)) look.n[at(f.slot)] = f.contact.n;
  }
  look.horizon = nearParts().look.horizon;
}

// Whether the contact's normal turns by less than kHalfApart over a look's horizon, as far as its patch tells; on edges it turns fast.
bool SurfaceTouch::turnsSlowly(const ShellContact& contact) const {
  constexpr double kMostTurn = 0.04;  // [rad]
  if (*std::min_element(contact.foot.b.begin(), contact.foot.b.end()) <= 0) return false;
  const Patch& patch = s_.net.cell(contact.foot.triangle, cache_).patch;
  for (int i = 0; i < 3; ++i) {
    const double k = concaveCurvature(patch, i);
    if (!(std::abs(k) * kLookHorizon * reach_ < kMostTurn * (1 - k * contact.h))) return false;
  }
  return true;
}

NearParts& SurfaceTouch::nearParts() {
  NearParts& near = cache_.partsAround(s_.net.fingerprint(), tracker_.look);
  if (!areOf(near, s_.net.fingerprint(), tracker_.look)) findNearParts(s_.net, s_.search, tracker_.look, near);
  return near;
}

void SurfaceTouch::examine(std::int32_t place) {
  const PatchBounds part = s_.search.part(place);
  if (!part.mayHold(C_, reach_, Facing::front)) return;
  const std::int32_t triangle = s_.search.triangleAt(place);
  if (isFollowed(triangle, part) || wasSeen(triangle, part)) return;
  if (const auto foot = s_.search.minimumOn(s_.net, place, C_, reach_)) tryPlace(*foot);
}

// Until the centre has come as near to any patch as that it matters, no look at the list is needed. What belongs to a followed contact
// matters again when the contact may have moved off it.
void SurfaceTouch::vouch(NearParts& near) {
  constexpr double kSoon = 0.5;  // of the horizon: later parts aren't worth the closer look
  double way = lost_.empty() ? near.look.horizon : 0;
  for (NearPart& part : near.parts) {
    const PatchBounds bounds = s_.search.part(part.place);
    if (isFollowed(s_.search.triangleAt(part.place), bounds)) {
      const bool stays = bounds.hollow * reach_ < kFits;
      if (!stays) way = std::min(way, std::max<double>(part.approach, kAround * r_));
    } else {
      if (part.approach < kSoon * near.look.horizon)
        part.skipped = std::max(part.approach, s_.search.wayToMinimumOn(s_.net, part.place, C_, reach_));
      way = std::min<double>(way, part.skipped);
    }
  }
  tracker_.look.vouched = std::max(0.0, way);
}

// Whether a contact stands for this patch: beside it, with a normal that the patch's could be. (Not any of its cone's: along a groove that
// holds the other wall's.)
bool SurfaceTouch::stands(const Foot& foot, const Vec3& S, const Vec3& n, std::int32_t triangle, const PatchBounds& part) const {
  if (foot.triangle == triangle || isOnFeatureOf(s_.net, foot, triangle)) return true;
  const double beside = std::max<double>(part.radius, kAround * r_) + part.radius;
  return (S - part.middle()).squaredNorm() < beside * beside && closestNormal(s_.net, triangle, n) > kBesideKnown;
}

bool SurfaceTouch::isFollowed(std::int32_t triangle, const PatchBounds& part) const {
  return std::any_of(list_.begin(), list_.end(), [&](const FollowedContact& f) {
    return !f.fades && stands(f.contact.foot, placeOf(f.contact), f.contact.n, triangle, part);
  });
}

// Whether a try has led to a place that stands for it.
bool SurfaceTouch::wasSeen(std::int32_t triangle, const PatchBounds& part) const {
  return std::any_of(seen_.begin(), seen_.end(), [&](const TriedPlace& s) { return stands(s.foot, s.S, s.n, triangle, part); });
}

// As far as into a triangle in which a followed contact is: that one.
ShellContact SurfaceTouch::followUntilKnown(const Foot& foot) const {
  ShortList<std::int32_t, kMaxSurfaceContacts> known;
  for (const FollowedContact& f : list_) {
    if (!f.fades) known.push_back(f.contact.foot.triangle);
  }
  const ShellContact found = solveShell(s_.net, cache_, C_, foot, {known.begin(), known.end()});
  if (!found.has_met) return found;
  const auto isThere = [&](const FollowedContact& f) { return !f.fades && f.contact.foot.triangle == found.foot.triangle; };
  return std::find_if(list_.begin(), list_.end(), isThere)->contact;
}

void SurfaceTouch::tryPlace(const Foot& foot) {
  const ShellContact candidate = s_.variant == SurfaceVariant::smooth ? followUntilKnown(foot) : follow(foot);
  seen_.push_back({candidate.foot, placeOf(candidate), candidate.n});
  if (candidate.converged && candidate.h > 0 && candidate.h < reach_ && isNew(candidate)) keepDeepestFurther(candidate);
}

bool SurfaceTouch::isNew(const ShellContact& candidate) const {
  const Vec3 S = placeOf(candidate);
  for (const FollowedContact& f : list_) {
    if (!f.fades && f.contact.n.dot(candidate.n) > kApart) return false;
  }
  const bool is_on_face = *std::min_element(candidate.foot.b.begin(), candidate.foot.b.end()) > 0;
  const PatchPoint x = evaluate(s_.net.cell(candidate.foot.triangle, cache_).patch, candidate.foot.b[1], candidate.foot.b[2]);
  if (is_on_face && !isStable(x, C_)) return false;
  constexpr double kShort = 0.95;  // of the way: a patch may bulge out of its triangle
  if (tracker_.has_centre && (tracker_.p_BC - S).dot(candidate.n) <= 0) return false;
  return !s_.search.isHidden(s_.net, C_, C_ + kShort * (S - C_));
}

// FollowedContact contacts stay; of further ones the deepest do.
void SurfaceTouch::keepDeepestFurther(const ShellContact& candidate) {
  if (!list_.isFull()) return addNew(candidate);
  status_ |= kQueryContactsDropped;
  for (FollowedContact& other : list_) {
    if (!other.is_new || other.contact.h <= candidate.h) continue;
    other.contact = candidate;
    other.ease = easeOfNew(candidate);
    return;
  }
}

}  // namespace pincer::contact
