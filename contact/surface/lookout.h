// lookout: the places of a surface that face a finger's centre, beside those that are followed: all with h < reach,
// wherever they are.
//
//   reach = r + margin + w
//
//   C  finger's centre, h  its height over a place [m], frame B;  r  finger's radius, margin  within which contacts are
//   reported [m] w = r / 16: the centre's way within which each place is tried once, in turns (turns.h)
//
// It lives from looks: each tells for a way of the centre which parts of the surface may matter (near_parts.h), or that
// none does (lone_contact.h).
//
// - A new contact is one that the finger could come to from outside: its place faces where the centre was at the last
//   query and faces it now, and no other part of the surface hides it. A centre that has been pressed under the surface
//   counts as being where the finger would be on that surface, so the far side of a wall stays out of reach however
//   long the finger is pressed.
// - Late by w, mostly: what comes from outside is known by the time it is reported, unless all slots are taken and one
//   touches; while they are touched none is looked for within w / 2 after one was left out. What begins in overlap
//   begins at phi = 0 (ease.h) whenever it is found; the places that lead to it may be there for less than w, and then
//   it is missed until others do (decision 7 has how often).
// - In free space the nearest place is asked for, whatever is followed. Without any contact left a place on the side
//   that the finger is on is looked for in the whole surface; failing that, the deepest one's plane is held.
#pragma once
#include "pincer/contact/surface/ease.h"
#include "pincer/contact/surface/follow.h"
#include "pincer/contact/surface/near_parts.h"
#include "pincer/contact/surface/surface_search.h"
#include "pincer/contact/surface/turns.h"

namespace pincer::contact {

class Lookout {
 public:
  Lookout(const FeltSurface& surface, const SurfaceSearch& search, const TouchingBall& ball, EasedContacts& contacts,
          SurfaceTracker& tracker, QueryCost& cost);

  // True if nothing can be met beside one contact that is followed alone, as far as is known without it; with its
  // normal `n`: in all.
  bool isNothingDue();
  bool isQuietAround(int slot, const Vec3& n) const;

  // Finds the main contact where none is followed within reach, then what else there is.
  void findOthers();
  // Carries the memory on to the next query.
  void end(const ShellContact& main);

 private:
  void findLost();
  void findNearest();
  ShellContact nearestWithin(double bound);
  void holdLost();

  void lookOut();
  double wayFrom(const SurfaceLook& look) const {
    return (ball_.C - look.p_BC).norm() + std::max(0.0, ball_.reach - look.reach);
  }
  double goneAt(const SurfaceLook& look) const { return gone_ - wayFrom(look); }
  template <class NormalIn>
  bool isGood(bool is_alone, const NormalIn& normalIn) const;
  bool lookAlone();
  SurfaceLook lookFromHere() const;
  bool turnsSlowly(const ShellContact& contact) const;
  NearParts& nearParts();

  void examineDue(NearParts& near, bool are_all);
  void examine(const Turns& turns, NearPart& part);
  bool isEveryonesTurn() const;
  bool hasTriedEnough() const;
  double reachOfTry(bool has_turn) const;
  bool isKnown(std::int32_t triangle, const PatchBounds& part) const;
  void tryPlace(const Foot& foot);
  bool isNew(const ShellContact& candidate) const;

  const FeltSurface& surface_;
  const SurfaceSearch& search_;
  const TouchingBall& ball_;
  const double gone_;  // SurfaceTracker::gone here
  EasedContacts& contacts_;
  SurfaceTracker& tracker_;
  QueryCost& cost_;

  int tries_ = 0, walked_ = 0;  // places tried in this query; steps and crossings of their walks
};

}  // namespace pincer::contact
