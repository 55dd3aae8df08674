// loop_closure: joints that close loops in a tree (engine/tree.h, TreeLoop).
//
//   c(q) = 0,   G u = dc/dt,   G u' + (dG/dt) u = c''
//   a row: n . x or m . turn, of J on a past J on b, in axes of J on b
//
//   point    c = n . (x_a - x_b),    c'' = n . (a_a - a_b - 2 w_b x u),   all at x_a; u = v_a - v_b there
//   turn     c = m . theta,          c'' = m . (alpha_a - alpha_b - w_b x (w_a - w_b))
//
// In a tick the columns' rates go on so that G u+ = -h/2 (dG/dt) u with the G of its middle; at its end places and then
// rates are projected onto the loops, along the tree's own inertia, so that loops never drift.
// Source: E. Hairer, C. Lubich, G. Wanner, Geometric Numerical Integration, 2nd ed., 2006, IV.4.
#pragma once
#include <span>
#include <vector>

#include "pincer/engine/tree/sparse_ldl.h"
#include "pincer/engine/tree/tree_bias.h"

namespace pincer::engine {

// Rows of all loops of a tree at one place.
struct LoopRows {
  explicit LoopRows(const TreeModel& tree);
  std::vector<double> G, miss;  // row by row; c
  std::vector<double> want;     // scratch, by rows
  std::vector<double> change;   // by columns

  std::span<double> row(std::size_t k) { return std::span(G).subspan(k * change.size(), change.size()); }
};

// G and c at a place.
void fillLoops(const TreeModel& tree, const TreeBase& base, const TreePlace& place, LoopRows& rows);

// Factorises M, and the loops in its metric. False: M isn't positive definite.
// Of a tree without loops `rows` are empty.
bool factoriseClosed(const TreeModel& tree, LoopRows& rows, TreeFactor& factor);

// rows.want = -G u
void wantNoOpening(std::span<const double> u, LoopRows& rows);
// rows.want -= `share` (dG/dt) u: after moveLinks and fillBias at these rates.
void wantBend(const TreeModel& tree, const TreeBase& base, const Vec3& gravity_W, const TreePlace& place,
              std::span<const LinkBias> biases, double share, LoopRows& rows);
// Adds the least change, in M, that gives the loops what is wanted.
void addWanted(const TreeModel& tree, const TreeFactor& factor, LoopRows& rows, std::span<double> x);

constexpr int kClosingPasses = 3;  // of Newton's method from a tick's error: 1e-6, 1e-12, round-off

// Projects q onto the loops by Newton's method, at most `passes` steps, and then u, in the metric of `factor`. `place`
// is that of q before and after. Returns the largest miss that is left [m, rad].
double closeLoops(const TreeModel& tree, const TreeBase& base, const TreeFactor& factor, int passes, LoopRows& rows,
                  LoopBasis& basis, std::span<double> q, std::span<double> u, TreePlace& place);

// Directions that the loops block near `q` (q_count numbers), which moves to where they are closed; 0 if they
// can't be closed from there. For builders.
int blockedNear(const TreeModel& tree, std::span<double> q);

}  // namespace pincer::engine
