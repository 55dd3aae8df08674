#include "pincer/engine/solve/contact_equations.h"

#include <algorithm>
#include <cmath>
#include <limits>

#include "pincer/engine/solve/inverse3.h"
#include "pincer/engine/solve/linear.h"
#include "pincer/engine/solve/mobility.h"
#include "pincer/engine/solve/mover_matrix.h"

namespace pincer::engine {
namespace {

constexpr int kStride = kMaxContactRows;  // numbers from row to row of a block, however many rows it has

// C = A B over rows x rows.
void multiplyBlocks(const double* A, const double* B, int rows, double* C) {
  withRows(rows, [&](auto count) {
    for (int i = 0; i < count; ++i) {
      for (int j = 0; j < count; ++j) {
        double sum = 0;
        for (int k = 0; k < count; ++k) sum += A[kStride * i + k] * B[kStride * k + j];
        C[kStride * i + j] = sum;
      }
    }
  });
}

inline void multiplyVector(const double* A, const double* x, int rows, double* y) {
  withRows(rows, [&](auto count) {
    for (int i = 0; i < count; ++i) {
      y[i] = 0;
      for (int k = 0; k < count; ++k) y[i] += A[kStride * i + k] * x[k];
    }
  });
}

void clearBlock(double* A, int rows) {
  for (int k = 0; k < kStride * rows; ++k) A[k] = 0;
}

// A becomes its inverse. False if it is singular or not finite.
bool invertBlock(double* A, int rows) {
  if (rows == 3) return invert3<kStride>(A, A);
  double LU[kStride * kStride], inverse[kStride * kStride];
  int pivots[kStride];
  for (int j = 0; j < rows; ++j) {
    for (int i = 0; i < rows; ++i) LU[rows * j + i] = A[kStride * i + j];
  }
  if (!factoriseLu(LU, rows, pivots)) return false;
  for (int j = 0; j < rows; ++j) {
    double column[kStride] = {};
    column[j] = 1;
    solveLu(LU, rows, pivots, column);
    for (int i = 0; i < rows; ++i) inverse[kStride * i + j] = column[i];
  }
  for (int i = 0; i < rows; ++i) std::copy(inverse + kStride * i, inverse + kStride * i + rows, A + kStride * i);
  return true;
}

// The rows of one contact in some columns of W, one every m numbers, go to `out`, one every `size`:
// P W, or W where P is the identity.
struct RowsOfW {
  const double* W;
  int m, size;
  double* out;

