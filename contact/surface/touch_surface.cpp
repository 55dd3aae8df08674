#include "pincer/contact/surface/touch_surface.h"

#include "pincer/contact/surface/ease.h"
#include "pincer/contact/surface/flat_contact.h"
#include "pincer/contact/surface/lookout.h"
#include "pincer/contact/surface/tolerances.h"

namespace pincer::contact {

namespace {

// The variants but `smooth` show what they do at edges: jump. After a leap there is nothing to be steady with.
TouchingBall ballAt(const Vec3& C, double r, double margin, SurfaceVariant variant, const SurfaceTracker& tracker) {
  const double moved = (C - tracker.p_BC_last).norm(), turn = variant == SurfaceVariant::smooth ? kWay * r : 0;
  const double reach = r + margin + turn, gone = moved + std::max(0.0, reach - tracker.reach);
  return {C, tracker.p_BC_last, r, moved, gone, r + margin, reach, turn, turn > 0 && moved <= kLeap * r};
}

bool isOn(const SurfaceNet& net, const SurfaceSlot& slot) { return slot.triangle >= 0 && slot.triangle < net.size(); }

// The only slot that holds a contact; -1 if none or several do.
int onlySlot(const SurfaceTracker& tracker) {
  int only = -1;
  for (int i = 0; i < kMaxSurfaceContacts; ++i) {
    if (tracker.slots[static_cast<std::size_t>(i)].triangle < 0) continue;
    if (only >= 0) return -1;
    only = i;
  }
  return only;
}

// The usual tick: the only contact that is followed has moved on within its patch, nothing else has come near, and
// nothing is eased.
[[gnu::flatten]] bool followAlone(const FeltSurface& surface, const TouchingBall& ball, Lookout& lookout,
                                  SurfaceTracker& tracker, SurfaceContacts& found) {
  const int slot = onlySlot(tracker);
  if (slot < 0 || surface.variant != SurfaceVariant::smooth) return false;
  SurfaceSlot& kept = tracker.slots[static_cast<std::size_t>(slot)];
  if (!isOn(surface.net, kept) || kept.fades || kept.ease > 0 || !knowsMotion(kept) || !lookout.isNothingDue())
    return false;
  const ShellContact contact =
      solveShellBeside(surface.net, surface.cache, ball.C, footOf(kept), {kept.du, kept.dv}, ball.C - ball.C_last);
  if (!contact.converged || !(contact.h > 0 && contact.h < ball.reach) || !ball.continues(kept, contact) ||
      !lookout.isGoodAlone(slot, contact.n))
    return false;
  const Vec3 S = ball.placeOf(contact);
  kept = {contact.foot.triangle, false, contact.foot.b[1], contact.foot.b[2], 0, S, contact.n, contact.motion.du,
          contact.motion.dv};
  found.points[0] = {S, contact.n, contact.h - ball.r, static_cast<std::uint32_t>(slot)};
  found.count = 1;
  found.cost.iterations = found.cost.longest_walk = contact.cost.steps;
  found.cost.crossings = contact.cost.crossings;
  lookout.remember(contact);
  return true;
}

void followSlots(const FeltSurface& surface, const TouchingBall& ball, EasedContacts& contacts, QueryCost& cost) {
  for (int slot = 0; slot < kMaxSurfaceContacts; ++slot) {
    const SurfaceSlot& kept = contacts.kept(slot);
    if (!isOn(surface.net, kept)) continue;
    if (kept.fades) {
      contacts.lose(slot);
      continue;
    }
    ShellContact contact = contacts.onItsSide(kept, followSlot(surface, ball.C, ball.r, ball.C - ball.C_last, kept));
    cost.iterations += contact.cost.steps;
    cost.longest_walk = std::max(cost.longest_walk, contact.cost.steps);
    cost.crossings += contact.cost.crossings;
    contact.converged = contact.converged && !isFarSide(surface, ball.C, ball.r, kept, contact);
    contacts.moveOn(slot, contact);
  }
}

}  // namespace

SurfaceContacts touchSurface(const FeltSurface& surface, const SurfaceSearch& search, const Vec3& p_BC, double r,
                             double margin, SurfaceTracker& tracker) {
  const TouchingBall ball = ballAt(p_BC, r, margin, surface.variant, tracker);
  SurfaceContacts found;
  Lookout lookout(surface, search, ball, tracker, found.cost);
  tracker.status = kQueryOk;
  if (!followAlone(surface, ball, lookout, tracker, found)) {
    EasedContacts contacts(ball, tracker.slots);
    followSlots(surface, ball, contacts, found.cost);
    lookout.findOthers(contacts);
    lookout.remember(contacts.answer(found, tracker.status));
  }
  if (surface.variant == SurfaceVariant::force) shadeForce(surface.net, tracker, found);
  return found;
}

}  // namespace pincer::contact
