// solver_scratch: working memory of solveContacts, sized once; what it holds means nothing between calls, but for
// the structure of the last factorisation.
#pragma once
#include <array>
#include <cstdint>
#include <limits>
#include <vector>

#include "pincer/engine/solve/block_lu.h"
#include "pincer/engine/solve/contact_problem.h"

namespace pincer::engine {

// Multiplications in a second, of iterations as they are counted: few enough that on an AMD EPYC at 3.7 GHz capped
// ticks take no longer than their cap (`pincer stress` shows the longest; decision 4).
constexpr double kOperationsPerSecond = 8e8;
constexpr std::int64_t kNoLimit = std::numeric_limits<std::int64_t>::max() / 2;

// How a contact takes part in the linear equations of contact_equations.h;
// blocks row-major with stride kMaxContactRows.
enum class Coupling : std::uint8_t { kNone, kIdentity, kGeneral };
struct ContactTerms {
  static constexpr int kSize = kMaxContactRows * kMaxContactRows;  // numbers of a contact's block
  Coupling coupling = Coupling::kNone;
  bool has_R = false;
  double epsilon = 0;
  double E[kSize], P[kSize], R[kSize], K_inverse[kSize], G[kSize];
};

// Sizes that memory has to be there for.
struct SolverSize {
  int contacts, movers;    // at most
  int movers_per_contact;  // likewise
  int places;              // of blocks: the squared number of movers of each contact, summed
  int blocks, products;    // of the movers' matrix: in its factors; in a factorisation, beyond which none is tried
};

// For contacts of at most so many movers each.
SolverSize solverSize(int contacts, int movers, int movers_per_contact);

struct SolverScratch {
  explicit SolverScratch(const SolverSize& size);

  // For at most `max_contacts` of two movers each, at most `max_movers` in all.
  SolverScratch(int max_contacts, int max_movers);

  std::int64_t operations_left = kNoLimit;  // of the budget; less than 0: spent
  std::int64_t hit_operations = kNoLimit;   // of them, those that solves of what is hit may still take in this tick
  int haste = 1;                            // a search takes so many times fewer operations
  std::vector<double> weight;               // w_i, mean of W_ii's diagonal, per contact [1/kg]
  std::vector<double> frozen;               // shifts, per contact [m/s]; proximal_round.h
  // Per row: impulses and velocities of the iterate, the rounds' centre r_c, the best iterate, what
  // contacts gave way by, and what methods need.
  std::vector<double> r, u, centre, best_r, best_u, give, change, work;
  // Per row: biases that were left out of q [m/s], from torsion on [rad/s]; the answer before that.
  std::vector<double> pushes, kept_r, kept_u;
  // Per mover: y = A^T r, a direction, a gradient, and what methods need.
  std::vector<double> y, direction, gradient, way;
  std::vector<double> local;        // sweeps.h
  std::vector<RoundContact> round;  // round_contact.h
  std::vector<int> places;          // mover_matrix.h
  BlockLu lu;
  bool is_patient = false;  // factorises whatever there is memory for

  // Of few_contacts.h: the scaled problem, linear equations, three iterates.
  int max_contacts = 0, dense_contacts = 0;
  std::vector<ContactSide> sides;  // of all contacts, as many as the problem's
  std::vector<double> W, q, scale, jacobian, step, rhs, response, shift_centre, workspace;
  std::vector<double> few_r;                                // impulses found before the interior point
  std::array<std::vector<double>, 3> impulses, velocities;  // current, trial and best iterate
  std::vector<int> active, pivots;                          // contacts in the dense equations; row swaps
  std::vector<ContactTerms> terms;                          // contact_equations.h
  std::vector<int> node;                                    // of movers in `lu`
};

// False, and nothing more may be spent, if that is more than what is left of the budget.
inline bool spend(std::int64_t operations, SolverScratch& scratch) {
  scratch.operations_left -= operations;
  return scratch.operations_left >= 0;
}

}  // namespace pincer::engine
