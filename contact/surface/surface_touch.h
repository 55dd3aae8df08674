// surface_touch: one query of a finger on a surface, from the slots that it finds to those that it leaves (contact_slots.h).
//
// contact_slots.cpp follows what the slots hold, eases what comes and goes, and writes the slots back; further_contacts.cpp looks for
// further places (near_parts.h).
#pragma once
#include <algorithm>

#include "pincer/contact/surface/contact_slots.h"
#include "pincer/contact/surface/short_list.h"
#include "pincer/contact/surface/surface_variant.h"
#include "pincer/contact/surface/turns.h"

namespace pincer::contact {

constexpr int kMaxTries = 16;       // places from which a further contact is looked for, per query; the others' turn comes in the next
constexpr int kMostWalked = 32;     // steps and crossings of their walks, likewise; the last walk is ended whatever it takes
constexpr double kOnePlace = 1e-3;  // of r: contacts nearer than this are one
constexpr double kTurn = 1.0 / 16;  // of r: the way within which each place is tried once
constexpr double kLeap = 0.5;       // of r per query, 4 m/s of a finger of 8 mm at 1 kHz: the centre was put there, not led

// Where a try has led.
struct TriedPlace {
  Foot foot;
  Vec3 S, n;
};

struct FollowedContact {
  ShellContact contact;
  int slot = -1;
  bool is_new = false;
  bool fades = false;
  double ease = 0;  // [m]

  double shown() const { return contact.h + ease; }
};

class SurfaceTouch {
 public:
  SurfaceTouch(const TouchedSurface& surface, const Vec3& C, double r, double margin, SurfaceTracker& tracker, PatchCache& cache)
      : s_(surface),
        C_(C),
        r_(r),
        turn_(surface.variant == SurfaceVariant::smooth ? kTurn * r : 0),
        shown_(r + margin),
        reach_(shown_ + turn_),
        moved_((C - tracker.p_BC_last).norm()),
        gone_(tracker.gone + moved_ + std::max(0.0, reach_ - tracker.reach)),
        eases_(surface.variant == SurfaceVariant::smooth && !(moved_ > kLeap * r)),
        tracker_(tracker),
        cache_(cache) {}

  SurfaceContacts run() {
    SurfaceContacts found;
    if (followAlone(found)) return found;
    followSlots();
    if (list_.empty() && !lost_.empty()) findLost();
    if (!(nearestHeight() < reach_) && lost_.empty()) takeNearest();
    if (eases_) fadeLost();
    if (nearestHeight() < reach_) addFurther();
    write(found);
    return found;
  }

 private:
  bool followAlone(SurfaceContacts& found);
  void followSlots();
  ShellContact keepSide(const SurfaceSlot& kept, const ShellContact& contact) const;
  bool isOtherSide(int slot, const ShellContact& contact) const;
  bool continues(const SurfaceSlot& kept, const ShellContact& contact) const;
  void lose(int slot);
  void fadeLost();
  void findLost();
  void leanOnBorder(int slot);
  void hold(int slot);
  void takeNearest();
  ShellContact nearestWithin(double bound);
  ShellContact straightTo(const SurfaceSeed& seed) const;
  void addFurther();
  void tryPlace(const Foot& foot);
  ShellContact followUntilKnown(const Foot& foot);
  bool isNew(const ShellContact& candidate) const;
  bool stands(const Foot& foot, const Vec3& S, const Vec3& n, std::int32_t triangle, const PatchBounds& part) const;
  bool isFollowed(std::int32_t triangle, const PatchBounds& part) const;
  bool wasSeen(std::int32_t triangle, const PatchBounds& part) const;
  double wayFrom(const SurfaceLook& look) const { return (C_ - look.p_BC).norm() + std::max(0.0, reach_ - look.reach); }
  double wayFromLook() const { return wayFrom(tracker_.look); }
  bool isLookGood() const;
  bool isLookGoodFor(int slot, const Vec3& n) const;
  bool isVouched() const;
  bool isNothingDue();
  bool isLookEnding() const;
  static bool staysOn(const SurfaceLook& look, int slot, const Vec3& n);
  bool isAlone() const;
  bool lookAlone();
  void lookAround();
  void lookAhead();
  LookParts& lookParts();
  bool takeAhead();
  SurfaceLook lookFrom(const Vec3& p_BC) const;
  SurfaceLook lookAtEnd() const;
  bool turnsSlowly(const ShellContact& contact) const;
  NearParts& nearParts();
  double goneAt(const SurfaceLook& look) const { return gone_ - wayFrom(look); }
  double wayTo(std::int32_t place, const PatchBounds& part) const;
  void examineDue(NearParts& near);
  void examineTurns(NearParts& near, bool are_all);
  bool hasTriedEnough() const;
  void examine(const Turns& turns, NearPart& part);
  bool isEveryonesTurn() const;
  double reachOfTry(bool has_turn) const;
  bool hasTurnedHalf(int slot, const Vec3& n) const;
  void keepDeepestFurther(const ShellContact& candidate);
  void write(SurfaceContacts& found);
  void keepCentre(const ShellContact& main);
  void keepParts();

