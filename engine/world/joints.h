// joints: pivots, sliders, balls and welds between two bodies, or a body and the
// world, eliminated from the contact problem.
//
//   G v = 0,   G of one row per direction that the joint blocks
//     a row: n . (v_a + w_a x rho_a - v_b - w_b x rho_b) + m . (w_a - w_b)
//   lambda = -A^-1 (G v_free + b),   A = G M^-1 G^T + R
//     impulses of the joints of one group without contact [N s, N m s]
//   F = S N L^-T,   M^-1 = S S^T,   G S N = 0,   N^T N = 1,   L L^T = 1 + sum d d^T / R
//     d = N^T S^T g of a damper's row g
//
//   F      factor of the inverse mass that contacts see: F F^T = M^-1 - M^-1 G^T A^-1 G M^-1. A group is
//          one mover of the contact problem (engine/solve), with as many freedoms as F has columns: at
//          most kMoverFreedoms, or the builder refuses
//   group  joints that share moving bodies: a tree, a chain, a loop (a lone one
//          that holds a body to the world: held_body.h)
//   b      h/2 (dG/dt) v, so that the constraint holds at the tick's end
//   R      0, but for the damping d of the free axis: 2 / (h d) with b = (its rate at the start), the trapezoidal
//          rule, exact to 2nd order; where h d exceeds the inertia 1 / (h d), b = 0, implicit and never ringing. A
//          diagonal 1e-13 of A's lets loops be redundant
// After the tick, poses and then velocities are projected onto the joints, along the inertia: they never drift.
//
// Exact cones, one coupled solve: the contact solver sees bodies that move only as their joints let them, and no
// equality rows. Source: R. Featherstone, Rigid Body Dynamics Algorithms, 2008, section 3.2 (constrained motion;
// eliminated per group, not recursively: hands hold a few joints); projection: E. Hairer, C. Lubich, G. Wanner,
// Geometric Numerical Integration, 2nd ed., 2006, IV.4.
#pragma once
#include "pincer/engine/state.h"
#include "pincer/engine/world/scratch.h"

namespace pincer::engine {

// [m, rad]: more than the round-off of a scene file isn't what its author meant
constexpr double kLargestJointGap = 1e-6;

// Rows at the predicted middle; changes the free motions to what the joints allow. After all bodies are predicted.
void predictJoints(const WorldModel& model, WorldScratch& scratch);

// Fills F of a group from its rows.
void factoriseInverseMass(const WorldModel& model, const WorldScratch& scratch, const JointGroup& g,
                          JointGroupScratch& group);

// Adds `sign` J F to A: how contact c's velocity follows its group's freedoms through `body`, at arm_W from its centre.
void addJointedSide(const WorldModel& model, const WorldScratch& scratch, const Contact& c, int rows, double sign,
                    int body, const Vec3& arm_W, ContactSide& out);

// Adds the joints' answer to the gathered contact impulses.
void gatherJointImpulses(const WorldModel& model, WorldScratch& scratch);

// Projects poses and velocities of jointed bodies.
void settleJoints(const WorldModel& model, WorldState& state, WorldScratch& scratch);

// How far the sides of a joint are apart [m, rad]: of the point, of the axes.
Vec2 jointGap(const WorldState& state, const JointModel& joint);

}  // namespace pincer::engine
