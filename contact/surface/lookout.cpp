#include "pincer/contact/surface/lookout.h"

#include <algorithm>

#include "pincer/contact/surface/tolerances.h"

namespace pincer::contact {

Lookout::Lookout(const FeltSurface& surface, const SurfaceSearch& search, const TouchingBall& ball,
                 EasedContacts& contacts, SurfaceTracker& tracker, QueryCost& cost)
    : surface_(surface),
      search_(search),
      ball_(ball),
      gone_(tracker.gone + ball.moved + std::max(0.0, ball.reach - tracker.reach)),
      contacts_(contacts),
      tracker_(tracker),
      cost_(cost) {}

void Lookout::findOthers() {
  if (contacts_.list().empty() && contacts_.hasLost()) findLost();
  if (!(contacts_.nearestHeight() < ball_.reach) && !contacts_.hasLost()) findNearest();
  contacts_.fadeLost();
  if (contacts_.nearestHeight() < ball_.reach) lookOut();
}

// Without any contact left: a place on the side that the finger is on, or none.
void Lookout::findLost() {
  const int deepest = contacts_.deepestLost();
  if (!contacts_.pushes(deepest)) return contacts_.forgetLost();
  const ShellContact plane = contacts_.planeOf(deepest);
  const auto isSameSide = [&](const ShellContact& c) {
    return c.converged && c.n.dot(plane.n) > 0 && std::abs(c.h - plane.h) < kSameDepth * ball_.r;
  };
  lookOut();
  const auto* const beside = std::find_if(contacts_.list().begin(), contacts_.list().end(),
                                          [&](const FollowedContact& f) { return isSameSide(f.contact); });
  ShellContact found;
  if (beside != contacts_.list().end()) found = beside->contact;
  contacts_.clear();
  if (!found.converged) {
    const SurfaceSeed seed = search_.nearest(surface_.net, surface_.cache, ball_.C, ball_.reach, Facing::front);
    if (seed.found) found = follow(surface_, ball_.C, ball_.r, seed.foot);
    if (seed.found && !isSameSide(found)) found = straightTo(surface_, ball_.C, seed);
    if (!isSameSide(found)) return holdLost();
  }
  contacts_.admit(found);
  tracker_.status |= kQueryReseeded;
  ++cost_.reseeds;
}

// Its plane stays, whole. An open border stays as a wire: a finger that is led in under the sheet is pushed away from
// it until it is clear.
void Lookout::holdLost() {
  const int slot = contacts_.deepestLost();
  const auto wire = ball_.eases ? wireUnder(surface_, ball_.C, ball_.r, contacts_.kept(slot)) : std::nullopt;
  if (wire) {
    contacts_.keep(slot, *wire);
    tracker_.status |= kQueryReseeded;
    ++cost_.reseeds;
  } else {
    contacts_.hold(slot);
    tracker_.status |= kQueryHeldDirection;
    ++cost_.held;
  }
}

void Lookout::findNearest() {
  const ShellContact nearest = nearestWithin(contacts_.nearestHeight());
  if (!contacts_.list().empty() && (!nearest.converged || contacts_.isListed(nearest))) return;
  contacts_.admitNearest(nearest);
  if (nearest.converged) return;
  tracker_.status |= kQueryHeldDirection;
  ++cost_.held;
}

// The nearest solution; not converged if there is none nearer than `bound`. In free space a seed that leads to no
// solution as near (shading normals may point past the nearest place by a few degrees) stands for itself: far from
// contact the distance counts, not the direction. So does one in overlap that leads to none at all, on a ridge between
// two of a hollow that the finger is too large for.
ShellContact Lookout::nearestWithin(double bound) {
  const SurfaceSeed seed =
      search_.nearest(surface_.net, surface_.cache, ball_.C, bound, tracker_.has_centre ? Facing::front : Facing::both);
  if (!seed.found) return {};
  ShellContact contact = follow(surface_, ball_.C, ball_.r, seed.foot);
  const bool strayed = !contact.converged || std::abs(contact.h) > seed.distance + kStrayed * ball_.r;
  if (strayed && seed.distance > ball_.r) return straightTo(surface_, ball_.C, seed);
  if (!contact.converged) {
    contact = straightTo(surface_, ball_.C, seed);
    tracker_.status |= kQueryReseeded;
    ++cost_.reseeds;
  }
  contact.converged = contact.converged && std::abs(contact.h) < bound;
  return contact;
}

void Lookout::end(const ShellContact& main) {
  constexpr double kTold = 2;  // turns: what was left out has its next one meanwhile
  if (contacts_.list().isFull() && gone_ - tracker_.full_at <= kTold * ball_.turn)
    tracker_.status |= kQueryContactsDropped;
  if (!tracker_.look.is_alone) {
    NearParts& near = surface_.cache.partsOf(tracker_);
    near.p_BC = ball_.C;
    near.gone = gone_;
  }
  tracker_.gone = gone_;
  tracker_.reach = ball_.reach;
  // Where the centre is, or would be had it not been pressed under the surface.
  if (main.h > 0) {
    tracker_.p_BC = ball_.C;
    tracker_.has_centre = true;
  } else if (main.h <= 0 && tracker_.has_centre) {
    tracker_.p_BC = ball_.placeOf(main) + ball_.r * main.n;
  }
  tracker_.p_BC_last = ball_.C;
}

}  // namespace pincer::contact
