// Working memory of islands: sized for the most contacts and movers that the model may have.
#include <memory>

#include "pincer/engine/world/island_threads.h"
#include "pincer/engine/world/islands.h"
#include "pincer/engine/world/tree_sides.h"

namespace pincer::engine {

IslandScratch::IslandScratch(const WorldModel& model) {
  const auto n = static_cast<std::size_t>(model.options.max_contacts), m = kMaxContactRows * n;
  const std::size_t movers = moverCount(model);
  findBlocks(model, *this);
  if (sides_per_contact > 2) {
    many_sides.resize(static_cast<std::size_t>(sides_per_contact) * n);
    first_side.resize(2 * n + 1);
  }
  islands.reserve(n);
  for (std::vector<int>* per_contact : {&order, &contact_island}) per_contact->resize(n);
  near.reserve(n);
  ends.resize(n);
  for (std::vector<int>* per_mover : {&parent, &number, &island_of}) per_mover->resize(movers);
  first_row.resize(2 * n + 1);
  sides.resize(n);
  filled.resize(n);
  weight.resize(n);
  root_inertia.resize(movers);
  mu.resize(n);
  for (std::vector<double>* per_row : {&q, &r, &u}) per_row->resize(m);
  for (int t = 0; t < model.options.threads; ++t)
    solvers.push_back(std::make_unique<SolverScratch>(
        solverSize(model.options.max_contacts, static_cast<int>(movers), sides_per_contact)));
  if (model.options.threads > 1) threads = std::make_unique<IslandThreads>(model.options.threads);
}

IslandScratch::~IslandScratch() = default;
IslandScratch::IslandScratch(IslandScratch&&) noexcept = default;

}  // namespace pincer::engine
