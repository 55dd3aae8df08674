#include "pincer/engine/tree/sparse_ldl.h"

#include <algorithm>
#include <cmath>

#include "pincer/engine/tree/slot.h"

namespace pincer::engine {
void addSquare(const TreeModel& tree, std::span<const ColumnShare> c, double weight, std::span<double> M) {
  for (const ColumnShare& a : c) {
    for (const ColumnShare& b : c) {
      if (b.column <= a.column) M[entryOf(tree, a.column, b.column)] += weight * a.share * b.share;
    }
  }
}

namespace {

// Unties locked columns from all others.
void untie(const TreeModel& tree, std::span<const char> locked, std::vector<double>& M) {
  for (int i = 0; i < tree.columnCount(); ++i) {
    for (int j = tree.before[slot(i)]; j >= 0; j = tree.before[slot(j)]) {
      if (locked[slot(i)] || locked[slot(j)]) M[entryOf(tree, i, j)] = 0;
    }
    if (locked[slot(i)]) M[entryOf(tree, i, i)] = 1;
  }
}

}  // namespace

void multiply(const TreeModel& tree, std::span<const double> M, std::span<const double> x, std::span<double> out) {
  for (int i = 0; i < tree.columnCount(); ++i) {
    out[slot(i)] = M[entryOf(tree, i, i)] * x[slot(i)];
    for (int j = tree.before[slot(i)]; j >= 0; j = tree.before[slot(j)]) {
      out[slot(i)] += M[entryOf(tree, i, j)] * x[slot(j)];
      out[slot(j)] += M[entryOf(tree, i, j)] * x[slot(i)];
    }
  }
}

bool factorise(const TreeModel& tree, TreeFactor& factor, std::span<const char> locked) {
  std::vector<double>& M = factor.entries;
  if (!locked.empty()) untie(tree, locked, M);
  bool positive = true;
  for (int k = tree.columnCount() - 1; k >= 0; --k) {
    const double diagonal = M[entryOf(tree, k, k)];
    if (!(diagonal > 0)) positive = false;
    factor.root_inverse[slot(k)] = 1 / std::sqrt(diagonal);
    for (int i = tree.before[slot(k)]; i >= 0; i = tree.before[slot(i)]) {
      double& entry = M[entryOf(tree, k, i)];
      const double share = entry / diagonal;
      // Columns further in than i have kept their entries of row k until it is their turn.
      for (int j = i; j >= 0; j = tree.before[slot(j)]) M[entryOf(tree, i, j)] -= share * M[entryOf(tree, k, j)];
      entry = share;
    }
  }
  for (std::size_t i = 0; i < locked.size(); ++i) {
    if (locked[i]) factor.root_inverse[i] = 0;
  }
  return positive;
}

void solve(const TreeModel& tree, const TreeFactor& factor, std::span<double> x) {
  for (int i = tree.columnCount() - 1; i >= 0; --i) {
    for (int j = tree.before[slot(i)]; j >= 0; j = tree.before[slot(j)])
      x[slot(j)] -= factor.entries[entryOf(tree, i, j)] * x[slot(i)];
  }
  for (std::size_t i = 0; i < x.size(); ++i) x[i] *= factor.root_inverse[i];
  if (!tree.loops.empty()) factor.loops.dropBlocked(x);
  unscale(tree, factor, x);
}

void scaleOpenRow(const TreeModel& tree, const TreeFactor& factor, int tip, std::span<double> row) {
  for (int i = tip; i >= 0; i = tree.before[slot(i)]) {
    for (int j = tree.before[slot(i)]; j >= 0; j = tree.before[slot(j)])
      row[slot(j)] -= row[slot(i)] * factor.entries[entryOf(tree, i, j)];
    row[slot(i)] *= factor.root_inverse[slot(i)];
  }
}

int scaleRow(const TreeModel& tree, const TreeFactor& factor, int tip, std::span<double> row) {
  scaleOpenRow(tree, factor, tip, row);
  if (!tree.loops.empty()) factor.loops.takeFree(row);
  return tipOfRow(tree, tip);
}

void scaleWholeRow(const TreeModel& tree, const TreeFactor& factor, std::span<double> row) {
  for (int i = tree.columnCount() - 1; i >= 0; --i) {
    for (int j = tree.before[slot(i)]; j >= 0; j = tree.before[slot(j)])
      row[slot(j)] -= factor.entries[entryOf(tree, i, j)] * row[slot(i)];
    row[slot(i)] *= factor.root_inverse[slot(i)];
  }
  if (!tree.loops.empty()) factor.loops.takeFree(row);
}

void unscale(const TreeModel& tree, const TreeFactor& factor, std::span<double> x) {
  for (int i = 0; i < tree.columnCount(); ++i) {
    x[slot(i)] *= factor.root_inverse[slot(i)];
    for (int j = tree.before[slot(i)]; j >= 0; j = tree.before[slot(j)])
      x[slot(i)] -= factor.entries[entryOf(tree, i, j)] * x[slot(j)];
  }
}

}  // namespace pincer::engine
