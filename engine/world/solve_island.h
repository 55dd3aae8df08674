// solve_island: one island's contact problem, and what to do where it has no answer.
//
// Contacts' gaps may contradict each other: round loops of bodies (island_bias.h), between walls that lock (wedge.h).
// It is fitted to what bodies can do before the solve, and once more to the impulses found if that fails; then contacts
// give way by as little as they must (solve/contact_solver.h). What still has no answer only stops what closes.
#pragma once

namespace pincer::engine {

struct WorldModel;
struct WorldScratch;

// Fills r, u, result and operations of scratch.islands.islands[k]. Several islands at once, each with
// a `thread` of its own. Allocates nothing.
void solveIsland(const WorldModel& model, int k, int thread, WorldScratch& scratch);

}  // namespace pincer::engine