  template <class Rows>
  [[gnu::always_inline]] void copy(Rows rows, int columns) {
    for (int column = 0; column < columns; ++column, W += m, out += size) {
      for (int k = 0; k < rows; ++k) out[k] = W[k];
    }
  }
  template <class Rows>
  [[gnu::always_inline]] void multiply(const double* P_columns, Rows rows, int columns) {
    for (int column = 0; column < columns; ++column, W += m, out += size) {
      double sum[kStride] = {};
      for (int l = 0; l < rows; ++l) {
        for (int k = 0; k < rows; ++k) sum[k] += P_columns[kStride * l + k] * W[l];
      }
      for (int k = 0; k < rows; ++k) out[k] = sum[k];
    }
  }
};

// Numbers the movers that two or more contacts touch; returns how many they are. The others get -1.
int numberMovers(const ContactProblem& problem, int* node) {
  std::fill(node, node + problem.movers, 0);
  for (const ContactSide& side : problem.sides) {
    if (side.mover >= 0) ++node[side.mover];
  }
  int nodes = 0;
  for (int mover = 0; mover < problem.movers; ++mover) node[mover] = node[mover] > 1 ? nodes++ : -1;
  return nodes;
}

int nodeOf(const SolverScratch& scratch, const ContactSide& side) {
  return side.mover < 0 ? -1 : scratch.node[side.mover];
}

}  // namespace

EquationForm chooseForm(const ContactProblem& problem, SolverScratch& scratch) {
  const int n = problem.contactCount();
  const int nodes = numberMovers(problem, scratch.node.data());
  const bool may_be_dense = n <= scratch.dense_contacts;
  if (may_be_dense && kMoverFreedoms * nodes >= problem.rowCount()) return EquationForm::kContacts;
  connectMovers(
      problem, nodes, [&](const ContactSide& side) { return nodeOf(scratch, side); }, scratch.lu);
  const int most = may_be_dense ? kFewProducts : std::numeric_limits<int>::max();  // there is no other form
  if (scratch.lu.order(most)) return EquationForm::kMovers;
  return may_be_dense ? EquationForm::kContacts : EquationForm::kTooLarge;
}

ContactEquations::ContactEquations(const ScaledProblem& problem, EquationForm form, SolverScratch& scratch)
    : problem_(problem),
      form_(form),
      scratch_(scratch),
      terms_(scratch.terms.data()),
      A_(scratch.jacobian.data()),
      active_(scratch.active.data()) {
  if (form != EquationForm::kMovers) return;
  for (int i = 0; i < problem.contactCount(); ++i) {
    ContactTerms& t = terms_[i];
    clearBlock(t.R, problem.rows(i));
    t.has_R = false;
    for (const ContactSide& side : problem.sidesOf(i)) {
      if (side.mover < 0 || nodeOf(scratch, side) >= 0) continue;
      addCoupling(side, problem.rows(i), side, problem.rows(i), t.R, kStride);
      t.has_R = true;
    }
  }
}

void ContactEquations::identify(int i, double epsilon) {
  terms_[i].coupling = Coupling::kIdentity;
  terms_[i].epsilon = epsilon;
}

void ContactEquations::setGeneral(int i, const double* E, const double* P) {
  ContactTerms& t = terms_[i];
  t.coupling = Coupling::kGeneral;
  for (int k = 0; k < kStride * problem_.rows(i); ++k) {
    t.E[k] = E[k];
    t.P[k] = P[k];
  }
}

// Multiplications of a factorisation, a solution and what an iteration does around them.
std::int64_t ContactEquations::cost() const {
  constexpr std::int64_t kPerContact = 1000;  // multiplications, estimated
  const std::int64_t m = problem_.rowCount(), contacts = kPerContact * problem_.contactCount();
  return contacts + (form_ == EquationForm::kContacts ? m * m * (m + 24) / 3 : scratch_.lu.cost());
}

bool ContactEquations::factorise() {
  if (!spend(cost(), scratch_)) return false;
  return form_ == EquationForm::kContacts ? factoriseContacts() : factoriseMovers();
}

void ContactEquations::solve(double* x) { form_ == EquationForm::kContacts ? solveContacts(x) : solveMovers(x); }

bool ContactEquations::factoriseContacts() {
  active_count_ = size_ = 0;
  symmetric_ = true;
  for (int i = 0; i < problem_.contactCount(); ++i) {
    if (terms_[i].coupling == Coupling::kNone) continue;
    symmetric_ = symmetric_ && terms_[i].coupling == Coupling::kIdentity;
    active_[active_count_++] = i;
    size_ += problem_.rows(i);
  }
  if (symmetric_ && active_count_ == problem_.contactCount()) {
    for (int k = 0; k < size_ * size_; ++k) A_[k] = problem_.W[k];
    for (int k = 0; k < size_; ++k) A_[(size_ + 1) * k] += terms_[active_[0]].epsilon;
    return factoriseLdlt(A_, size_);
  }
  int row = 0;
  for (int a = 0; a < active_count_; ++a) row += assembleRows(active_[a], row);
  return symmetric_ ? factoriseLdlt(A_, size_) : factoriseLu(A_, size_, scratch_.pivots.data());
}

// Fills the rows of contact i, from `row` on; returns their number.
int ContactEquations::assembleRows(int i, int row) {
  const ContactTerms& t = terms_[i];
  const int m = problem_.rowCount(), rows = problem_.rows(i), first = problem_.firstRow(i);
  int diagonal = 0;  // number of the first column of contact i's own block
  for (int a = 0; active_[a] != i; ++a) diagonal += problem_.rows(active_[a]);
  withRows(rows, [&](auto count) {
    double P_columns[kStride * kStride];
    for (int k = 0; k < count && t.coupling != Coupling::kIdentity; ++k) {
      for (int l = 0; l < count; ++l) P_columns[kStride * l + k] = t.P[kStride * k + l];
    }
    RowsOfW of{problem_.W + first, m, size_, A_ + row};
    for (int a = 0; a < active_count_; ++a) {
      of.W = problem_.W + problem_.firstRow(active_[a]) * m + first;
      const int columns = problem_.rows(active_[a]);
      t.coupling == Coupling::kIdentity ? of.copy(count, columns) : of.multiply(P_columns, count, columns);
    }
  });
  double* const block = A_ + diagonal * size_ + row;
  for (int k = 0; k < rows; ++k) {
    if (t.coupling == Coupling::kIdentity) {
      block[k * size_ + k] += t.epsilon;
    } else {
      for (int l = 0; l < rows; ++l) block[l * size_ + k] += t.E[kStride * k + l];
    }
  }
  return rows;
}

void ContactEquations::solveContacts(double* x) {
  const int m = problem_.rowCount();
  double* const b = scratch_.rhs.data();
  if (active_count_ == problem_.contactCount() && symmetric_) return solveLdlt(A_, size_, x);
  // what is known already goes to the right
  double* const known = scratch_.response.data();
  std::fill(known, known + m, 0.0);
  for (int j = 0; j < problem_.contactCount(); ++j) {
    if (terms_[j].coupling != Coupling::kNone) continue;
    for (int l = problem_.firstRow(j); l < problem_.firstRow(j + 1); ++l) {
      if (x[l] == 0) continue;
      for (int k = 0; k < m; ++k) known[k] += problem_.W[l * m + k] * x[l];
    }
  }
  int row = 0;
  for (int a = 0; a < active_count_; ++a) {
    const int i = active_[a], first = problem_.firstRow(i), rows = problem_.rows(i);
    double Pw[kStride];
    if (terms_[i].coupling == Coupling::kIdentity)
      std::copy(known + first, known + first + rows, Pw);
    else
      multiplyVector(terms_[i].P, known + first, rows, Pw);
    for (int k = 0; k < rows; ++k) b[row++] = x[first + k] - Pw[k];
  }
  symmetric_ ? solveLdlt(A_, size_, b) : solveLu(A_, size_, scratch_.pivots.data(), b);
  row = 0;
  for (int a = 0; a < active_count_; ++a) {
    for (int k = problem_.firstRow(active_[a]); k < problem_.firstRow(active_[a] + 1); ++k) x[k] = b[row++];
  }
}

// K^-1 and G of contact i, K^-1 zero if K is singular.
void ContactEquations::eliminate(int i) {
  ContactTerms& t = terms_[i];
  const int rows = problem_.rows(i);
  if (t.coupling == Coupling::kIdentity) {
    if (t.has_R) {
      for (int k = 0; k < kStride * rows; ++k) t.K_inverse[k] = t.R[k];
      for (int k = 0; k < rows; ++k) t.K_inverse[kStride * k + k] += t.epsilon;
      if (!invertBlock(t.K_inverse, rows)) clearBlock(t.K_inverse, rows);
    } else {
      clearBlock(t.K_inverse, rows);
      for (int k = 0; k < rows; ++k) t.K_inverse[kStride * k + k] = 1 / t.epsilon;
    }
    for (int k = 0; k < kStride * rows; ++k) t.G[k] = t.K_inverse[k];
    return;
  }
  multiplyBlocks(t.P, t.R, rows, t.K_inverse);
  for (int k = 0; k < rows; ++k) {
    for (int l = 0; l < rows; ++l) t.K_inverse[kStride * k + l] += t.E[kStride * k + l];
  }
  if (!invertBlock(t.K_inverse, rows)) clearBlock(t.K_inverse, rows);
  multiplyBlocks(t.K_inverse, t.P, rows, t.G);
}

// H += A_i^T G_i A_i
void ContactEquations::addToMovers(int i) {
  const ContactTerms& t = terms_[i];
  const int rows = problem_.rows(i);
  const bool is_scalar = t.coupling == Coupling::kIdentity && !t.has_R;  // G is a multiple of the identity
  for (const ContactSide& b : problem_.sidesOf(i)) {
    const int column = nodeOf(scratch_, b);
    if (column < 0) continue;
    double GA[kStride][kMoverFreedoms];
    withRows(rows, [&](auto count) {
      for (int k = 0; k < count; ++k) {
        for (int j = 0; j < kMoverFreedoms; ++j)
          GA[k][j] = t.G[kStride * k + (is_scalar ? k : 0)] * b.A[is_scalar ? k : 0][j];
        for (int l = 1; l < count && !is_scalar; ++l) {
          for (int j = 0; j < kMoverFreedoms; ++j) GA[k][j] += t.G[kStride * k + l] * b.A[l][j];
        }
      }
    });
    for (const ContactSide& a : problem_.sidesOf(i)) {
      const int row = nodeOf(scratch_, a);
      if (row < 0) continue;
      double* const H = scratch_.lu.block(scratch_.lu.place(row, column));
      withRows(rows, [&](auto count) {
        for (int k = 0; k < kMoverFreedoms; ++k) {
          double sum[kMoverFreedoms];
          std::copy(H + kMoverFreedoms * k, H + kMoverFreedoms * (k + 1), sum);
          for (int l = 0; l < count; ++l) {
            for (int j = 0; j < kMoverFreedoms; ++j) sum[j] += a.A[l][k] * GA[l][j];
          }
          std::copy(sum, sum + kMoverFreedoms, H + kMoverFreedoms * k);
        }
      });
    }
  }
}

bool ContactEquations::factoriseMovers() {
  BlockLu& H = scratch_.lu;
  H.clear();
  for (int i = 0; i < problem_.contactCount(); ++i) {
    if (terms_[i].coupling == Coupling::kNone) continue;
    eliminate(i);
    addToMovers(i);
  }
  return H.factorise();
}

void ContactEquations::solveMovers(double* x) {
  double* const y = scratch_.rhs.data();
  const auto forNodes = [&](int i, const auto& act) {
    for (const ContactSide& side : problem_.sidesOf(i)) {
      const int node = nodeOf(scratch_, side);
      if (node >= 0) act(side, y + kMoverFreedoms * node);
    }
  };
  int nodes = 0;
  for (int mover = 0; mover < problem_.movers; ++mover) nodes = std::max(nodes, scratch_.node[mover] + 1);
  std::fill(y, y + kMoverFreedoms * nodes, 0.0);
  // x_i = K^-1 b_i - G A y, and y = A^T x: a decoupled contact's x is known, and acts through y alone
  for (int i = 0; i < problem_.contactCount(); ++i) {
    double* const x_i = x + problem_.firstRow(i);
    const int rows = problem_.rows(i);
    if (terms_[i].coupling != Coupling::kNone) {
      double b[kStride];
      std::copy(x_i, x_i + rows, b);
      multiplyVector(terms_[i].K_inverse, b, rows, x_i);
    }
    forNodes(i, [&](const ContactSide& side, double* y_b) {
      withRows(rows, [&](auto count) {
        for (int k = 0; k < count; ++k) {
          for (int j = 0; j < kMoverFreedoms; ++j) y_b[j] += side.A[k][j] * x_i[k];
        }
      });
    });
  }
  scratch_.lu.solve(y);
  for (int i = 0; i < problem_.contactCount(); ++i) {
    if (terms_[i].coupling == Coupling::kNone) continue;
    const int rows = problem_.rows(i);
    double u[kStride] = {}, G_u[kStride];
    forNodes(i, [&](const ContactSide& side, const double* y_b) {
      withRows(rows, [&](auto count) {
        for (int k = 0; k < count; ++k) u[k] += dot6(side.A[k], y_b);
      });
    });
    multiplyVector(terms_[i].G, u, rows, G_u);
    for (int k = 0; k < rows; ++k) x[problem_.firstRow(i) + k] -= G_u[k];
  }
}

}  // namespace pincer::engine
