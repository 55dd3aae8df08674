// islands: groups of bodies and points that contacts tie together, each a contact problem of its own.
//
// Two contacts are of one island when a chain of contacts links them through things that move; what is static ties
// nothing. Found by union-find over the contacts. Islands are in the order of their first contact, contacts within one
// in the order of their ids, movers in the order in which these name them: an island's numbers, and so its answer to
// the bit, don't depend on what else is in the world. Source: R. Tarjan, J. ACM 22 (1975) 215-225.
#pragma once
#include <memory>
#include <vector>

#include "pincer/contact/math.h"
#include "pincer/engine/solve/contact_solver.h"

namespace pincer::engine {

struct WorldModel;
struct WorldScratch;
class IslandThreads;

// Contacts place .. place + contacts - 1 of IslandScratch::order.
struct Island {
  int place = 0, contacts = 0, movers = 0;
  // Of its rows and sides in IslandScratch's arrays. 0 where islands are solved one after the other, each in the place
  // of the one before, which is in the cache.
  int work = 0;
  int settling = 0;             // the most of its contacts (state.h)
  bool calm = true;             // all that moves of it is as good as at rest
  bool has_many_sides = false;  // its contacts' are in many_sides
  bool has_sides = true;        // they are filled: of grips, whose solve needs none as a rule, later if at all
  bool as_asked = true;         // the solve left what contacts ask for as it was
  bool holds_trees = false;     // contacts of it push on trees, whose drives come to rest over many ticks
  // Filled by solveIslands, without a value before.
  // The solver's view: of one among several islands in IslandScratch, of the only
  // one the world's own (scratch.h), uncopied.
  int rows;
  int* first_row;
  double *mu, *q, *r, *u;
  std::int64_t operations;      // that its solution took (solve/solver_scratch.h)
  std::int64_t hit_operations;  // of them, where it was hit
  SolveResult result;

  Island() {}  // NOLINT(modernize-use-equals-default): a defaulted one would clear all
};

// Movers of a contact; -1 for what doesn't move.
struct ContactEnds {
  int a, b;
};

// The solve and the contact that IslandScratch::sides at a place were filled for.
struct FilledSides {
  std::uint64_t id = 0;  // contact
  std::int64_t solve = -1;
  int number_a = -1, number_b = -1;  // of its movers
};

// Working memory. All arrays but `order` and those per mover begin at Island::work.
struct IslandScratch {
  explicit IslandScratch(const WorldModel& model);
  ~IslandScratch();
  IslandScratch(IslandScratch&&) noexcept;

  std::vector<Island> islands;
  int rows = 0;                     // of all islands
  std::vector<int> near;            // the contacts that are solved, see far_contacts.h
  std::vector<int> order;           // which of all contacts is at a place
  std::vector<int> parent, number;  // per mover: union-find; its number within its island
  std::vector<int> island_of;       // per root mover; per contact, while sorting
  std::vector<int> contact_island;
  std::vector<ContactEnds> ends;  // per contact, in the order of scratch.contacts
  std::vector<int> first_row;     // island by island, each from 0: entries 2 Island::work ..
  std::vector<ContactSides> sides;
  std::vector<FilledSides> filled;  // as `sides`
  std::vector<double> weight;       // as `sides`: weightOf each contact's [1/kg]
  std::int64_t solves = 0;          // of islands, all together
  // Of worlds with trees: blocks are movers after bodies and points, and so is each joint row's own.
  int first_block = 0;            // the first one of those movers
  std::vector<int> block_parent;  // per block: the mover of the block before it on the way to the base, -1
  std::vector<ContactSide>
      // of islands in which a contact has more than two movers, from sides_per_contact times the island's `work` on
      many_sides;
  std::vector<int> first_side;     // likewise, as `first_row`
  int sides_per_contact = 2;       // at most
  std::vector<Mat3> root_inertia;  // per mover of the world: F with F F^T = I^-1, in W [kg^-1/2 m^-1]
  std::vector<double> mu, q, r, u;
  std::vector<std::unique_ptr<SolverScratch>> solvers;  // one per thread
  std::unique_ptr<IslandThreads> threads;               // null with one thread
};

// Of an island that has them.
void takeManySides(const Island& island, const IslandScratch& s, ContactProblem& problem);

// Sorts scratch.contacts into islands, solves each from scratch.q, mu and r, and fills scratch.r, u and solve
// (the worst of all islands' methods and residuals, the sum of their iterations), and what contacts get to know by
// their solution. Allocates nothing.
void solveIslands(const WorldModel& model, WorldScratch& scratch);

}  // namespace pincer::engine
