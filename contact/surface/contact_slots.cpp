#include "contact/surface/contact_slots.h"

#include <algorithm>
#include <limits>

#include "contact/surface/flat_contact.h"
#include "contact/surface/shell_face.h"
#include "contact/surface/surface_variant.h"

namespace pincer::contact {

namespace {

constexpr int kMaxTries = 16;          // places from which a further contact is looked for, per query
constexpr double kOnePlace = 1e-3;     // of r: contacts nearer than this are one
constexpr double kApart = 0.998;       // cosine of 3.6 degrees: further contacts differ by more in their normals
constexpr double kBesideSeen = 0.966;  // cosine of 15 degrees: a normal that far out of a patch's cone still belongs to it

// Where a try has led.
struct Seen {
  Foot foot;
  Vec3 S, n;
};

struct Followed {
  ShellContact contact;
  int slot = -1;
  bool is_new = false;
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

class Touch {
 public:
  Touch(const TouchedSurface& surface, const Vec3& C, double r, double margin, SurfaceTracker& tracker, PatchCache& cache)
      : s_(surface), C_(C), r_(r), reach_(r + margin), tracker_(tracker), cache_(cache) {}

  SurfaceContacts run() {
    followSlots();
    if (!touches()) takeNearest();
    if (nearestHeight() < reach_) addFurther();
    if (lost_ >= 0) holdLost();
    return write();
  }

 private:
  void followSlots();
  void holdLost();
  void takeNearest();
  void takeOrHold(const ShellContact& nearest);
  ShellContact nearestWithin(double bound) const;
  void addFurther();
  void tryPlace(const Foot& foot);
  bool isNew(const ShellContact& candidate) const;
  bool isSeen(const Foot& foot, double radius) const;
  void keepDeepestFurther(const ShellContact& candidate);
  SurfaceContacts write();

  bool touches() const { return nearestHeight() < r_; }
  double nearestHeight() const {
    double h = kInfinity;
    for (int i = 0; i < count_; ++i) h = std::min(h, list_[at(i)].contact.h);
    return h;
  }
  Vec3 placeOf(const ShellContact& c) const { return C_ - c.h * c.n; }
  ShellContact follow(const Foot& foot) const { return followContact(s_.variant, s_.net, cache_, C_, r_, foot); }
  Foot footOf(int slot) const {
    const SurfaceSlot& kept = tracker_.slots[at(slot)];
    return {kept.triangle, {std::max(0.0, 1 - kept.u - kept.v), kept.u, kept.v}};
  }
  bool isUsed(int slot) const {
    const std::int32_t triangle = tracker_.slots[at(slot)].triangle;
    return triangle >= 0 && triangle < s_.net.size();
  }
  static std::size_t at(int i) { return static_cast<std::size_t>(i); }
  bool isListed(const ShellContact& contact) const {
    return std::any_of(list_.data(), list_.data() + count_,
                       [&](const Followed& other) { return (placeOf(other.contact) - placeOf(contact)).norm() < kOnePlace * r_; });
  }
  void add(const ShellContact& contact, int slot, bool is_new) { list_[at(count_++)] = {contact, slot, is_new}; }
  int freeSlot() const;

  const TouchedSurface& s_;
  const Vec3 C_;
  const double r_, reach_;
  SurfaceTracker& tracker_;
  PatchCache& cache_;

  std::array<Followed, kMaxSurfaceContacts> list_;
  int count_ = 0;
  int lost_ = -1;  // a slot whose contact has lost its solution
  std::uint32_t status_ = kQueryOk;
  QueryCost cost_;

