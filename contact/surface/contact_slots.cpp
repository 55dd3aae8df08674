#include "contact/surface/contact_slots.h"

#include <algorithm>
#include <limits>

#include "contact/surface/flat_contact.h"
#include "contact/surface/shell_face.h"
#include "contact/surface/surface_variant.h"

namespace pincer::contact {

namespace {

constexpr int kMaxTries = 16;           // places from which a further contact is looked for, per query
constexpr double kOnePlace = 1e-3;      // of r: contacts nearer than this are one
constexpr double kApart = 0.998;        // cosine of 3.6 degrees: further contacts differ by more in their normals
constexpr double kBesideKnown = 0.966;  // cosine of 15 degrees: a normal that far from a patch's still belongs to it
constexpr double kAround = 1.0 / 16;    // of r: what lies nearer to a contact than this differs by no more than kApart in its normal

// Where a try has led.
struct Seen {
  Foot foot;
  Vec3 S, n;
};

struct Followed {
  ShellContact contact;
  int slot = -1;
  bool is_new = false;
  bool fades = false;
  double ease = 0;  // [m]

  double shown() const { return contact.h + ease; }
};

// Whether the place is on an edge or a vertex that this triangle has too.
bool isOnFeatureOf(const SurfaceNet& net, const Foot& foot, std::int32_t triangle) {
  const auto& v = net.mesh().triangles[static_cast<std::size_t>(triangle)];
  bool is_on_feature = false, shares_all = true;
  for (std::size_t i = 0; i < 3; ++i) {
    if (foot.b[i] == 0) {
      is_on_feature = true;
    } else {
      shares_all = shares_all && std::find(v.begin(), v.end(), net.mesh().triangles[static_cast<std::size_t>(foot.triangle)][i]) != v.end();
    }
  }
  return is_on_feature && shares_all;
}

// Cosine of the angle between `n` and the nearest of the triangle's corner normals.
double closestNormal(const SurfaceNet& net, std::int32_t triangle, const Vec3& n) {
  return std::max({net.normal(triangle, 0).dot(n), net.normal(triangle, 1).dot(n), net.normal(triangle, 2).dot(n)});
}

class Touch {
 public:
  Touch(const TouchedSurface& surface, const Vec3& C, double r, double margin, SurfaceTracker& tracker, PatchCache& cache)
      : s_(surface),
        C_(C),
        r_(r),
        reach_(r + margin),
        moved_((C - tracker.p_BC_last).norm()),
        eases_(surface.variant == SurfaceVariant::smooth),
        tracker_(tracker),
        cache_(cache) {}

  SurfaceContacts run() {
    followSlots();
    if (count_ == 0 && lost_count_ > 0) findLost();
    if (!(nearestHeight() < reach_) && lost_count_ == 0) takeNearest();
    if (eases_) fadeLost();
    if (nearestHeight() < reach_ && !isVouched()) addFurther();
    return write();
  }

 private:
  void followSlots();
  bool continues(const SurfaceSlot& kept, const ShellContact& contact) const;
  void lose(int slot);
  void fadeLost();
  void findLost();
  void hold(int slot);
  void takeNearest();
  ShellContact nearestWithin(double bound) const;
  ShellContact straightTo(const SurfaceSeed& seed) const;
  void addFurther();
  void tryPlace(const Foot& foot);
  bool isNew(const ShellContact& candidate) const;
  bool isKnown(std::int32_t triangle, const PatchBounds& part) const;
  bool isVouched() const;
  void keepDeepestFurther(const ShellContact& candidate);
  SurfaceContacts write();

