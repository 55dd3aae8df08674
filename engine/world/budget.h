// budget: what a tick spends of solver.budget besides its solves, and what it does once that has run out.
//
// Counted in multiplications, not measured (solve/solver_scratch.h); scratch.operations_left below 0 is spent. Then
// what is left of the tick is done in one part, however far bodies turn in it, with impulses that are best iterates:
// its answer is flagged, and must not have more energy than there was. So must what driven bodies turn.
#pragma once
#include <algorithm>

#include "pincer/engine/world/scratch.h"

namespace pincer::engine {

inline bool isLimited(const WorldScratch& scratch) { return scratch.operations_left < kNoLimit; }
inline bool isSpent(const WorldScratch& scratch) { return scratch.operations_left < 0; }
inline void charge(std::int64_t operations, WorldScratch& scratch) {
  if (isLimited(scratch)) scratch.operations_left -= operations;
}

// Work that solves of hits may take in a tick, per contact, and of few contacts at least: beyond, no further hit cuts
// the tick. Each of six solves ends with its share of it, one run of 16 sweeps in a wall, or 0.3 ms: the best iterate
// counts, flagged.
constexpr std::int64_t kHitOperations = 6'000, kFewestHitOperations = 4'000'000;
inline std::int64_t mostHitOperations(std::int64_t contacts) {
  return std::max(kFewestHitOperations, kHitOperations * contacts);
}
// So many contacts are a heap: hits run through it by the hundred, sooner than a tick can follow.
constexpr int kHeapContacts = 100;
inline bool isHeap(const WorldState& state) { return state.contact_count > kHeapContacts; }  // it was, in the last tick

inline bool haveHitsSpent(const WorldScratch& scratch) {
  return scratch.hit_operations > mostHitOperations(static_cast<std::int64_t>(scratch.contacts.size()));
}

// For a query of where two shapes touch: solids' facets are laid over each other, spheres need little.
void chargeQuery(const ColliderModel& a, const ColliderModel& b, WorldScratch& scratch);

// Kinetic and potential energy of all bodies in this gravity [J].
double energyOf(const WorldModel& model, const WorldState& state, const Vec3& gravity_W);

// Slows the bodies on which contacts push, and those joined to them, all by one factor, until the energy is `most` [J]
// at most, or they stand. Not where a finger, a driven body or an applied force pushes: those may do work.
void limitEnergy(const WorldModel& model, const WorldScratch& scratch, double most, WorldState& state);

// Scales the impulses of islands in which what is driven would turn a body faster than its push can last:
//
//   w+ <= max(w-, sqrt(2 g/(h R)), 10 g/R)     g  speed of what touches the body, and of pushing out an overlap [m/s]
//                                              R  its reach from the axis [m];   h  tick [s]
//
// A push at the arm a turns a body at g/a, and that turn changes the arm by R w h within the tick: shorter ones than
// a = (g h R/2)^1/2 are none. A lever that a plate pushes over its own hinge would turn at any speed, and a jammed one
// would gain speed from tick to tick. The last term is that of a hit, which takes no time. True if there was one.
bool limitTurns(const WorldModel& model, WorldScratch& scratch);

}  // namespace pincer::engine
