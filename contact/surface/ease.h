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
#include "pincer/contact/surface_contact.h"

namespace pincer::contact {

// A finger's ball in one query.
struct TouchingBall {
  Vec3 C;        // its centre [m]
  Vec3 C_last;   // at the last query [m]
  double r;      // its radius [m]
  double moved;  // |C - C_last| [m]
  double gone;   // and by how much `reach` has grown [m]
  double shown;  // how near to the centre contacts have to be to be told of [m]
  double reach;  // and to be followed [m], >= shown
  double turn;   // the way within which each place is tried once [m]; 0: in every query
  bool eases;    // false: contacts come and go as they are found

  Vec3 placeOf(const ShellContact& c) const { return C - c.h * c.n; }
  // How high the centre was over the slot's contact at the last query [m].
  double heightBefore(const SurfaceSlot& kept) const { return (C_last - kept.p_BS).dot(kept.n_B); }
  // True if the contact is the slot's moved on.
  bool continues(const SurfaceSlot& kept, const ShellContact& contact) const;
};

// A slot's contact in this query.
struct HeldContact {
  enum class State : std::uint8_t { none, followed, fades };

  State state = State::none;
  bool is_new = false;
  double ease = 0;       // [m]
  ShellContact contact;  // of one that fades: the plane that it was

  bool isFollowed() const { return state == State::followed; }
  double shown() const { return contact.h + ease; }
};

class EasedContacts {
 public:
  EasedContacts(const TouchingBall& ball, std::array<SurfaceSlot, kMaxSurfaceContacts>& slots)
      : ball_(ball), slots_(slots) {}

  // Takes what the contact of a slot in use has become; not converged is lost.
  void moveOn(int slot, const ShellContact& contact);
  void lose(int slot);
  // `contact`, but from the other side where the centre passed from in front of the plane across an edge's normal to
  // behind it: beside a fin the finger was caught between the edge and itself, or lost it.
  ShellContact onItsSide(const SurfaceSlot& kept, const ShellContact& contact) const;
  const SurfaceSlot& kept(int slot) const { return slots_[static_cast<std::size_t>(slot)]; }
  const HeldContact& at(int slot) const { return held_[static_cast<std::size_t>(slot)]; }
  // True if `is(held)` for any that is followed.
  template <class Is>
  bool isAny(Is&& is) const {
    return std::any_of(held_.begin(), held_.end(), [&](const HeldContact& f) { return f.isFollowed() && is(f); });
  }
  bool hadContacts() const { return had_contacts_; }  // the last query had
  bool hasRoom() const { return count(HeldContact::State::none) > 0 || count(HeldContact::State::fades) > 1; }
  bool follows() const {
    return isAny([](const HeldContact&) { return true; });
  }
  int count(HeldContact::State state) const {
    return static_cast<int>(std::count_if(held_.begin(), held_.end(), [&](const auto& f) { return f.state == state; }));
  }
  int alone() const;  // the only slot in use, if its contact is followed; else -1
  bool fades() const { return count(HeldContact::State::fades) > 0; }
  double nearestHeight() const;  // of those that are followed [m]
  double heightToBeat() const;   // that another contact has to be lower than, to be taken [m]
  bool isListed(const ShellContact& contact) const;

  // A further contact. Where there is no room the highest goes that may and is clearly higher, or it isn't taken. False
  // if one that is touched was left out.
  bool admit(const ShellContact& contact);
  // The nearest place of all, whatever has to go for it.
  void admitNearest(const ShellContact& contact);
  // The slot's contact is this one now; or stays the plane that it was.
  void keep(int slot, const ShellContact& contact);
  void hold(int slot) { held(slot) = {HeldContact::State::followed, false, kept(slot).ease, planeOf(slot)}; }
  int deepestFading() const;  // of which there are some
  ShellContact planeOf(int slot) const;
  // Where nothing is eased, none fades.
  void dropFading();

  // Writes the slots, and those that are near enough to `found`, the deepest first; status gets kQueryEased. Returns
  // the deepest. Requires one at least.
  const ShellContact& answer(SurfaceContacts& found, std::uint32_t& status);

 private:
  HeldContact& held(int slot) { return held_[static_cast<std::size_t>(slot)]; }
  HeldContact newOne(const ShellContact& contact) const;
  bool mayYield(const HeldContact& f) const { return f.is_new || (f.isFollowed() && f.shown() > ball_.r); }
  HeldContact* room();

  const TouchingBall& ball_;
  std::array<SurfaceSlot, kMaxSurfaceContacts>& slots_;
  std::array<HeldContact, kMaxSurfaceContacts> held_;  // by slot
  bool had_contacts_ = false;
};

}  // namespace pincer::contact