  bool touches() const { return nearestHeight() < r_; }
  double nearestHeight() const {
    double h = kInfinity;
    for (int i = 0; i < count_; ++i) h = list_[at(i)].fades ? h : std::min(h, list_[at(i)].contact.h);
    return h;
  }
  Vec3 placeOf(const ShellContact& c) const { return C_ - c.h * c.n; }
  ShellContact follow(const Foot& foot) const { return followContact(s_.variant, s_.net, cache_, C_, r_, foot); }
  const SurfaceSlot& keptIn(int slot) const { return tracker_.slots[at(slot)]; }
  Foot footOf(int slot) const {
    const SurfaceSlot& kept = keptIn(slot);
    return {kept.triangle, {std::max(0.0, 1 - kept.u - kept.v), kept.u, kept.v}};
  }
  bool isUsed(int slot) const { return keptIn(slot).triangle >= 0 && keptIn(slot).triangle < s_.net.size(); }
  // The contact that a slot stands for, as a plane.
  ShellContact planeOf(int slot) const {
    const SurfaceSlot& kept = keptIn(slot);
    return {footOf(slot), kept.n_B, (C_ - kept.p_BS).dot(kept.n_B), false, {}};
  }
  static std::size_t at(int i) { return static_cast<std::size_t>(i); }
  bool isListed(const ShellContact& contact) const {
    return std::any_of(list_.data(), list_.data() + count_, [&](const Followed& other) {
      return !other.fades && (placeOf(other.contact) - placeOf(contact)).norm() < kOnePlace * r_;
    });
  }
  // What it overlaps by beyond what the finger can have come closer.
  double easeOfNew(const ShellContact& contact) const { return eases_ && was_used_ ? std::max(0.0, r_ - contact.h - moved_) : 0; }
  void addNew(const ShellContact& contact) { list_[at(count_++)] = {contact, freeSlot(), true, false, easeOfNew(contact)}; }
  int freeSlot() const;
  bool isTaken(int slot) const {
    return std::any_of(list_.data(), list_.data() + count_, [&](const Followed& f) { return f.slot == slot; });
  }

  const TouchedSurface& s_;
  const Vec3 C_;
  const double r_, reach_;
  const double moved_;  // the centre since the last query [m]
  const bool eases_;    // the other variants show what they do at edges: jump
  SurfaceTracker& tracker_;
  PatchCache& cache_;
  bool was_used_ = false;  // the last query had contacts

  std::array<Followed, kMaxSurfaceContacts> list_;
  int count_ = 0;
  std::array<int, kMaxSurfaceContacts> lost_;  // slots whose contacts have lost their solutions
  int lost_count_ = 0;
  std::uint32_t status_ = kQueryOk;
  QueryCost cost_;

