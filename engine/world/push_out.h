// push_out: bodies that overlap deeply are moved apart, by a way, not by a
// velocity: what leaves an overlap doesn't fly off.
//
//   J_i x >= want_i,   lambda_i >= 0,   x = M^-1 J^T lambda        (one of the first two with equality, per contact)
//   want_i = min(max(gamma s d_i, d_i - e_i), v_max h max(s, d_i / e_i))  of contacts deeper than kDeep, d_i the
//                                                                         overlap after this part of the tick,
//            e_i about half the thinner body's thickness: what is buried could tip over to the wrong side on its way
//            -(phi_i + kDeep)  of the others, phi_i their gap then: they stay as they are
//
//   x  ways and turns of the bodies [m, rad];  lambda [kg m];  s  share of this part in the tick, of length h;  J
//                                                                 normal rows only: friction is for what moves
//   gamma, v_max  kNormalCorrection, kLargestCorrection (contact_rows.h)
// Projected Gauss-Seidel, a few sweeps: what is left is pushed out in the ticks to come. Shallow overlap is the contact
// solve's (contact_rows.h); so is that of joined bodies and of fingertips.
// Source: split impulses, E. Guendelman, R. Bridson, R. Fedkiw, ACM Trans. Graph. 22 (2003)
// 871-878, section 7 (there by repeated pushes).
#pragma once
#include "pincer/engine/world/scratch.h"

namespace pincer::engine {

constexpr double kDeepSpeed = 1e-3;  // up to which the contact solve itself undoes an overlap [m/s]

// True if the contact's overlap is undone here, were it deep.
bool isPushedOut(const WorldModel& model, const Contact& c);

// Pushes the bodies of `state` apart where contacts of the part of the tick just done are deep.
void pushOut(const WorldModel& model, WorldState& state, WorldScratch& scratch);

}  // namespace pincer::engine
