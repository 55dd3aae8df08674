// loop_basis: the directions that a tree's loops block, and those that they leave, in the
// scaled space of its factor (sparse_ldl.h).
//
//   B = G L^-1 D^-1/2,   B H = [R^T 0]
//   H = (Q N): Householder's reflections, rows in the order of what is left of them
//
//   G   how fast each row of the loops opens, by columns
//   Q   spans what is blocked, N what is free:   N N^T = 1 - Q Q^T
// A row of which less than 1e-8 is left says nothing new (two of a planar loop's rows in three), or the loop is at a
// dead centre. There the loops block the direction that is left of it all the same: a tree keeps the number of its
// freedoms. Source: G. H. Golub, C. F. Van Loan, Matrix Computations, 4th ed., 2013, section 5.4.2 (pivoted QR).
#pragma once
#include <span>
#include <vector>

#include "pincer/engine/tree.h"

namespace pincer::engine {

// of a row's length: what is left of one that the others imply; round-off leaves 1e-16
constexpr double kNothingNew = 1e-8;

class LoopBasis {
 public:
  explicit LoopBasis(const TreeModel& tree);

  // Row k of B, to be filled before `factorise`.
  std::span<double> row(int k) { return std::span(rows_).subspan(placeOf(k), columns_); }
  void factorise();
  int rank() const { return rank_; }  // of the rows that say something new

  // x <- (1 - Q Q^T) x
  void dropBlocked(std::span<double> x) const;
  // x <- N^T x, then zeros.
  void takeFree(std::span<double> x) const;
  // The least x with B x = `want`, where what is wanted can be had.
  void closing(std::span<const double> want, std::span<double> x) const;

 private:
  std::size_t placeOf(int k) const { return static_cast<std::size_t>(k) * columns_; }
  std::span<const double> solvedRow(int k) const { return std::span(rows_).subspan(placeOf(k), columns_); }
  std::span<const double> mirror(int k) const { return std::span(mirrors_).subspan(placeOf(k), columns_); }
  void scaleRows();
  void pivot(int k);
  void reflect(int k, std::span<double> x) const;

  std::size_t columns_;
  int least_;      // TreeModel::blocked
  int count_ = 0;  // rows of B
  int rank_ = 0, reflections_ = 0;
  std::vector<int> unit_ends_;          // ends of the rows that a loop has of one unit: its points', its turns'
  std::vector<double> rows_, mirrors_;  // B, then R^T; each reflection's normal, of length sqrt 2
  std::vector<double> row_scale_;       // B's rows were divided by it
  std::vector<int> order_;              // R's rows in B
};

}  // namespace pincer::engine
