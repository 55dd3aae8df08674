// contact_rows: from contacts to the numbers that the solver sees: what each remembers, its biases, Jacobian rows, Delassus operator.
//
// Biases (the solver makes u + mu |u_T| e_n lie in K*, u including the bias b):
//   open, not touching before    b_n = phi_0 / h                 so that it lands exactly, phi_0 the gap at the start of the tick
//   touching before              b_n = 0.2 phi / h + 1/2 dn/dt h . v   drift correction, and the turn of the normal from the middle
//                                                                of the tick to its end (that makes curved contacts second order)
//   stuck                        b_T = 0.5 d_T / h               d_T: offset of the two material points that stuck to each other
// A correction pushes apart with at most kLargestCorrection, so that deep overlap doesn't explode.
// With the gap taken at the predicted middle, d' = d + h (u + u')/2 and u' = -gamma (d + h u/2)/h, an error decays by 1 - gamma per tick
// without ringing, for any gamma <= 1.
#pragma once
#include "engine/solve/contact_problem.h"
#include "engine/world/scratch.h"
#include "engine/world/state.h"

namespace pincer::engine {

constexpr double kNormalCorrection = 0.2;   // gamma, per tick [-]
constexpr double kTangentCorrection = 0.5;  // gamma, per tick [-]
// From the offset at the start of the tick the decay per tick is a root of x^2 - (1 - g/2) x + g/2; 6 - 4 sqrt(2) makes it a double one, 0.41.
constexpr double kTwistCorrection = 0.343145750507619805;
constexpr double kLargestCorrection = 0.05;  // [m/s]
constexpr double kClosingSpeed = 1e-6;       // slower approaches count as rest [m/s]

// Sorts the contacts by id, finds what the state remembers of each, fills frame, arms, friction and stick offset.
void recallContacts(const WorldState& state, WorldScratch& scratch);

// Fills rows, W, q, mu and the warm start r; returns views onto them.
ContactProblem assembleProblem(const WorldModel& model, const WorldState& state, WorldScratch& scratch);

// Velocity of a side's material point at `arm_W` from its centre, at the start of the tick or (free) at its end without contacts [m/s].
Vec3 startVelocity(const WorldScratch& scratch, const WorldState& state, const Side& side, const Vec3& arm_W);

}  // namespace pincer::engine
