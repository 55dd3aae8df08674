// cascade: solves a ContactProblem, cheapest method first.
//
//   warm start's residual -> semi-smooth Newton (Alart-Curnier) -> the same with a proximal term -> interior point -> interior point with frozen shift, updated ->
//   projected Gauss-Seidel with exact local solves -> best iterate, flagged.     Newton's method finishes what the others begin.
// Walls that close on a body have no answer: their contacts yield (squeeze.h).
// Few contacts go to small_problem.h, heaps of hundreds to large_problem.h; a point between walls, if all else failed, to point_problem.h
// (it counts as kGaussSeidel: an exact local solution).
//
// A body that has come to rest under impulses that are off by less than the tolerance drifts until they aren't, then is put right, in a cycle
// without end. So after an answer that took iterations the next ones are `strict`: a warm start must be exact to round-off, until it is clear that
// none comes (engine/world). What rests then needs no iteration any more.
//
// Never throws, allocates or prints; deterministic.
#pragma once
#include <array>
#include <cstdint>
#include <limits>
#include <vector>

#include "pincer/engine/solve/block_lu.h"
#include "pincer/engine/solve/contact_problem.h"
#include "pincer/engine/solver.h"

namespace pincer::engine {

// Multiplications in a second, of iterations as they are counted (contact_equations.h): few enough that on an AMD EPYC at 3.7 GHz capped ticks take no
// longer than their cap (`pincer stress` shows the longest; decision 4).
constexpr double kOperationsPerSecond = 8e8;
constexpr std::int64_t kNoLimit = std::numeric_limits<std::int64_t>::max() / 2;

// How a contact takes part in the linear equations of contact_equations.h; blocks row-major with stride kMaxContactRows.
enum class Coupling : std::uint8_t { kNone, kIdentity, kGeneral };
struct ContactTerms {
  static constexpr int kSize = kMaxContactRows * kMaxContactRows;
  Coupling coupling = Coupling::kNone;
  bool has_R = false;
  double epsilon = 0;
  double E[kSize], P[kSize], R[kSize], K_inverse[kSize], G[kSize];
};

// Working memory, sized once for at most `max_contacts` that touch at most `max_movers`; what it holds means nothing between calls.
struct SolverScratch {
  SolverScratch(int max_contacts, int max_movers);

  std::int64_t operations_left = kNoLimit;  // of the budget; less than 0: spent
  int max_contacts, dense_contacts;         // dense_contacts: up to so many may be treated as a dense matrix
  std::vector<ContactSides> sides;          // the scaled problem (scaled_problem.h)
  std::vector<double> W, q, scale, y;
  std::vector<double> weight;  // w_i, mean of W_ii's diagonal [1/kg]
  std::vector<double> shift;   // |u_T| at which interior_point.h freezes it
  // Linear equations and vectors of newton.h and interior_point.h. `give`: by what contacts gave way; r and u are the answer for q + give.
  std::vector<double> jacobian, step, rhs, response, shift_centre, give;
  std::vector<double> workspace;                            // of whichever method runs, kInteriorPointVectors per row
  std::array<std::vector<double>, 3> impulses, velocities;  // current, trial and best iterate
  std::vector<int> active, pivots;                          // contacts in the dense equations; row swaps
  std::vector<ContactTerms> terms;                          // contact_equations.h
  std::vector<double> local;                                // gauss_seidel.h
  std::vector<RoundContact> round;                          // round_contact.h
  std::vector<int> node;                                    // of movers in movers_lu
  BlockLu movers_lu;
};

// False, and nothing more may be spent, if that is more than what is left of the budget.
inline bool spend(std::int64_t operations, SolverScratch& scratch) {
  scratch.operations_left -= operations;
  return scratch.operations_left >= 0;
}

// The slowest motion that counts as motion; residuals are relative to the speeds of the problem, but never to less [m/s].
constexpr double kVelocityFloor = 1e-6;

// Of the tolerance: what a strict problem asks of its warm start.
constexpr double kStrictness = 1e-4;

// Relative natural-map residual: max_i w_i |r_i - P_K(r_i - u~_i / w_i)| / max(|q|_inf, kVelocityFloor, 1e-4 max_i w_i r_in), with
// u~_i = u_i + mu_i |u_iT| e_n and w_i the mean of W_ii's diagonal. The last term of the maximum speaks up only where W r cancels to less than
// 1e-4 of itself (mass ratios above 1e4), and keeps a tolerance of 1e-10 above the round-off of that sum. Infinite if anything is not finite
// (a NaN never passes). `u` receives W r + q, `scratch` is working memory.
double contactResidual(const ContactProblem& problem, const Eigen::Ref<const Eigen::VectorXd>& r, SolverScratch& scratch,
                       Eigen::Ref<Eigen::VectorXd> u);

// Solves `problem`. `r` holds the warm start on entry (zeros are fine) and the impulses on return: in the cones to 1e-12 relative, whatever
// happened. `u` receives the contact velocities. Nothing is copied here: copies wait until what they are of is written to its last byte.
void solveContacts(const ContactProblem& problem, const SolverOptions& options, SolverScratch& scratch, double* r, double* u,
                   SolveResult& result);
inline SolveResult solveContacts(const ContactProblem& problem, const SolverOptions& options, SolverScratch& scratch, VectorMap r,
                                 VectorMap u) {
  SolveResult result;
  solveContacts(problem, options, scratch, r.data(), u.data(), result);
  return result;
}

// Impulses that stop what closes, by `sweeps` of Gauss-Seidel from none at all. For a problem without an answer: the iterate with the least residual may
// there be no impulse at all. They bring no energy in, wherever they end; the budget may end them sooner. `u` as above.
void stopBySweeps(const ContactProblem& problem, int sweeps, SolverScratch& scratch, VectorMap r, VectorMap u);

}  // namespace pincer::engine
