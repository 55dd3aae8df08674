// lookout: the places of a surface that face a finger's centre, beside those that are followed: all with h < reach,
// wherever they are and whatever was asked before.
//
//   reach = r + margin + w
//
//   C  finger's centre, h  its height over a place [m], frame B;  r  finger's radius, margin  within which contacts are
//   told of [m];  w = r / 16  the centre's way within which each place is tried once
//
// It lives from looks: each tells for a way of the centre which parts of the surface may matter (near_parts.h), or that
// none does (lone_contact.h). Of those that do, each minimum of the flat mesh's distance that no followed contact
// stands for is walked from: a share of them in each query, so that each has its turn within w. So a contact is
// followed before it is told of.
//
// - A new contact is one that the finger could come to from outside: its place faces where the centre was at the last
//   query and faces it now, and no other part of the surface hides it. A centre that has been pressed under the surface
//   counts as being where the finger would be on that surface, so the far side of a wall stays out of reach however
//   long the finger is pressed.
// - In free space the nearest place is asked for, whatever is followed. Without any contact left a place on the side
//   that the finger is on is looked for in the whole surface; failing that, the deepest one's plane is held.
#pragma once
#include "pincer/contact/surface/ease.h"
#include "pincer/contact/surface/follow.h"
#include "pincer/contact/surface/near_parts.h"
#include "pincer/contact/surface/surface_search.h"

namespace pincer::contact {

class Lookout {
 public:
  Lookout(const FeltSurface& surface, const SurfaceSearch& search, const TouchingBall& ball, SurfaceTracker& tracker,
          QueryCost& cost)
      : surface_(surface),
        search_(search),
        ball_(ball),
        tracker_(tracker),
        cost_(cost),
        share_(ball.gone < ball.turn ? static_cast<std::uint32_t>(0x1p32 * (ball.gone / ball.turn)) : ~0u) {}

  // True if nothing can be met beside one contact that is followed alone, as far as is known without it; with its
  // normal `n`: in all.
  bool isNothingDue();
  bool isGoodAlone(int slot, const Vec3& n) const;
  // Finds the main contact where none is followed within reach, then what else there is.
  void findOthers(EasedContacts& contacts);
  // Keeps for the next query where the centre is, or would be had it not been pressed under the surface.
  void remember(const ShellContact& main);

 private:
  void findLost();
  void holdLost();
  void findNearest();
  ShellContact nearestWithin(double bound);

  void lookOut();
  template <class NormalIn>
  bool isGood(bool is_alone, NormalIn&& normalIn) const;
  bool isNear() const;
  bool lookAlone();
  SurfaceLook lookFromHere() const;
  bool turnsSlowly(const ShellContact& contact) const;

  bool hasTurn(const NearPart& part) const;
  void examineNear(NearParts& near);
  double examine(std::int32_t place);
  bool isBeside(const PatchBounds& part, std::int32_t triangle) const;
  bool isKnown(std::int32_t triangle, const FlatPoint& flat) const;
  void tryPlace(const Foot& foot);
  bool isNew(const ShellContact& candidate) const;

  const FeltSurface& surface_;
  const SurfaceSearch& search_;
  const TouchingBall& ball_;
  EasedContacts* contacts_ = nullptr;  // since findOthers; till then there is room
  SurfaceTracker& tracker_;
  QueryCost& cost_;
  const std::uint32_t share_;  // of the circle of turns, that this query goes around
  int work_ = 0;               // of this query's tries
};

}  // namespace pincer::contact