  std::array<Seen, kMaxTries> seen_;  // where tries have led
  int seen_count_ = 0;
};

// A centre that begins well above the surface and ends below it has been led to the far side of the body, where the equation has
// solutions too.
void Touch::followSlots() {
  constexpr double kWellAbove = 0.25;  // of r
  std::array<ShellContact, kMaxSurfaceContacts> others;
  int other_count = 0;
  for (int slot = 0; slot < kMaxSurfaceContacts; ++slot) {
    if (!isUsed(slot)) continue;
    was_used_ = true;
    if (keptIn(slot).fades) {
      lose(slot);
      continue;
    }
    const Foot start = footOf(slot);
    const ShellContact contact = follow(start);
    cost_.iterations += contact.cost.steps;
    cost_.longest_walk = std::max(cost_.longest_walk, contact.cost.steps);
    cost_.crossings += contact.cost.crossings;
    const bool is_other_side = contact.converged && contact.h < 0 && tangentContact(s_.net, cache_, C_, start).h > kWellAbove * r_;
    if (!contact.converged || is_other_side || isListed(contact)) {
      lose(slot);
    } else if (continues(keptIn(slot), contact)) {
      list_[at(count_++)] = {contact, slot, false, false, std::max(0.0, keptIn(slot).ease - moved_)};
    } else {
      lose(slot);
      others[at(other_count++)] = contact;
    }
  }
  for (int i = 0; i < other_count; ++i) {
    if (!isListed(others[at(i)])) addNew(others[at(i)]);
  }
}

// Whether the contact is the slot's moved on, or another one that the walk has slid down to.
bool Touch::continues(const SurfaceSlot& kept, const ShellContact& contact) const {
  constexpr double kSteepest = 10;  // change of overlap per way of the centre, beyond what any hollow that the finger fits into gives
  constexpr double kStill = 1e-5;   // of r
  const double before = r_ - (tracker_.p_BC_last - kept.p_BS).dot(kept.n_B), now = r_ - contact.h;
  if (!eases_ || before <= 0 || now <= 0) return true;
  return (now * contact.n - before * kept.n_B).norm() <= kSteepest * moved_ + kStill * r_;
}

void Touch::lose(int slot) { lost_[at(lost_count_++)] = slot; }

// What was lost in overlap stands for its plane, and gives way as the finger moves.
void Touch::fadeLost() {
  for (int i = 0; i < lost_count_ && count_ < kMaxSurfaceContacts; ++i) {
    const int slot = lost_[at(i)];
    if (isTaken(slot)) continue;
    Followed plane{planeOf(slot), slot, false, true, keptIn(slot).ease + moved_};
    if (!(plane.shown() < r_)) continue;
    list_[at(count_++)] = plane;
    status_ |= kQueryEased;
  }
}

// Without any contact left: a place on the side that the finger is on, or none.
void Touch::findLost() {
  constexpr double kSameDepth = 0.5;  // of r
  const int slot = lost_[0];
  const ShellContact plane = planeOf(slot);
  if (plane.h + keptIn(slot).ease >= r_) {
    lost_count_ = 0;
    return;
  }
  const auto isSameSide = [&](const ShellContact& c) { return c.n.dot(plane.n) > 0 && std::abs(c.h - plane.h) < kSameDepth * r_; };
  addFurther();
  Followed* const end = list_.data() + count_;
  const Followed* const found = std::find_if(list_.data(), end, [&](const Followed& c) { return isSameSide(c.contact); });
  count_ = found == end ? 0 : 1;
  if (count_ == 1) list_[0] = *found;
  if (count_ == 0) {
    const SurfaceSeed seed = s_.search.nearest(s_.net, cache_, C_, reach_, Facing::front);
    ShellContact nearest;
    if (seed.found) nearest = follow(seed.foot);
    if (seed.found && (!nearest.converged || !isSameSide(nearest))) nearest = straightTo(seed);
    if (!nearest.converged || !isSameSide(nearest)) return hold(slot);
    addNew(nearest);
  }
  status_ |= kQueryReseeded;
  ++cost_.reseeds;
}

// Its plane stays, whole.
void Touch::hold(int slot) {
  list_[at(count_++)] = {planeOf(slot), slot, false, false, keptIn(slot).ease};
  lost_count_ = 0;
  status_ |= kQueryHeldDirection;
  ++cost_.held;
}

// In free space the nearest place is the contact, whatever was followed.
void Touch::takeNearest() {
  const ShellContact nearest = nearestWithin(nearestHeight());
  if (count_ > 0 && (!nearest.converged || isListed(nearest))) return;
  if (count_ == kMaxSurfaceContacts) --count_;
  addNew(nearest);
  if (nearest.converged) return;
  status_ |= kQueryHeldDirection;
  ++cost_.held;
}

// The nearest solution; not converged if there is none nearer than `bound`. In free space a seed that leads to no solution as near (shading
// normals may point past the nearest place by a few degrees) stands for itself: far from contact the distance counts, not the direction.
ShellContact Touch::nearestWithin(double bound) const {
  constexpr double kStrayed = 2.5e-3;  // of r
  const SurfaceSeed seed = s_.search.nearest(s_.net, cache_, C_, bound, tracker_.has_centre ? Facing::front : Facing::both);
  if (!seed.found) return {};
  ShellContact contact = follow(seed.foot);
  const bool strayed = !contact.converged || std::abs(contact.h) > seed.distance + kStrayed * r_;
  if (strayed && seed.distance > r_) return straightTo(seed);
  if (!contact.converged) contact = tangentContact(s_.net, cache_, C_, seed.foot);
  contact.converged = contact.converged && std::abs(contact.h) < bound;
  return contact;
}

// Contact with the place itself, whatever the normal there.
ShellContact Touch::straightTo(const SurfaceSeed& seed) const {
  const PatchPoint x = evaluate(s_.net.cell(seed.foot.triangle, cache_).patch, seed.foot.b[1], seed.foot.b[2]);
  const double sign = (C_ - x.S).dot(x.N) < 0 ? -1 : 1;
  return {seed.foot, sign / seed.distance * (C_ - x.S), sign * seed.distance, seed.distance > 0, {}};
}

void Touch::addFurther() {
  tracker_.vouched = 0;
  const bool is_all = s_.search.visitMinima(
      s_.net, C_, reach_, kAround * r_, [&](std::int32_t triangle, const PatchBounds& part) { return isKnown(triangle, part); },
      [&](const Foot& foot) {
        if (seen_count_ < kMaxTries) tryPlace(foot);
        return seen_count_ < kMaxTries;
      });
  if (!is_all || lost_count_ > 0) return;
  tracker_.p_BC_searched = C_;
  tracker_.vouched = kAround * r_;
  tracker_.reach = reach_;
}

// The last look for further places found all that there are here too.
bool Touch::isVouched() const {
  return lost_count_ == 0 && (C_ - tracker_.p_BC_searched).norm() + std::max(0.0, reach_ - tracker_.reach) < tracker_.vouched;
}

// Whether a contact is known that stands for this patch: beside it, with a normal that the patch's could be. (Not any of its cone's: along a
// groove that holds the other wall's.)
bool Touch::isKnown(std::int32_t triangle, const PatchBounds& part) const {
  const double beside = std::max<double>(part.radius, kAround * r_) + part.radius;
  const auto stands = [&](const Foot& other, const Vec3& S, const Vec3& n) {
    if (other.triangle == triangle || isOnFeatureOf(s_.net, other, triangle)) return true;
    return (S - part.middle()).squaredNorm() < beside * beside && closestNormal(s_.net, triangle, n) > kBesideKnown;
  };
  for (int i = 0; i < count_; ++i) {
    const ShellContact& c = list_[at(i)].contact;
    if (!list_[at(i)].fades && stands(c.foot, placeOf(c), c.n)) return true;
  }
  for (int i = 0; i < seen_count_; ++i) {
    if (stands(seen_[at(i)].foot, seen_[at(i)].S, seen_[at(i)].n)) return true;
  }
  return false;
}

void Touch::tryPlace(const Foot& foot) {
  const ShellContact candidate = follow(foot);
  seen_[at(seen_count_++)] = {candidate.foot, placeOf(candidate), candidate.n};
  if (candidate.converged && candidate.h > 0 && candidate.h < reach_ && isNew(candidate)) keepDeepestFurther(candidate);
}

bool Touch::isNew(const ShellContact& candidate) const {
  const Vec3 S = placeOf(candidate);
  for (int i = 0; i < count_; ++i) {
    if (!list_[at(i)].fades && list_[at(i)].contact.n.dot(candidate.n) > kApart) return false;
  }
  const bool is_on_face = *std::min_element(candidate.foot.b.begin(), candidate.foot.b.end()) > 0;
  const PatchPoint x = evaluate(s_.net.cell(candidate.foot.triangle, cache_).patch, candidate.foot.b[1], candidate.foot.b[2]);
  if (is_on_face && !isStable(x, C_)) return false;
  constexpr double kShort = 0.95;  // of the way: a patch may bulge out of its triangle
  if (tracker_.has_centre && (tracker_.p_BC - S).dot(candidate.n) <= 0) return false;
  return !s_.search.isHidden(s_.net, C_, C_ + kShort * (S - C_));
}

// Followed contacts stay; of further ones the deepest do.
void Touch::keepDeepestFurther(const ShellContact& candidate) {
  if (count_ < kMaxSurfaceContacts) return addNew(candidate);
  status_ |= kQueryContactsDropped;
  for (int i = 0; i < count_; ++i) {
    Followed& other = list_[at(i)];
    if (!other.is_new || other.contact.h <= candidate.h) continue;
    other.contact = candidate;
    other.ease = easeOfNew(candidate);
    return;
  }
}

// One that nothing is followed in, if there is; what fades yields.
int Touch::freeSlot() const {
  int spare = -1;
  for (int slot = 0; slot < kMaxSurfaceContacts; ++slot) {
    if (isTaken(slot)) continue;
    if (std::find(lost_.begin(), lost_.begin() + lost_count_, slot) == lost_.begin() + lost_count_) return slot;
    spare = slot;
  }
  return spare;
}

SurfaceContacts Touch::write() {
  std::sort(list_.begin(), list_.begin() + count_,
            [](const Followed& a, const Followed& b) { return a.shown() < b.shown() || (a.shown() == b.shown() && a.slot < b.slot); });
  SurfaceContacts found;
  tracker_.slots = {};
  for (int i = 0; i < count_; ++i) {
    const Followed& f = list_[at(i)];
    if (i > 0 && f.shown() >= reach_) {
      tracker_.vouched = 0;  // it may come back at once
      continue;
    }
    const ShellContact& c = f.contact;
    tracker_.slots[at(f.slot)] = {c.foot.triangle, f.fades, c.foot.b[1], c.foot.b[2], f.ease, placeOf(c), c.n};
    found.points[at(found.count++)] = {placeOf(c), c.n, f.shown() - r_, static_cast<std::uint32_t>(f.slot)};
    if (f.ease > 0) status_ |= kQueryEased;
  }
  const ShellContact& main = list_[0].contact;
  if (main.h > 0) {
    tracker_.p_BC = C_;
    tracker_.has_centre = true;
  } else if (main.h <= 0 && tracker_.has_centre) {
    tracker_.p_BC = placeOf(main) + r_ * main.n;
  }
  tracker_.p_BC_last = C_;
  tracker_.status = status_;
  found.cost = cost_;
  return found;
}

}  // namespace

SurfaceContacts touchSurface(const TouchedSurface& surface, const Vec3& p_BC, double r, double margin, SurfaceTracker& tracker,
                             PatchCache& cache) {
  SurfaceContacts found = Touch(surface, p_BC, r, margin, tracker, cache).run();
  if (surface.variant == SurfaceVariant::force) shadeForce(surface.net, tracker, found);
  return found;
}

}  // namespace pincer::contact
