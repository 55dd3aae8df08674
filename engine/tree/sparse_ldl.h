// sparse_ldl: the factor of a matrix in which a column sees only those on its path to the root (tree_pattern.h).
//
//   M = L^T D L,   L_ij != 0 only for j on the path of i,   L_ii = 1;     outboard first, so that nothing fills in
//
// Of a tree with loops, M^-1 stands for L^-1 D^-1/2 (1 - Q Q^T) D^-1/2 L^-T: the
// answer of the closed tree (loop_basis.h).
//
// Packed: rows by columns' paths. L takes M's place, the entries of D too.
// Source: R. Featherstone, Int. J. Robotics Res. 24 (2005) 487-500.
#pragma once
#include <span>
#include <vector>

#include "pincer/engine/tree.h"
#include "pincer/engine/tree/loop_basis.h"

namespace pincer::engine {

struct TreeFactor {
  explicit TreeFactor(const TreeModel& tree)
      : entries(static_cast<std::size_t>(tree.entries)),
        root_inverse(static_cast<std::size_t>(tree.columnCount())),
        loops(tree) {}
  std::vector<double> entries;       // M, then L and D
  std::vector<double> root_inverse;  // D^-1/2
  LoopBasis loops;                   // of none until factoriseClosed has filled it (loop_closure.h)
};

// A column's share in a length l: dl/dt = sum of share u.
struct ColumnShare {
  int column = 0;
  double share = 0;
};

// The place of columns i and j in the packed matrix, j on the path of i or i itself.
inline std::size_t entryOf(const TreeModel& tree, int i, int j) {
  return static_cast<std::size_t>(tree.row[static_cast<std::size_t>(i)] + tree.depth[static_cast<std::size_t>(j)]);
}

// M += weight c c^T, where all columns of c lie on one path.
void addSquare(const TreeModel& tree, std::span<const ColumnShare> c, double weight, std::span<double> M);

// Factorises in place. False: M isn't positive definite, some column moves no mass. `locked`: true for columns that
// don't move, or empty; those have no share in what the factor gives.
bool factorise(const TreeModel& tree, TreeFactor& factor, std::span<const char> locked = {});

// out = M x, of the packed M before it is factorised.
void multiply(const TreeModel& tree, std::span<const double> M, std::span<const double> x, std::span<double> out);

// x <- M^-1 x
void solve(const TreeModel& tree, const TreeFactor& factor, std::span<double> x);

// row <- row L^-1 D^-1/2, where the row is 0 but on the path of `tip`.
void scaleOpenRow(const TreeModel& tree, const TreeFactor& factor, int tip, std::span<double> row);

// A row of A of the contact problem, W = A A^T = J M^-1 J^T: scaled, and of a tree with loops by the freedoms that
// these leave. Returns the tip of its entries' path.
int scaleRow(const TreeModel& tree, const TreeFactor& factor, int tip, std::span<double> row);
// The same of a row that may be 0 nowhere.
void scaleWholeRow(const TreeModel& tree, const TreeFactor& factor, std::span<double> row);
// That tip, of anything that moves with `column`; -1 if nothing can move it.
inline int tipOfRow(const TreeModel& tree, int column) {
  return column < 0 || tree.loops.empty() ? column : tree.freedomCount() - 1;
}

// x <- L^-1 D^-1/2 x: of movers' scaled velocities A^T r the columns' rates.
void unscale(const TreeModel& tree, const TreeFactor& factor, std::span<double> x);

}  // namespace pincer::engine
