#include "pincer/engine/solve/solver_scratch.h"

#include <algorithm>

#include "pincer/engine/solve/few_contacts.h"
#include "pincer/engine/solve/interior_point.h"
#include "pincer/engine/solve/mover_matrix.h"

namespace pincer::engine {
namespace {

constexpr int kBlocksPerMover = 64;     // of the factors: walls of forty bricks by twenty
constexpr int kProductsAtLeast = 4096;  // for few contacts of many movers

void sizeForFew(int contacts, int movers, int movers_per_contact, SolverScratch& s) {
  const auto n = static_cast<std::size_t>(contacts);
  const std::size_t m = kMaxContactRows * n;
  s.max_contacts = contacts;
  s.dense_contacts = std::min(contacts, kDenseContacts);
  for (std::vector<double>* matrix : {&s.W, &s.jacobian}) matrix->resize(m * m);
  for (std::vector<double>* vector : {&s.q, &s.step, &s.response, &s.shift_centre, &s.few_r}) vector->resize(m);
  for (std::vector<double>& vector : s.impulses) vector.resize(m);
  for (std::vector<double>& vector : s.velocities) vector.resize(m);
  s.rhs.resize(std::max(m, kMoverFreedoms * static_cast<std::size_t>(movers)));
  s.workspace.resize(kInteriorPointVectors * m);
  s.pivots.resize(m);
  s.node.resize(static_cast<std::size_t>(movers));
  s.sides.resize(n * static_cast<std::size_t>(movers_per_contact));
  s.terms.resize(n);
  s.scale.resize(n);
  s.active.resize(n);
}

}  // namespace

SolverSize solverSize(int contacts, int movers, int movers_per_contact) {
  return {.contacts = contacts,
          .movers = movers,
          .movers_per_contact = movers_per_contact,
          .places = movers_per_contact * movers_per_contact * contacts,
          .blocks = kBlocksPerMover * std::min({movers, movers_per_contact * contacts, BlockLu::kMaxNodes}),
          .products = std::max(kProductsAtLeast, kProductsPerContact * contacts)};
}

SolverScratch::SolverScratch(const SolverSize& its) : lu(its.movers, its.blocks, its.products) {
  const auto n = static_cast<std::size_t>(its.contacts), m = kMaxContactRows * n;
  const std::size_t size = kMoverFreedoms * static_cast<std::size_t>(its.movers);
  for (std::vector<double>* per_contact : {&weight, &frozen}) per_contact->resize(n);
  for (std::vector<double>* per_row :
       {&r, &u, &centre, &best_r, &best_u, &give, &change, &work, &pushes, &kept_r, &kept_u})
    per_row->resize(m);
  for (std::vector<double>* per_mover : {&y, &direction, &gradient, &way}) per_mover->resize(size);
  local.resize(2 * (kMaxContactRows * m + n));
  round.resize(n);
  places.resize(static_cast<std::size_t>(its.places));
  sizeForFew(std::min(its.contacts, kFewContacts), its.movers, its.movers_per_contact, *this);
}

SolverScratch::SolverScratch(int contacts, int movers) : SolverScratch(solverSize(contacts, movers, 2)) {}

}  // namespace pincer::engine
