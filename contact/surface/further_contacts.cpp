#include <algorithm>

#include "pincer/contact/surface/lone_contact.h"
#include "pincer/contact/surface/near_parts.h"
#include "pincer/contact/surface/shell_face.h"
#include "pincer/contact/surface/surface_touch.h"

namespace pincer::contact {

namespace {

constexpr double kBesideKnown = 0.966;  // cosine of 15 degrees: a normal that far from a patch's still belongs to it
constexpr double kAround = 1.0 / 16;    // of r: what lies nearer to a contact than this differs by no more than kApart in its normal

// True if the place is on an edge or a vertex that this triangle has too.
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
  if (isVouched()) return;
  if (!isLookGood() && !takeAhead()) {
    if (lookAlone()) return;
    lookAround();
  } else if (isLookEnding()) {
    if (!(tracker_.ahead.horizon > 0) && lookAlone()) return;
    lookAhead();
  }
  NearParts& near = nearParts();
  if (!(near.due > gone_) || isEveryonesTurn()) examineDue(near);
}

// Tries the places that are due and have their turn, until so much has been tried as a query may try; the next one goes on from there.
void SurfaceTouch::examineDue(NearParts& near) {
  bool are_all = isEveryonesTurn();
  examineTurns(near, are_all);
  if (!are_all && isEveryonesTurn()) examineTurns(near, true);
}

void SurfaceTouch::examineTurns(NearParts& near, bool are_all) {
  if (hasTriedEnough()) return;
  std::array<std::uint16_t, kMostParts> due;
  std::size_t count = 0, first = 0;
  near.due = kInfinity;
  for (std::size_t i = 0; i < near.parts.size(); ++i) {
    const NearPart& part = near.parts[i];
    const double when = are_all ? part.due : std::max(part.due, part.turn);
    const bool is_due = when <= gone_;
    due[count] = static_cast<std::uint16_t>(i);
    count += is_due;
    first += is_due && i < at(tracker_.tried);
    near.due = std::min(near.due, is_due ? kInfinity : when);
  }
  const Turns turns(tracker_.gone, gone_, turn_);
  tracker_.tried = 0;
  for (std::size_t k = 0; k < count; ++k) {
    const std::size_t i = due[first + k < count ? first + k : first + k - count];
    NearPart& part = near.parts[i];
    if (part.turn == 0) part.turn = tracker_.gone + turns.wayToFirst(part.place);
    if ((part.turn <= gone_ || are_all) && !hasTriedEnough()) {
      examine(turns, part);
      if (hasTriedEnough()) tracker_.tried = static_cast<std::int32_t>(i + 1);
    }
    near.due = std::min(near.due, std::max(part.due, part.turn));
  }
}

// The rest waits for the next query; not where everyone has a turn, but for the places that can be remembered.
bool SurfaceTouch::hasTriedEnough() const { return seen_.isFull() || (walked_ >= kMostWalked && !isEveryonesTurn()); }

// True if what the last look found is still all that there can be: near enough, and what it left out still belongs to the same contacts.
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

// The same where all that is followed is the contact with the normal `n` in that slot, and won't be over soon.
bool SurfaceTouch::isLookGoodFor(int slot, const Vec3& n) const {
  const SurfaceLook& look = tracker_.look;
  if (!(wayFromLook() < look.horizon) || hasTurnedHalf(slot, n)) return false;
  for (int i = 0; i < kMaxSurfaceContacts; ++i) {
    if (!isUnset(look.n[at(i)]) && (i != slot || !staysOn(look, slot, n))) return false;
  }
  return true;
}

// True if a followed contact with the normal `n` is still the one that the look saw in that slot.
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
  tracker_.look = {.p_BC = C_, .reach = reach_, .horizon = way, .vouched = way, .is_alone = true};
  tracker_.look.n[at(f.slot)] = f.contact.n;
  tracker_.ahead = {};
  return true;
}

// The last look found that there is no other contact here.
bool SurfaceTouch::isVouched() const { return lost_.empty() && wayFromLook() < tracker_.look.vouched && isLookGood(); }

// True if addFurther() would do nothing, if the look is good.
bool SurfaceTouch::isNothingDue() {
  const SurfaceLook& look = tracker_.look;
  if (look.is_alone) return wayFromLook() < look.vouched;
  const LookParts& parts = lookParts();
  const auto isWhole = [&](const NearParts& near, const SurfaceLook& of) { return areOf(near, s_.net.fingerprint(), of) && near.is_whole; };
  return isWhole(parts.now, look) && parts.now.due > gone_ && (!isLookEnding() || isWhole(parts.ahead, tracker_.ahead));
}