  std::array<Seen, kMaxTries> seen_;  // where tries have led
  int seen_count_ = 0;
};

// A centre that begins well above the surface and ends below it has been led to the far side of the body, where the equation has
// solutions too.
void Touch::followSlots() {
  constexpr double kWellAbove = 0.25;  // of r
  for (int slot = 0; slot < kMaxSurfaceContacts; ++slot) {
    if (!isUsed(slot)) continue;
    const Foot start = footOf(slot);
    const ShellContact contact = follow(start);
    cost_.iterations += contact.cost.steps;
    cost_.crossings += contact.cost.crossings;
    const bool is_other_side = contact.converged && contact.h < 0 && tangentContact(s_.net, cache_, C_, start).h > kWellAbove * r_;
    if (!contact.converged || is_other_side) {
      if (lost_ < 0) lost_ = slot;
      continue;
    }
    if (!isListed(contact)) add(contact, slot, false);
  }
}

// One of several that has lost its solution, unless the search for further contacts has found it again.
void Touch::holdLost() {
  constexpr double kSameNormal = 0.9;  // cosine
  const ShellContact held = tangentContact(s_.net, cache_, C_, footOf(lost_));
  for (int i = 0; i < count_; ++i) {
    if (!list_[at(i)].is_new || list_[at(i)].contact.n.dot(held.n) < kSameNormal) continue;
    status_ |= kQueryReseeded;
    ++cost_.reseeds;
    return;
  }
  if (!(held.h < r_) || count_ == kMaxSurfaceContacts) return;
  add(held, lost_, false);
  status_ |= kQueryHeldDirection;
  ++cost_.held;
}

// In free space the nearest place is the contact, whatever was followed.
void Touch::takeNearest() {
  ShellContact nearest = nearestWithin(nearestHeight());
  if (count_ == 0) return takeOrHold(nearest);
  if (!nearest.converged || isListed(nearest)) return;
  if (count_ == kMaxSurfaceContacts) --count_;
  add(nearest, freeSlot(), true);
}

// A contact that was lost may come back on its own side only: the far side of a thin wall is as near as this one.
void Touch::takeOrHold(const ShellContact& nearest) {
  constexpr double kSameDepth = 0.5;  // of r
  const bool was_followed = lost_ >= 0;
  const ShellContact held = tangentContact(s_.net, cache_, C_, was_followed ? footOf(lost_) : nearest.foot);
  const auto isSameSide = [&](const ShellContact& c) {
    return !was_followed || held.h >= r_ || (c.n.dot(held.n) > 0 && std::abs(c.h - held.h) < kSameDepth * r_);
  };
  ShellContact found = nearest;
  if (!nearest.converged || !isSameSide(nearest)) {
    addFurther();
    Followed* const end = list_.data() + count_;
    const Followed* const other = std::find_if(list_.data(), end, [&](const Followed& c) { return isSameSide(c.contact); });
    found = other == end ? held : other->contact;
    count_ = 0;
  }
  add(found, was_followed ? lost_ : 0, false);
  lost_ = -1;
  if (!found.converged) {
    status_ |= kQueryHeldDirection;
    ++cost_.held;
  } else if (was_followed) {
    status_ |= kQueryReseeded;
    ++cost_.reseeds;
  }
}

// The nearest solution; not converged if there is none nearer than `bound`. In free space a seed that leads to no solution as near (shading
// normals may point past the nearest place by a few degrees) stands for itself: far from contact the distance counts, not the direction.
ShellContact Touch::nearestWithin(double bound) const {
  constexpr double kStrayed = 2.5e-3;  // of r
  const SurfaceSeed seed = s_.search.nearest(s_.net, cache_, C_, bound, tracker_.has_centre ? Facing::front : Facing::both);
  if (!seed.found) return {};
  ShellContact contact = follow(seed.foot);
  const bool strayed = !contact.converged || std::abs(contact.h) > seed.distance + kStrayed * r_;
  if (strayed && seed.distance > r_) {
    const PatchPoint x = evaluate(s_.net.cell(seed.foot.triangle, cache_).patch, seed.foot.b[1], seed.foot.b[2]);
    const double sign = (C_ - x.S).dot(x.N) < 0 ? -1 : 1;
    return {seed.foot, sign / seed.distance * (C_ - x.S), sign * seed.distance, true, {}};
  }
  contact.converged = contact.converged && std::abs(contact.h) < bound;
  return contact;
}

void Touch::addFurther() {
  s_.search.visitMinima(s_.net, C_, reach_, [&](const Foot& foot, double radius) {
    if (!isSeen(foot, radius)) tryPlace(foot);
    return seen_count_ < kMaxTries;
  });
}

// Whether a contact is known that stands for this place: beside it, with a normal that the patch's could be.
bool Touch::isSeen(const Foot& foot, double radius) const {
  constexpr double kBeside = 2;  // radii of the patch
  Vec3 p = Vec3::Zero();
  for (int i = 0; i < 3; ++i) p += foot.b[at(i)] * s_.net.vertex(foot.triangle, i);
  const auto stands = [&](const Foot& other, const Vec3& S, const Vec3& n) {
    if (other.triangle == foot.triangle || isOnFeatureOf(s_.net, other, foot.triangle)) return true;
    const double reach = kBeside * radius;
    if ((S - p).squaredNorm() > reach * reach) return false;
    double closest = -1;
    for (int i = 0; i < 3; ++i) closest = std::max(closest, s_.net.normal(foot.triangle, i).dot(n));
    return closest > kBesideSeen;
  };
  for (int i = 0; i < count_; ++i) {
    const ShellContact& c = list_[at(i)].contact;
    if (stands(c.foot, placeOf(c), c.n)) return true;
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
    if (list_[at(i)].contact.n.dot(candidate.n) > kApart) return false;
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
  if (count_ < kMaxSurfaceContacts) return add(candidate, freeSlot(), true);
  status_ |= kQueryContactsDropped;
  for (int i = 0; i < count_; ++i) {
    if (!list_[at(i)].is_new || list_[at(i)].contact.h <= candidate.h) continue;
    list_[at(i)].contact = candidate;
    return;
  }
}

int Touch::freeSlot() const {
  for (int slot = 0; slot < kMaxSurfaceContacts; ++slot) {
    bool is_taken = slot == lost_;
    for (int i = 0; i < count_; ++i) is_taken |= list_[at(i)].slot == slot;
    if (!is_taken) return slot;
  }
  return lost_;
}

SurfaceContacts Touch::write() {
  std::sort(list_.begin(), list_.begin() + count_, [](const Followed& a, const Followed& b) {
    return a.contact.h < b.contact.h || (a.contact.h == b.contact.h && a.slot < b.slot);
  });
  SurfaceContacts found;
  tracker_.slots = {};
  for (int i = 0; i < count_; ++i) {
    const auto& [contact, slot, is_new] = list_[at(i)];
    if (i > 0 && contact.h >= reach_) continue;
    tracker_.slots[at(slot)] = {contact.foot.triangle, contact.foot.b[1], contact.foot.b[2]};
    found.points[at(found.count++)] = {placeOf(contact), contact.n, contact.h - r_, static_cast<std::uint32_t>(slot)};
  }
  const ShellContact& main = list_[0].contact;
  if (main.h > 0) {
    tracker_.p_BC = C_;
    tracker_.has_centre = true;
  } else if (main.h <= 0 && tracker_.has_centre) {
    tracker_.p_BC = placeOf(main) + r_ * main.n;
  }
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
