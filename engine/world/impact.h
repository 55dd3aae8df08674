// impact: bodies that hit each other within a tick: when, and what their velocities are just after.
//
//   u_n+ = -e u_n-   (Newton),   friction in its cone, all contacts of the struck bodies in one solve, in no time
//
//   u_n-  normal velocity of a relative to b when the gap closes [m/s], < 0;   e  coefficient of restitution [-]
// The moment is the root of the gap along the path that the bodies would take in this part of the tick; a sphere above
// a plane is hit on a parabola, so exactly. The tick is cut there (stages.h).
//
// Bounces end: where gravity closes the gap again with acceleration a, a flight lasts T = 2 e |u_n-| / a and
// all flights to come T / (1 - e). A hit bounces if T is at least a sixteenth of a tick and all that would
// follow lasts at least a tick; else it lands.
//
// Two bodies that cross a quarter of the thinner one's thickness within a tick, in a heap (budget.h) all of it, are
// swept, whatever their restitution: the middle of the tick doesn't show whether they meet. So are two that would after
// the solve, because something else (a finger) pushes one of them.
//
// Newton's law can add energy in oblique hits with friction (T. R. Kane, D. A. Levinson, Dynamics: Theory and
// Applications, 1985, section 5.8), seen from what is hit: a racket that is driven may. Then e is lowered, by quarters,
// until it doesn't; e = 0 never does, where the solver has an answer. If it has none, impulses are scaled to the least
// energy on their ray, flagged.
// Departure from W. J. Stronge, Impact Mechanics, 2000, whose energetic coefficient needs the course of each hit: for
// bodies of convex shape that don't rub they are the same.
#pragma once
#include "pincer/engine/world/stages.h"

namespace pincer::engine {

// A contact that lands without bouncing, fast and on a part that didn't touch (a corner of a block that rocks), cuts
// the tick as well, at most kMostLandings times: taken with the rest of the tick its impulse would act at another
// place and time than the landing, first order.
constexpr int kMostLandings = 2;     // by which a tick is cut; what lands after them lands at its end
constexpr double kAlongWith = 0.25;  // of hardLanding: what closes faster lands with what lands hard
constexpr double kLate = 1.5;        // times the part of the tick: what closes so late may still close in it

// How often a tick is cut by impacts at most; what hits then lands, or bounces at the tick's end.
constexpr int kMostImpacts = 16;

// The restitution with which a hit at normal velocity `u` bounces [-]; 0 where it lands.
//   acceleration  with which gravity opens the gap (negative: closes it) [m/s^2];  h  tick [s]
double bounceRestitution(double restitution, double u, double acceleration, double h);

// Acceleration of the gap along the normal by gravity and the forces applied to bodies [m/s^2].
double gapAcceleration(const WorldModel& model, const WorldScratch& scratch, const Contact& c);

// Notes the pair in scratch.fast_pairs if it needs to be swept.
void noteFastPair(const WorldModel& model, const WorldState& state, int a, int b, WorldScratch& scratch);

// Notes, after the solve, the pairs that contacts push at each other or past each other so fast that they need to be
// swept, and that weren't near enough to be seen; for the rest of the tick. Only in worlds without a broad phase.
void notePushedPairs(const WorldModel& model, const WorldState& state, WorldScratch& scratch);

// Takes the contacts of pairs that may hit each other in this tick out of scratch.contacts, and notes the
// pairs. `landings`: those that land, too.
void holdBackImpacts(const WorldModel& model, const WorldState& state, bool landings, WorldScratch& scratch);

// True if there are any that bounce or are too fast.
bool impactsWait(const WorldModel& model, const WorldState& state, const WorldScratch& scratch);

// When the first of the noted pairs closes [s] after the start of this part of the tick, on the path that the solved
// contacts give; infinity if none does. Call gatherImpulses before.
double timeOfImpact(const WorldModel& model, const WorldState& state, WorldScratch& scratch);

// True if the contact pushed in the last part of a tick.
bool pushedBefore(const WorldState& state, std::uint64_t id);

// The speed from which a landing cuts the tick [m/s].
double hardLanding(const WorldModel& model, const WorldScratch& scratch);

// Of the body's centre of mass at the end of this part of the tick, contacts included. Call gatherImpulses before.
Vec3 endVelocity(const WorldModel& model, const WorldScratch& scratch, int body);
// And how fast a dynamic body turns, by the inertia of the tick's middle [rad/s].
Vec3 endAngularVelocity(const WorldModel& model, const WorldScratch& scratch, int body);

// Of the hit just applied: true if some contact of it bounces; the bodies between
// which the normal impulse is the largest, -1 for none.
bool somethingBounces(const WorldScratch& scratch);
ImpactPair hardestHit(const WorldScratch& scratch);

// Makes the velocities of `state` those just after the hits at its present poses. True if something
// had to be kept from turning too far (limitTurns).
bool applyImpacts(const WorldModel& model, WorldState& state, WorldScratch& scratch, ContactSource* source);

}  // namespace pincer::engine