// Time to work on the next one.
bool SurfaceTouch::isLookEnding() const {
  constexpr double kEnding = 0.5;  // of the horizon
  if (tracker_.look.is_alone) return false;
  return wayFromLook() > kEnding * tracker_.look.horizon ||
         std::any_of(list_.begin(), list_.end(), [&](const FollowedContact& f) { return hasTurnedHalf(f.slot, f.contact.n); });
}

// True if a contact's normal has turned by half of what it may until the look ends.
bool SurfaceTouch::hasTurnedHalf(int slot, const Vec3& n) const {
  constexpr double kQuarterApart = 0.999876;  // cosine of half of kHalfApart's angle
  const SurfaceLook& look = tracker_.look;
  return !look.is_alone && !isUnset(look.n[at(slot)]) && n.dot(look.n[at(slot)]) < kQuarterApart;
}

SurfaceLook SurfaceTouch::lookFrom(const Vec3& p_BC) const {
  SurfaceLook look{.p_BC = p_BC, .reach = reach_, .horizon = kLookHorizon * reach_};
  for (const FollowedContact& f : list_) {
    if (!f.fades && turnsSlowly(f.contact)) look.n[at(f.slot)] = f.contact.n;
  }
  return look;
}

void SurfaceTouch::lookAround() {
  tracker_.look = lookFrom(C_);
  tracker_.ahead = {};
  tracker_.tried = 0;
  LookParts& parts = lookParts();
  std::swap(parts.now, parts.ahead);
  tracker_.look.horizon = nearParts().look.horizon;
  takeDues(parts.ahead, parts.now);
}

// Begins the next look from where the centre will be when this one ends, or carries it on.
void SurfaceTouch::lookAhead() {
  constexpr int kVisits = 64;  // per query: some 3 us
  if (!(tracker_.ahead.horizon > 0)) tracker_.ahead = lookAtEnd();
  NearParts& ahead = lookParts().ahead;
  if (!areOf(ahead, s_.net.fingerprint(), tracker_.ahead)) beginNearParts(s_.net, tracker_.ahead, ahead);
  continueNearParts(s_.net, s_.search, goneAt(tracker_.ahead), kVisits, ahead);
}

// From where the centre will be when the look that is half over ends, with the normals that the contacts will have.
SurfaceLook SurfaceTouch::lookAtEnd() const {
  const SurfaceLook& now = tracker_.look;
  SurfaceLook look = lookFrom(C_ + (C_ - now.p_BC));
  for (std::size_t slot = 0; slot < look.n.size(); ++slot) {
    if (!isUnset(look.n[slot]) && !isUnset(now.n[slot])) look.n[slot] = (2 * look.n[slot] - now.n[slot]).normalized();
  }
  return look;
}

// True if the look ahead can take over, and does.
bool SurfaceTouch::takeAhead() {
  if (!(tracker_.ahead.horizon > 0)) return false;
  tracker_.look = tracker_.ahead;
  tracker_.ahead = {};
  tracker_.tried = 0;
  if (!isLookGood()) return false;
  LookParts& parts = lookParts();
  std::swap(parts.now, parts.ahead);
  tracker_.look.horizon = nearParts().look.horizon;
  takeDues(parts.ahead, parts.now);
  return isLookGood();
}

// True if the contact's normal turns by less than kHalfApart over a look's horizon, as far as its patch tells; on edges it turns fast.
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

// Due times are forgotten where the tracker comes from elsewhere than from the last query with this cache: set back, or copied.
LookParts& SurfaceTouch::lookParts() {
  LookParts& parts = cache_.partsOf(tracker_);
  if (parts.gone != tracker_.gone || parts.p_BC != tracker_.p_BC_last) {
    forgetDues(goneAt(parts.now.look), parts.now);
    forgetDues(goneAt(parts.ahead.look), parts.ahead);
    parts.gone = tracker_.gone;
    parts.p_BC = tracker_.p_BC_last;
  }
  return parts;
}

NearParts& SurfaceTouch::nearParts() {
  NearParts& near = lookParts().now;
  if (!areOf(near, s_.net.fingerprint(), tracker_.look)) beginNearParts(s_.net, tracker_.look, near);
  continueNearParts(s_.net, s_.search, goneAt(tracker_.look), kWholeWalk, near);
  return near;
}

// How far the centre has to move at least until the part may matter [m].
double SurfaceTouch::wayTo(std::int32_t place, const PatchBounds& part) const {
  constexpr double kRounding = 1e-12;  // of the mesh's size
  const double approach = part.approach(C_, reach_) - kRounding * s_.net.length();
  return approach > 0 ? approach : std::max<double>(0, s_.search.wayToMinimumOn(s_.net, place, C_, reach_));
}

