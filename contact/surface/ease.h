// ease: the up to three contacts of one finger by name, from query to query, so that none begins or ends its push at
// once. It knows no mesh: of a contact it asks name, place, normal and gap, and of the finger its way.
//
//   phi_i = h_i - r + e_i,   h_i = (C - S_i) . n_i
//
//   C  finger's centre [m], S_i, n_i  place and unit normal of contact i [m, -], frame B
//   r  finger's radius [m],  e_i >= 0  the contact's ease [m]
//
// - Two contacts that have moved to one place are one. A contact whose overlap changes by more than it can (d / h of
//   the way around an edge, d its depth; by less on anything rounder and in hollows that the finger fits into) hasn't
//   moved but slid down to another place: it is lost, and that place is another contact's, or a new one.
// - Ease. Places that face a finger that is pressed into a hollow tighter than itself come, go and swap while they
//   overlap (where two meet at a fold of the distance). A contact that comes so begins at phi = 0, e = its depth; its
//   ease shrinks by as much as the centre moves. One that goes so stays as a plane, and its ease grows by as much,
//   until it has faded; two that fade are joined, to push as both did, where a new one needs the room. A finger whose
//   contacts all have phi >= 0, as those of grasp/, meets no such place: the way down from it leads to one nearer than
//   it, so it lies at phi > 0. Nothing is eased where the centre leaps by more than half of r in one query.
// - Where more than three places are near, one that isn't touched yields to one that is clearly nearer; those that are
//   touched stay.
#pragma once
#include <algorithm>

#include "pincer/contact/surface/shell_contact.h"
#include "pincer/contact/surface/short_list.h"
#include "pincer/contact/surface_contact.h"

namespace pincer::contact {

// A finger's ball in one query.
struct TouchingBall {
  Vec3 C;        // its centre [m]
  Vec3 C_last;   // at the last query [m]
  double r;      // its radius [m]
  double moved;  // |C - C_last| [m]
  double shown;  // how near to the centre contacts have to be to be reported [m]
  double reach;  // and to be followed [m], >= shown
  double turn;   // the way within which each place is tried once [m]; 0: in every query
  bool eases;    // false: contacts come and go as they are found

  Vec3 placeOf(const ShellContact& c) const { return C - c.h * c.n; }
};

struct FollowedContact {
  ShellContact contact;
  int slot = -1;
  bool is_new = false;
  bool fades = false;
  double ease = 0;  // [m]

  double shown() const { return contact.h + ease; }
};

class EasedContacts {
 public:
  using List = ShortList<FollowedContact, kMaxSurfaceContacts>;

  EasedContacts(const TouchingBall& ball, std::array<SurfaceSlot, kMaxSurfaceContacts>& slots)
      : ball_(ball), slots_(slots) {}

  // Takes what the slots' contacts have become. Each slot in use is told of once, then settle(). Not converged is lost.
  void moveOn(int slot, const ShellContact& contact);
  void lose(int slot);
  void settle();
  // `contact`, but from the other side where the centre passed from in front of the plane across an edge's normal to
  // behind it: beside a fin the finger was caught between the edge and itself, or lost it.
  ShellContact onItsSide(const SurfaceSlot& kept, const ShellContact& contact) const;
  // True if the contact is the slot's moved on.
  bool continues(const SurfaceSlot& kept, const ShellContact& contact) const;

  const List& list() const { return list_; }
  const SurfaceSlot& kept(int slot) const { return slots_[static_cast<std::size_t>(slot)]; }
  bool hasHistory() const { return had_contacts_; }  // the last query had contacts
  bool hasLost() const { return !lost_.empty(); }
  bool isAlone() const { return lost_.empty() && list_.size() == 1 && !list_.front().fades; }
  bool follows() const {
    return isAny([](const FollowedContact&) { return true; });
  }
  // The normal of the contact that is followed in that slot; zero without one.
  Vec3 normalIn(int slot) const {
    for (const FollowedContact& f : list_) {
      if (f.slot == slot && !f.fades) return f.contact.n;
    }
    return Vec3::Zero();
  }
  bool touches() const { return nearestHeight() < ball_.r; }
  double nearestHeight() const;  // [m]
  double heightToYield() const;  // of the highest that leaves its slot to a nearer one, all slots taken; 0 without [m]
  bool isListed(const ShellContact& contact) const;
  // True if `is(f)` for any that is followed, not fading.
  template <class Is>
  bool isAny(Is&& is) const {
    return std::any_of(list_.begin(), list_.end(), [&](const FollowedContact& f) { return !f.fades && is(f); });
  }

  // A further contact. Where no slot is left the highest goes that may and is clearly higher, or it isn't taken.
  void admit(const ShellContact& contact);
  // The nearest place of all, whatever has to go for it.
  void admitNearest(const ShellContact& contact);
  // The slot's contact is this one now; or stays the plane that it was.
  void keep(int slot, const ShellContact& contact) { list_.push_back({contact, slot, false, false, easeNow(slot)}); }
  void hold(int slot) { list_.push_back({planeOf(slot), slot, false, false, kept(slot).ease}); }

  // Of the lost ones, of which there are some: the deepest, as a plane.
  int deepestLost() const;
  ShellContact planeOf(int slot) const;
  bool pushes(int lost) const { return !(heightOfLost(lost) + ball_.moved >= ball_.r); }
  void forgetLost() { lost_.clear(); }
  void fadeLost();
  void clear() { list_.clear(); }

  // Writes the slots, and those that are near enough to `found`, the deepest first; status gets kQueryEased.
  void answer(SurfaceContacts& found, std::uint32_t& status);

 private:
  SurfaceSlot& slotAt(int slot) { return slots_[static_cast<std::size_t>(slot)]; }
  // How high the centre was over it at the last query [m].
  double heightBefore(const SurfaceSlot& kept) const { return (ball_.C_last - kept.p_BS).dot(kept.n_B); }
  // How high it is over what a lost slot stands for, as far as that has been eased away [m].
  double heightOfLost(int slot) const { return planeOf(slot).h + kept(slot).ease; }
  double easeOfNew(const ShellContact& contact) const;
  double easeNow(int slot) const { return std::max(0.0, kept(slot).ease - ball_.moved); }
  void addNew(const ShellContact& contact);
  bool mayYield(const FollowedContact& f) const { return f.is_new || (!f.fades && f.shown() > ball_.r); }
  bool isTaken(int slot) const;
  bool isFading(int slot) const;
  bool hasFreeSlot() const;
  int spareSlot() const;
  int takeSlot();
  void join(int slot, int other);

  const TouchingBall& ball_;
  std::array<SurfaceSlot, kMaxSurfaceContacts>& slots_;
  List list_;
  ShortList<int, kMaxSurfaceContacts> lost_;  // slots whose contacts have lost their solutions
  ShortList<ShellContact, kMaxSurfaceContacts> slid_;
  bool had_contacts_ = false;
};

}  // namespace pincer::contact