  bool touches() const { return nearestHeight() < r_; }
  double nearestHeight() const {
    double h = kInfinity;
    for (const FollowedContact& f : list_) h = f.fades ? h : std::min(h, f.contact.h);
    return h;
  }
  Vec3 placeOf(const ShellContact& c) const { return C_ - c.h * c.n; }
  ShellContact follow(const Foot& foot) const { return followContact(s_.variant, s_.net, cache_, C_, r_, foot); }
  ShellContact followSlot(int slot, const Foot& start) const {
    const SurfaceSlot& kept = keptIn(slot);
    if (s_.variant != SurfaceVariant::smooth || !knowsMotion(kept)) return follow(start);
    const ShellContact beside = solveShellBeside(s_.net, cache_, C_, start, {kept.du, kept.dv}, C_ - tracker_.p_BC_last);
    return beside.converged ? beside : follow(start);
  }
  static bool knowsMotion(const SurfaceSlot& slot) { return slot.du != Vec3(Vec3::Zero()); }
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
  // How high the centre was over it at the last query [m].
  double heightBefore(const SurfaceSlot& kept) const { return (tracker_.p_BC_last - kept.p_BS).dot(kept.n_B); }
  static std::size_t at(int i) { return static_cast<std::size_t>(i); }
  // True if a contact leaves its slot to a nearer one.
  bool mayYield(const FollowedContact& f) const { return f.is_new || (!f.fades && f.shown() > r_); }
  bool follows() const {
    return std::any_of(list_.begin(), list_.end(), [](const FollowedContact& f) { return !f.fades; });
  }
  bool isListed(const ShellContact& contact) const {
    return std::any_of(list_.begin(), list_.end(), [&](const FollowedContact& other) {
      return !other.fades && (placeOf(other.contact) - placeOf(contact)).norm() < kOnePlace * r_;
    });
  }
  // Its overlap beyond the way that the finger can have come closer [m].
  double easeOfNew(const ShellContact& contact) const { return eases_ && was_used_ ? std::max(0.0, r_ - contact.h - moved_) : 0; }
  void addNew(const ShellContact& contact) { list_.push_back({contact, takeSlot(), true, false, easeOfNew(contact)}); }
  int takeSlot();
  bool hasFreeSlot() const;
  int spareSlot() const;
  void joinFading(int slot, int other);
  int deepestLost() const;
  // How high the centre is over what a lost slot stands for, as far as it has been eased away [m].
  double lostHeight(int slot) const { return planeOf(slot).h + keptIn(slot).ease; }
  // True if a slot that was lost still pushes, and nothing has taken it.
  bool isFading(int slot) const {
    return std::find(lost_.begin(), lost_.end(), slot) != lost_.end() && !isTaken(slot) && lostHeight(slot) + moved_ < r_;
  }
  bool isTaken(int slot) const {
    return std::any_of(list_.begin(), list_.end(), [&](const FollowedContact& f) { return f.slot == slot; });
  }

  const TouchedSurface& s_;
  const Vec3 C_;
  const double r_;
  const double turn_;   // the centre's way within which each place is tried [m]
  const double shown_;  // how near contacts have to be to be reported [m]
  const double reach_;  // and to be followed: by a turn further, so that what comes from outside is known by then [m]
  const double moved_;  // the centre since the last query [m]
  const double gone_;   // SurfaceTracker::gone here
  const bool eases_;  // the other variants show what they do at edges: jump; after a leap of the centre there is nothing to be steady with
  SurfaceTracker& tracker_;
  PatchCache& cache_;
  bool was_used_ = false;  // the last query had contacts

  ShortList<FollowedContact, kMaxSurfaceContacts> list_;
  ShortList<int, kMaxSurfaceContacts> lost_;  // slots whose contacts have lost their solutions
  std::uint32_t status_ = kQueryOk;
  QueryCost cost_;

  ShortList<TriedPlace, kMaxTries> seen_;  // where tries have led
  int walked_ = 0;                         // steps and crossings on the way
};

}  // namespace pincer::contact