void SurfaceTouch::examine(const Turns& turns, NearPart& near) {
  const PatchBounds part = s_.search.part(near.place);
  const std::int32_t triangle = s_.search.triangleAt(near.place);
  near.turn = gone_ + turns.wayToNext(near.place);
  const double reach = reachOfTry(turns.isOf(near.place));
  if (reach < reach_ && !(reach > 0 && part.mayHold(C_, reach, Facing::front))) return;
  const double way = wayTo(near.place, part);
  near.due = gone_ + way;
  if (way > 0 || !part.mayHold(C_, reach, Facing::front)) return;
  if (isFollowed(triangle, part) || wasSeen(triangle, part)) return;
  if (const auto foot = s_.search.minimumOn(s_.net, near.place, C_, reach)) tryPlace(*foot);
}

// True if a contact stands for this patch: beside it, with a normal that the patch's could be. (Not any of its cone's: along a groove that
// holds the other wall's.)
bool SurfaceTouch::stands(const Foot& foot, const Vec3& S, const Vec3& n, std::int32_t triangle, const PatchBounds& part) const {
  if (foot.triangle == triangle || isOnFeatureOf(s_.net, foot, triangle)) return true;
  const double beside = std::max<double>(part.radius, kAround * r_) + part.radius;
  return (S - part.middle()).squaredNorm() < beside * beside && closestNormal(s_.net, triangle, n) > kBesideKnown;
}

[[gnu::flatten]] bool SurfaceTouch::isFollowed(std::int32_t triangle, const PatchBounds& part) const {
  return std::any_of(list_.begin(), list_.end(), [&](const FollowedContact& f) {
    return !f.fades && stands(f.contact.foot, placeOf(f.contact), f.contact.n, triangle, part);
  });
}

// True if a try has led to a place that stands for it.
bool SurfaceTouch::wasSeen(std::int32_t triangle, const PatchBounds& part) const {
  return std::any_of(seen_.begin(), seen_.end(), [&](const TriedPlace& s) { return stands(s.foot, s.S, s.n, triangle, part); });
}

// As far as into a triangle in which a followed contact is: that one.
ShellContact SurfaceTouch::followUntilKnown(const Foot& foot) {
  ShortList<std::int32_t, kMaxSurfaceContacts> known;
  for (const FollowedContact& f : list_) {
    if (!f.fades) known.push_back(f.contact.foot.triangle);
  }
  const ShellContact found = solveShell(s_.net, cache_, C_, foot, {known.begin(), known.end()});
  walked_ += found.cost.steps + found.cost.crossings;
  if (!found.has_met) return found;
  const auto isThere = [&](const FollowedContact& f) { return !f.fades && f.contact.foot.triangle == found.foot.triangle; };
  return std::find_if(list_.begin(), list_.end(), isThere)->contact;
}

// Without anything to go by, and in free space with all slots taken, where the nearest is the answer.
bool SurfaceTouch::isEveryonesTurn() const { return !was_used_ || !follows() || (list_.isFull() && !touches()); }

// How near a place has to be to be tried now [m]; 0: none is. Where all slots are taken it has to be nearer than what may yield.
double SurfaceTouch::reachOfTry(bool has_turn) const {
  const bool is_free = !was_used_ || !follows() || has_turn;
  if (!list_.isFull()) return is_free ? reach_ : 0;
  double furthest = 0;
  for (const FollowedContact& f : list_) furthest = mayYield(f) ? std::max(furthest, f.contact.h) : furthest;
  if (!(furthest > 0)) return is_free && gone_ - tracker_.full_at > 0.5 * turn_ ? reach_ : 0;  // only to see whether it is left out
  return is_free ? furthest : touches() ? 0 : std::min(furthest, nearestHeight());
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

// Followed contacts stay, but for those that don't touch and are clearly further: the walls of a hole hardly wider than the finger leave room for
// its floor. Of what may go the furthest does.
void SurfaceTouch::keepDeepestFurther(const ShellContact& candidate) {
  if (!list_.isFull()) return addNew(candidate);
  tracker_.full_at = gone_;
  FollowedContact* furthest = nullptr;
  for (FollowedContact& other : list_) {
    const bool may_go = mayYield(other) && other.contact.h > candidate.h + (other.is_new ? 0 : kOnePlace * r_);
    if (may_go && (!furthest || other.contact.h > furthest->contact.h)) furthest = &other;
  }
  if (furthest) *furthest = {candidate, furthest->slot, true, false, easeOfNew(candidate)};
}

}  // namespace pincer::contact
