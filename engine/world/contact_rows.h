// contact_rows: from contacts to the numbers that the solver sees: what each remembers, its
// velocity and biases. (Jacobians: islands.h.)
//
// Biases (the solver makes u + mu |u_T| e_n lie in K*, u including the bias b):
//   open, not touching before    b_n = phi_0 / h                      lands exactly
//   touching before              b_n = 0.2 phi / h + 1/2 dn/dt h . v  drift correction, and the turn of the normal
//                                from the middle of the tick to its end, which makes curved contacts second order
//   stuck                        b_T = 0.5 (d_T + h u_T / 2) / h
//   phi_0  the gap at the start of the tick [m];  d_T  how far the two have slid since they stuck [m];  u_T  how fast
//          they did at the start of the tick [m/s]
// d_T is the integral of the slip velocity, not the distance of two material points: that grows by R (w h)^3 / 24 per
// tick in pure rolling, and would brake it.
// A correction pushes apart with at most kLargestCorrection, so that deep overlap doesn't explode; between bodies
// without joints with at most kDeepSpeed: deeper overlap is undone by moving them (push_out.h), which leaves no
// velocity behind. Torsion and rolling stick likewise, by the angles that a has turned past b. What resists
// rolling shares the cone with friction, so that a ball that rolls against it creeps: v = (R + k) w with R k^2 +
// (I/m + R^2 - e_r^2) k - R e_r^2 = 0, k ~ (5/7) e_r^2 / R for a solid ball. It slows down by mu g k / sqrt(k^2 +
// e_r^2) ~ (5/7) mu e_r g / R, and stays on a slope iff tan th <= mu e_r / sqrt(R^2 + e_r^2). With the gap taken
// at the predicted middle, d' = d + h (u + u')/2 and u' = -gamma (d + h u/2)/h, an error decays by 1 - gamma per
// tick without ringing, for any gamma <= 1.
#pragma once
#include <span>

#include "pincer/engine/solve/contact_problem.h"
#include "pincer/engine/state.h"
#include "pincer/engine/world/scratch.h"

namespace pincer::engine {

constexpr double kNormalCorrection = 0.2;    // gamma, per tick [-]
constexpr double kTangentCorrection = 0.5;   // gamma, per tick [-]
constexpr double kLargestCorrection = 0.05;  // [m/s]
constexpr double kFastTurn = 0.1;            // [rad] in a part of a tick: its middle doesn't tell all of it
constexpr double kResidue = 1e-9;            // relative, ten times the solver's tolerance
constexpr double kClosingSpeed = 1e-6;       // slower approaches count as rest [m/s]

// By id.
void sortContacts(WorldScratch& scratch);

// Finds what is remembered of the contacts, sorted by id, by identity, and of what has a new one by its place on the
// pair (where corners lie on edges identities come and go); fills frames, arms, friction, stick offsets and impulses.
//   contacts  all of each two that it holds any of
//   memories  sorted by id, from those of the first two on
// Impulses that no contact of the same two finds go to the nearest that pushes alike. Returns the memories behind those
// of the last two, for what comes after `contacts`.
std::span<const ContactMemory> recallContacts(std::span<const ContactMemory> memories, std::span<Contact> contacts,
                                              const WorldScratch& scratch);

// Recalls the contacts, which are sorted, and fills first_row, q, mu and the warm start r, in their order.
void fillContacts(const WorldModel& model, const WorldState& state, WorldScratch& scratch);

// Fills what contact i gets to know by its solution in scratch.r and u, which is off by `error` [m/s]: r, impulse_W,
// u_C, sliding.
void readSolution(const WorldModel& model, const WorldScratch& scratch, int i, double error, Contact& c);

// Writes what the contacts are to remember, and puts what sleeping ones remember among it (island_sleep.h); notes
// which of them a tick changed nothing of.
void rememberContacts(const WorldModel& model, WorldScratch& scratch, WorldState& state);

}  // namespace pincer::engine
