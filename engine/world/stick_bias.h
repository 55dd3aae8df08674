// stick_bias: makes what the sticking contacts of one pair ask for the motion of a rigid body.
//
//   minimise over xi  sum_i  w_n^2 (n_i . xi_i - a_in)^2 + |P_i xi_i - a_iT|^2 + (e_t n_i . Omega - a_it)^2
//   xi_i = V + Omega x rho_i
//
//   a_i   velocity of a relative to b at contact i that its biases ask for: along the normal to correct the gap, along
//         the tangents (with torsion or rolling radius, about the axes as well) to undo its stick offset [m/s]
//   P_i   projection onto the contact's tangents;  rho_i  contact point from the mean of them all [m]
//   w_n   weight of the normals [-]: a gap is geometry and stays as it is, an offset is memory and follows
//   xi    V [m/s], Omega [rad/s]: the six unknowns
//
// Three contacts with normals that differ hold a body nine-fold. What their offsets and gaps ask for beyond the six
// freedoms of a rigid motion, no motion can give: it would wedge the body against its own friction, and the solver
// against the round-off of that. So each tangential bias becomes P_i xi_i, and the stick offset what belongs to it.
// Contacts of one flat face are left as they are: their gaps don't couple to their offsets, which alignFaces
// (advance.cpp) keeps consistent at less cost. A driven point has three freedoms, and two contacts hold it six-fold: in
// a steep groove what is left of a contradiction squeezed it with 1e9 N. Its Omega is zero, sliding contacts take part
// with their normals, and normal biases become n_i . V too. Not on a free body: that turns, and with V alone the point
// would walk over it to close gaps that a turn closes. The two are a loop for island_bias.h, which knows what moves.
#pragma once
#include "pincer/engine/world/scratch.h"

namespace pincer::engine {

constexpr double kSamePlane = 0.9999;  // cosine of 0.8 degrees between the normals of contacts of one flat face
constexpr double kNormalWeight = 10;   // w_n, beside 1 of tangential rows: gaps come first

// Of all pairs with two or more sticking contacts in different planes: fits bias_C's tangential rows
// and offset_C of scratch.contacts (sorted by id), and corrects scratch.q. Likewise of points that
// stick at one of several. Allocates nothing.
//   offset_rate  bias_T = offset_rate (offset_T + h v_start_T / 2) [1/s]
void alignStickBiases(const WorldModel& model, double h, double offset_rate, WorldScratch& scratch);

}  // namespace pincer::engine
