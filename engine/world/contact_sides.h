// contact_sides: what a contact is to what moves on its two sides: the rows of
// A, by which W = A A^T (solve/mobility.h).
//
//   of a body   A_k = sign [ n_k^T / sqrt(m),  ((arm x n_k)^T F) ],  F F^T = I^-1 in W
//               of rows that turn (torsion, rolling)  sign radius axis_k^T F
//   of a point  A_k = sign n_k^T diag(m_eff)^-1/2 in the axes of its coupling;
//               of torsion  sign radius inverse_twist^1/2
//
//   n_k   columns of R_WC;   sign  1 for a, -1 for b: velocities of contacts are those of a relative to b
#pragma once
#include <vector>

#include "pincer/engine/model.h"
#include "pincer/engine/solve/contact_problem.h"
#include "pincer/engine/world/scratch.h"

namespace pincer::engine {

// F = R diag(1 / sqrt(I_k)) of a body [kg^-1/2 m^-1].
Mat3 rootOfInertia(const FreeRotation& rotation, const Quat& q_WI);

// Side a or b of a contact of so many rows. `mover`: index into `root_inertia`, -1 for what doesn't
// move; `number`: of the mover in its island.
void fillSide(const WorldModel& model, WorldScratch& scratch, const Contact& c, int rows, bool is_a, int mover,
              int number, const std::vector<Mat3>& root_inertia, ContactSide& out);

// A side's block is added to that of another side with the same mover.
void addSide(int rows, const ContactSide& from, ContactSide& to);

// Two joined bodies that touch each other are one mover: what they do is one block.
void joinSides(int rows, ContactSides& sides);

}  // namespace pincer::engine
