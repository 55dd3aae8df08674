// mover_matrix: I + A^T G A in the movers' space, G a block per contact, and its factors.
//
// 6 x 6 blocks, one per mover and pair of movers that share a contact: linear in the contacts, whatever the
// number of pairs of them that see each other.
#pragma once
#include <algorithm>

#include "pincer/engine/solve/solver_scratch.h"

namespace pincer::engine {

// Products of blocks in a factorisation, per contact, beyond which sweeps over the contacts
// are cheaper: where a hundred balls touch.
constexpr int kProductsPerContact = 12;
constexpr int kFewProducts = 2000;  // some 60 us: always affordable
inline int affordableProducts(const ContactProblem& problem) {
  return std::max(kFewProducts, kProductsPerContact * problem.contactCount());
}

// The structure of a problem's movers in `lu`, from `begin` on: nodes that share a contact are connected.
//   node_of  the node of a contact's side; -1: none
template <class NodeOf>
void connectMovers(const ContactProblem& problem, int nodes, const NodeOf& node_of, BlockLu& lu) {
  lu.begin(nodes);
  for (int i = 0; i < problem.contactCount(); ++i) {
    const std::span<const ContactSide> sides = problem.sidesOf(i);
    for (std::size_t k = 0; k < sides.size(); ++k) {
      for (std::size_t l = k + 1; l < sides.size(); ++l) {
        const int a = node_of(sides[k]), b = node_of(sides[l]);
        if (a >= 0 && b >= 0) lu.connect(a, b);
      }
    }
  }
}

class MoverMatrix {
 public:
  // Finds the structure, in `scratch`. fits(): the factors do, in memory and in `most` products of blocks.
  MoverMatrix(const ContactProblem& problem, SolverScratch& scratch, int most);
  MoverMatrix(const ContactProblem& problem, SolverScratch& scratch)
      : MoverMatrix(problem, scratch, affordableProducts(problem)) {}
  bool fits() const { return fits_; }

  void clear();  // to I

  // Adds A_i^T g A_i, to be called for all contacts in turn, from the first one on; `skip` where g is 0.
  void addScaled(int i, double g);
  void add(int i, const double (&G)[kMaxContactRows][kMaxContactRows]);
  void skip(int i);

  // False if the budget is spent, or the matrix is singular or not finite.
  bool factorise();
  void solve(double* x) const;               // x becomes H^-1 x
  std::int64_t costOfFactorisation() const;  // and of filling it: multiplications

 private:
  template <class Rows, class Times>
  void addBlocks(int i, Rows rows, const Times& times);

  const ContactProblem& problem_;
  SolverScratch& scratch_;
  bool fits_;
  const int* place_ = nullptr;
};

}  // namespace pincer::engine
