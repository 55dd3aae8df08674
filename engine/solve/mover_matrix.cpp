#include "pincer/engine/solve/mover_matrix.h"

#include <algorithm>
#include <limits>

#include "pincer/contact/functions/invariants.h"
#include "pincer/engine/solve/mobility.h"

namespace pincer::engine {
namespace {

// Where the blocks of each contact lie, side by side; false if there isn't room for all of them.
bool findPlaces(const ContactProblem& problem, SolverScratch& scratch) {
  std::size_t next = 0;
  for (int i = 0; i < problem.contactCount(); ++i) {
    for (const ContactSide& a : problem.sidesOf(i)) {
      for (const ContactSide& b : problem.sidesOf(i)) {
        if (a.mover < 0 || b.mover < 0) continue;
        if (next == scratch.places.size()) return false;
        scratch.places[next++] = scratch.lu.place(a.mover, b.mover);
      }
    }
  }
  return true;
}

// H += A^T GA of so many rows
template <class Rows>
[[gnu::always_inline]] inline void addProduct(Rows rows, const ContactSide& a,
                                              const DoublePair (&GA)[kMaxContactRows][3], double* H) {
  for (int k = 0; k < kMoverFreedoms; ++k, H += kMoverFreedoms) {
    DoublePair* const out = reinterpret_cast<DoublePair*>(H);
    DoublePair h0 = out[0], h1 = out[1], h2 = out[2];
    for (int l = 0; l < rows; ++l) {
      const DoublePair factor = {a.A[l][k], a.A[l][k]};
      h0 += factor * GA[l][0];
      h1 += factor * GA[l][1];
      h2 += factor * GA[l][2];
    }
    out[0] = h0;
    out[1] = h1;
    out[2] = h2;
  }
}

}  // namespace

MoverMatrix::MoverMatrix(const ContactProblem& problem, SolverScratch& scratch, int most)
    : problem_(problem), scratch_(scratch) {
  connectMovers(
      problem, problem.movers, [](const ContactSide& side) { return side.mover; }, scratch.lu);
  fits_ = scratch.lu.order(scratch.is_patient ? std::numeric_limits<int>::max() : most) && findPlaces(problem, scratch);
}

void MoverMatrix::clear() {
  scratch_.lu.clear();
  place_ = scratch_.places.data();
}

template <class Rows, class Times>
[[gnu::always_inline]] inline void MoverMatrix::addBlocks(int i, Rows rows, const Times& times) {
  const std::span<const ContactSide> sides = problem_.sidesOf(i);
  std::size_t moving = 0;
  for (const ContactSide& side : sides) moving += side.mover >= 0;
  std::size_t column = 0;
  for (const ContactSide& b : sides) {
    if (b.mover < 0) continue;
    DoublePair GA[kMaxContactRows][3];
    times(b, GA);
    std::size_t row = 0;
    for (const ContactSide& a : sides) {
      if (a.mover < 0) continue;
      addProduct(rows, a, GA, scratch_.lu.block(place_[moving * row + column]));
      ++row;
    }
    ++column;
  }
  place_ += moving * moving;
}

void MoverMatrix::addScaled(int i, double g) {
  withRows(problem_.rows(i), [&](auto rows) {
    addBlocks(i, rows, [&](const ContactSide& b, DoublePair(&GA)[kMaxContactRows][3]) {
      for (int l = 0; l < rows; ++l) {
        const DoublePair* const A = reinterpret_cast<const DoublePair*>(b.A[l]);
        for (int j = 0; j < 3; ++j) GA[l][j] = g * A[j];
      }
    });
  });
}

void MoverMatrix::add(int i, const double (&G)[kMaxContactRows][kMaxContactRows]) {
  withRows(problem_.rows(i), [&](auto rows) {
    addBlocks(i, rows, [&](const ContactSide& b, DoublePair(&GA)[kMaxContactRows][3]) {
      for (int k = 0; k < rows; ++k) {
        for (int j = 0; j < 3; ++j) GA[k][j] = DoublePair{0, 0};
        for (int l = 0; l < rows; ++l) {
          const DoublePair* const A = reinterpret_cast<const DoublePair*>(b.A[l]);
          for (int j = 0; j < 3; ++j) GA[k][j] += G[k][l] * A[j];
        }
      }
    });
  });
}

void MoverMatrix::skip(int i) {
  std::size_t moving = 0;
  for (const ContactSide& side : problem_.sidesOf(i)) moving += side.mover >= 0;
  place_ += moving * moving;
}

bool MoverMatrix::factorise() { return spend(costOfFactorisation(), scratch_) && scratch_.lu.factorise(); }

std::int64_t MoverMatrix::costOfFactorisation() const {
  constexpr std::int64_t kPerContact = 600;  // multiplications, estimated
  return kPerContact * problem_.contactCount() + scratch_.lu.cost();
}

void MoverMatrix::solve(double* x) const { scratch_.lu.solve(x); }

}  // namespace pincer::engine
