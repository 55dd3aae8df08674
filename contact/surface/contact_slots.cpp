#include "pincer/contact/surface/contact_slots.h"

#include <algorithm>

#include "pincer/contact/surface/flat_contact.h"
#include "pincer/contact/surface/shell_edge.h"
#include "pincer/contact/surface/surface_touch.h"

namespace pincer::contact {

// The usual tick: the only contact that is followed has moved on within its patch, nothing else has come near, and nothing is eased.
[[gnu::flatten]] bool SurfaceTouch::followAlone(SurfaceContacts& found) {
  int slot = -1;
  for (int i = 0; i < kMaxSurfaceContacts; ++i) {
    if (keptIn(i).triangle < 0) continue;
    if (slot >= 0) return false;
    slot = i;
  }
  if (slot < 0 || s_.variant != SurfaceVariant::smooth || !isUsed(slot) || !isNothingDue()) return false;
  SurfaceSlot& kept = tracker_.slots[at(slot)];
  if (kept.fades || kept.ease > 0 || !knowsMotion(kept)) return false;
  const ShellContact contact = solveShellBeside(s_.net, cache_, C_, footOf(slot), {kept.du, kept.dv}, C_ - tracker_.p_BC_last);
  if (!contact.converged || !(contact.h > 0 && contact.h < reach_) || !continues(kept, contact) || !isLookGoodFor(slot, contact.n))
    return false;
  const Vec3 S = placeOf(contact);
  kept = {contact.foot.triangle, false, contact.foot.b[1], contact.foot.b[2], 0, S, contact.n, contact.motion.du, contact.motion.dv};
  found.points[0] = {S, contact.n, contact.h - r_, static_cast<std::uint32_t>(slot)};
  found.count = 1;
  found.cost.iterations = found.cost.longest_walk = contact.cost.steps;
  found.cost.crossings = contact.cost.crossings;
  keepCentre(contact);
  return true;
}

// Where the slots' contacts have gone. One that has slid down to where another is followed leaves the place to that one; none slides to behind the surface.
void SurfaceTouch::followSlots() {
  ShortList<ShellContact, kMaxSurfaceContacts> slid;
  for (int slot = 0; slot < kMaxSurfaceContacts; ++slot) {
    if (!isUsed(slot)) continue;
    was_used_ = true;
    if (keptIn(slot).fades) {
      lose(slot);
      continue;
    }
    const ShellContact contact = keepSide(keptIn(slot), followSlot(slot, footOf(slot)));
    cost_.iterations += contact.cost.steps;
    cost_.longest_walk = std::max(cost_.longest_walk, contact.cost.steps);
    cost_.crossings += contact.cost.crossings;
    const bool is_found = contact.converged && !isOtherSide(slot, contact), continued = is_found && continues(keptIn(slot), contact);
    if (continued && !isListed(contact)) {
      list_.push_back({contact, slot, false, false, std::max(0.0, keptIn(slot).ease - moved_)});
      continue;
    }
    lose(slot);
    if (is_found && !continued && (contact.h > 0 || heightBefore(keptIn(slot)) <= 0)) slid.push_back(contact);
  }
  for (const ShellContact& contact : slid) {
    if (!isListed(contact) && hasFreeSlot()) addNew(contact);
  }
}

namespace {

constexpr double kAtPoint = 1e-6;  // of r: nearer to a point of a border the direction to it is lost

bool isOnBorder(const SurfaceNet& net, const Foot& foot) {
  constexpr double kOn = 1e-12;  // of a barycentric coordinate
  for (int i = 0; i < 3; ++i) {
    if (foot.b[static_cast<std::size_t>((i + 2) % 3)] < kOn && net.neighbour(foot.triangle, i).triangle < 0) return true;
    if (foot.b[static_cast<std::size_t>(i)] > 1 - kOn && net.visitCorners({foot.triangle, i}, [](const CellCorner&) {})) return true;
  }
  return false;
}

}  // namespace

// Beside a fin the centre may pass the plane across its edge's mean normal, and counts as behind it, in one query as far as it was in front: the finger was
// caught between the edge and itself, or lost it.
ShellContact SurfaceTouch::keepSide(const SurfaceSlot& kept, const ShellContact& contact) const {
  const bool is_on_face = *std::min_element(contact.foot.b.begin(), contact.foot.b.end()) > 0;
  if (is_on_face || !contact.converged || !(contact.h < 0 && heightBefore(kept) > 0)) return contact;
  ShellContact turned = contact;
  turned.n = -contact.n;
  turned.h = -contact.h;
  return continues(kept, turned) ? turned : contact;
}

// A centre that begins well above the surface and ends below it has been led to the far side of the body, where the equation has
// solutions too.
bool SurfaceTouch::isOtherSide(int slot, const ShellContact& contact) const {
  constexpr double kWellAbove = 0.25;  // of r
  return contact.h < 0 && tangentContact(s_.net, cache_, C_, footOf(slot)).h > kWellAbove * r_;
}

// True if the contact is the slot's moved on, or another one that the walk has slid down to. Around an edge the overlap d changes by d / h of
// the centre's way at most, on anything rounder and in any hollow that the finger fits into by less, straight down by all of it.
bool SurfaceTouch::continues(const SurfaceSlot& kept, const ShellContact& contact) const {
  constexpr double kSlack = 2;     // for shading normals, which turn faster than the surface here and there
  constexpr double kMostTurn = 5;  // of d / h, which has no bound where the centre comes to the surface
  constexpr double kStill = 1e-5;  // of r
  if (!eases_) return true;
  const double before = std::max(0.0, r_ - heightBefore(kept)), now = std::max(0.0, r_ - contact.h);
  const double turn = now < kMostTurn * contact.h ? std::max(1.0, now / contact.h) : kMostTurn;
  return (now * contact.n - before * kept.n_B).norm() <= kSlack * turn * moved_ + kStill * r_;
}

void SurfaceTouch::lose(int slot) { lost_.push_back(slot); }

// A contact that was lost in overlap stands for its plane, and gives way as the finger moves.
void SurfaceTouch::fadeLost() {
  for (const int slot : lost_) {
    if (list_.isFull()) return;
    if (isTaken(slot)) continue;
    FollowedContact plane{planeOf(slot), slot, false, true, keptIn(slot).ease + moved_};
    if (!(plane.shown() < r_)) continue;
    list_.push_back(plane);
    status_ |= kQueryEased;
  }
}

// Without any contact left: a place on the side that the finger is on, or none.
void SurfaceTouch::findLost() {
  constexpr double kSameDepth = 0.5;  // of r
  const int slot = deepestLost();
  if (lostHeight(slot) + moved_ >= r_) {
    lost_.clear();
    return;
  }
  const ShellContact plane = planeOf(slot);
  const auto isSameSide = [&](const ShellContact& c) { return c.n.dot(plane.n) > 0 && std::abs(c.h - plane.h) < kSameDepth * r_; };
  addFurther();
  const FollowedContact* const found =
      std::find_if(list_.begin(), list_.end(), [&](const FollowedContact& c) { return isSameSide(c.contact); });
  if (found != list_.end()) {
    const ShellContact kept = found->contact;
    list_.clear();
    addNew(kept);
  } else {
    list_.clear();
    const SurfaceSeed seed = s_.search.nearest(s_.net, cache_, C_, reach_, Facing::front);
    ShellContact nearest;
    if (seed.found) nearest = follow(seed.foot);
    if (seed.found && (!nearest.converged || !isSameSide(nearest))) nearest = straightTo(seed);
    if (!nearest.converged || !isSameSide(nearest)) return hold(deepestLost());
    addNew(nearest);
  }
  status_ |= kQueryReseeded;
  ++cost_.reseeds;
}

// Where an open border was touched it is a wire, that faces everywhere: a finger that is led in under the sheet is pushed away from it until it is clear.
void SurfaceTouch::leanOnBorder(int slot) {
  const SurfaceSlot& kept = keptIn(slot);
  const FeatureContact wire = contactWithPoint(C_, kept.p_BS, kept.n_B, true, kAtPoint * r_);
  list_.push_back({{footOf(slot), wire.n, wire.h, true, {}}, slot, false, false, std::max(0.0, kept.ease - moved_)});
  status_ |= kQueryReseeded;
  ++cost_.reseeds;
}

// Its plane stays, whole.
void SurfaceTouch::hold(int slot) {
  if (eases_ && isOnBorder(s_.net, footOf(slot))) return leanOnBorder(slot);
  list_.push_back({planeOf(slot), slot, false, false, keptIn(slot).ease});
  status_ |= kQueryHeldDirection;
  ++cost_.held;
}

// In free space the nearest place is the contact, whatever was followed.
void SurfaceTouch::takeNearest() {
  const ShellContact nearest = nearestWithin(nearestHeight());
  if (!list_.empty() && (!nearest.converged || isListed(nearest))) return;
  if (list_.isFull()) list_.pop_back();
  addNew(nearest);
  if (nearest.converged) return;
  status_ |= kQueryHeldDirection;
  ++cost_.held;
}

// The nearest solution; not converged if there is none nearer than `bound`. In free space a seed that leads to no solution as near (shading
// normals may point past the nearest place by a few degrees) stands for itself: far from contact the distance counts, not the direction. So
// does one in overlap that leads to none at all, on a ridge between two of a hollow that the finger is too large for.
ShellContact SurfaceTouch::nearestWithin(double bound) {
  constexpr double kStrayed = 2.5e-3;  // of r
  const SurfaceSeed seed = s_.search.nearest(s_.net, cache_, C_, bound, tracker_.has_centre ? Facing::front : Facing::both);
  if (!seed.found) return {};
  ShellContact contact = follow(seed.foot);
  const bool strayed = !contact.converged || std::abs(contact.h) > seed.distance + kStrayed * r_;
  if (strayed && seed.distance > r_) return straightTo(seed);
  if (!contact.converged) {
    contact = straightTo(seed);
    status_ |= kQueryReseeded;
    ++cost_.reseeds;
  }
  contact.converged = contact.converged && std::abs(contact.h) < bound;
  return contact;
}

// Contact with the place itself, whatever the normal there.
ShellContact SurfaceTouch::straightTo(const SurfaceSeed& seed) const {
  const PatchPoint x = evaluate(s_.net.cell(seed.foot.triangle, cache_).patch, seed.foot.b[1], seed.foot.b[2]);
  const double sign = (C_ - x.S).dot(x.N) < 0 ? -1 : 1;
  return {seed.foot, sign / seed.distance * (C_ - x.S), sign * seed.distance, seed.distance > 0, {}};
}

// One in which nothing is followed nor fades; -1 without.
int SurfaceTouch::spareSlot() const {
  for (int slot = 0; slot < kMaxSurfaceContacts; ++slot) {
    if (!isTaken(slot) && !isFading(slot)) return slot;
  }
  return -1;
}

bool SurfaceTouch::hasFreeSlot() const {
  return spareSlot() >= 0 || std::count_if(lost_.begin(), lost_.end(), [&](int slot) { return isFading(slot); }) > 1;
}

// For a new contact. Without a spare one, two that fade are joined: one plane pushes as both did.
int SurfaceTouch::takeSlot() {
  if (const int spare = spareSlot(); spare >= 0) return spare;
  int slot = -1, other = -1;
  for (const int lost : lost_) {
    if (!isFading(lost)) continue;
    other = slot;
    slot = lost;
  }
  if (other >= 0) joinFading(other, slot);
  return slot;
}

// The other one pushes no more, whatever becomes of the contact that it makes room for.
void SurfaceTouch::joinFading(int slot, int other) {
  const Vec3 push = (r_ - lostHeight(slot)) * keptIn(slot).n_B + (r_ - lostHeight(other)) * keptIn(other).n_B;
  SurfaceSlot& joined = tracker_.slots[at(slot)];
  if (push.norm() > 0) joined.n_B = push.normalized();
  joined.p_BS = C_ - (r_ - push.norm()) * joined.n_B;
  joined.ease = 0;
  tracker_.slots[at(other)].ease = kInfinity;
}

// Requires one that was lost.
int SurfaceTouch::deepestLost() const {
  return *std::min_element(lost_.begin(), lost_.end(), [&](int a, int b) { return lostHeight(a) < lostHeight(b); });
}

void SurfaceTouch::write(SurfaceContacts& found) {
  std::sort(list_.begin(), list_.end(), [](const FollowedContact& a, const FollowedContact& b) {
    return a.shown() < b.shown() || (a.shown() == b.shown() && a.slot < b.slot);
  });
  ShortList<int, kMaxSurfaceContacts> kept;
  for (const FollowedContact& f : list_) {
    if (!kept.empty() && f.shown() >= reach_) continue;
    const ShellContact& c = f.contact;
    kept.push_back(f.slot);
    tracker_.slots[at(f.slot)] = {c.foot.triangle, f.fades, c.foot.b[1], c.foot.b[2], f.ease, placeOf(c), c.n, c.motion.du, c.motion.dv};
    if (found.count == 0 || f.shown() < shown_)
      found.points[at(found.count++)] = {placeOf(c), c.n, f.shown() - r_, static_cast<std::uint32_t>(f.slot)};
    if (f.ease > 0) status_ |= kQueryEased;
  }
  for (int slot = 0; slot < kMaxSurfaceContacts; ++slot) {
    if (keptIn(slot).triangle >= 0 && std::find(kept.begin(), kept.end(), slot) == kept.end()) tracker_.slots[at(slot)] = {};
  }
  constexpr double kTold = 2;  // turns: what was left out has its next one meanwhile
  if (list_.isFull() && gone_ - tracker_.full_at <= kTold * turn_) status_ |= kQueryContactsDropped;
  keepCentre(list_.front().contact);
  found.cost = cost_;
}

void SurfaceTouch::keepCentre(const ShellContact& main) {
  if (!tracker_.look.is_alone) keepParts();
  if (main.h > 0) {
    tracker_.p_BC = C_;
    tracker_.has_centre = true;
  } else if (main.h <= 0 && tracker_.has_centre) {
    tracker_.p_BC = placeOf(main) + r_ * main.n;
  }
  tracker_.p_BC_last = C_;
  tracker_.gone = gone_;
  tracker_.reach = reach_;
  tracker_.status = status_;
}

// Contacts of the list go on from here in the next query.
void SurfaceTouch::keepParts() {
  LookParts& parts = lookParts();
  parts.p_BC = C_;
  parts.gone = gone_;
}

SurfaceContacts touchSurface(const TouchedSurface& surface, const Vec3& p_BC, double r, double margin, SurfaceTracker& tracker,
                             PatchCache& cache) {
  SurfaceContacts found = SurfaceTouch(surface, p_BC, r, margin, tracker, cache).run();
  if (surface.variant == SurfaceVariant::force) shadeForce(surface.net, tracker, found);
  return found;
}

}  // namespace pincer::contact
