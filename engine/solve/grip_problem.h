// grip_problem: stuck_contacts.h's step for the grip that nearly all are: one free body, up to four points that don't
// turn and what doesn't move. Blocks of A aren't needed there. Contacts of a face share their axes R and a point, and
// act on the body by the sum of their impulses and the moment of that:
//
//   A_i = s R^T (1/sqrt(m),  -[arm_i]x F,  -E)          y = A^T r:  s R sum r_i,  s R sum (R^T arm_i) x r_i
//   N = A^T A + ridge I,  points eliminated (P = n E^2 + ridge I, rho = ridge / P):
//     N_ll = ridge I + sum n rho / m     N_la = -sum rho [sum arm]x F / sqrt(m)
//     N_aa = ridge I + F^T (sum over i of |c_i|^2 I - c_i c_i^T  +  rho [sum arm]x^T [sum arm]x / n) F
//
//   s  1 where the body is the contact's a, else -1;  m  its mass;  F F^T = I^-1 about its centre of mass, in W
//   E  root of a point's inverse mass per axis of W [kg^-1/2];  n  contacts of a point that hold
//   c_i  arm_i less the mean of its point's: what all of a point's contacts do together, the point gives way to
//   of contacts without a point rho = 1, and c_i = arm_i
// So N costs 9 products per contact instead of 45, without the cancellation of a Schur complement.
#pragma once
#include <array>

#include "pincer/engine/solve/contact_problem.h"
#include "pincer/engine/solve/solver_scratch.h"

namespace pincer::engine {

constexpr int kMostGripPoints = 4, kFewestGripContacts = 4, kMostGripContacts = 16;

// All of a contact but its mu, q and r, which are the problem's.
struct GripContact {
  const Mat3* R_WC;
  const Vec3* arm_W;  // from the body's centre of mass
  double sign;        // s
  int point;          // -1: none
};
struct GripProblem {
  double root_inverse_mass = 0;                        // of the body [kg^-1/2]
  Mat3 F;                                              // [kg^-1/2 m^-1]
  std::array<Vec3, kMostGripPoints> point_root;        // E
  std::array<GripContact, kMostGripContacts> contact;  // those of a point follow each other
  int points = 0, contacts = 0;
};

// True if the warm start or a few steps from there solved `problem`, the same contacts as `grip`: then r, u and
// `result` are those of solveContacts, by the rules of stuck_contacts.h. Else r is as before, and the other two aren't
// to be read. The problem's sides and movers aren't read.
//   r  warm start, in the cones
bool solveGripProblem(const GripProblem& grip, const ContactProblem& problem, const SolverOptions& options,
                      SolverScratch& scratch, double* r, double* u, SolveResult& result);

}  // namespace pincer::engine
