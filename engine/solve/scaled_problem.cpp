#include "pincer/engine/solve/scaled_problem.h"

#include "pincer/contact/functions/invariants.h"
#include "pincer/engine/solve/mobility.h"
#include "pincer/engine/solve/residual.h"
#include "pincer/engine/solve/wide.h"

namespace pincer::engine {
namespace {

void scaleContact(std::span<const ContactSide> from, int rows, double factor, ContactSide* to) {
  for (std::size_t s = 0; s < from.size(); ++s) {
    to[s].mover = from[s].mover;
    if (from[s].mover < 0) continue;
    withRows(rows, [&](auto count) {
      for (int k = 0; k < count; ++k) {
        for (int j = 0; j < kMoverFreedoms; ++j) to[s].A[k][j] = factor * from[s].A[k][j];
      }
    });
  }
}

// W^'s block of contacts i and j, and its transpose.
void fillBlock(const ContactProblem& problem, const double* scale, int i, int j, double* W) {
  const int m = problem.rowCount(), columns = problem.rows(j);
  double block[kMaxContactRows * kMaxContactRows] = {};
  for (const ContactSide& x : problem.sidesOf(i)) {
    for (const ContactSide& y : problem.sidesOf(j)) {
      if (x.mover >= 0 && x.mover == y.mover) addCoupling(x, problem.rows(i), y, columns, block, kMaxContactRows);
    }
  }
  const double factor = 1 / (scale[i] * scale[j]);
  double* const upper = W + problem.firstRow(i) * m + problem.firstRow(j);
  double* const lower = W + problem.firstRow(j) * m + problem.firstRow(i);
  withRows(problem.rows(i), [&](auto rows) {
    for (int k = 0; k < rows; ++k) {
      for (int l = 0; l < columns; ++l) upper[k * m + l] = lower[l * m + k] = factor * block[kMaxContactRows * k + l];
    }
  });
}

// Numbers of W r that stay in registers, column by column.
template <class Lanes, int count>
[[gnu::always_inline]] inline void multiplyTile(const double* W, const double* r, int m, double* out) {
  typename Lanes::Numbers sum[count] = {};
  for (int l = 0; l < m; ++l, W += m) {
    for (int k = 0; k < count; ++k) sum[k] += Lanes::at(W + Lanes::count * k) * r[l];
  }
  for (int k = 0; k < count; ++k) Lanes::at(out + Lanes::count * k) = sum[k];
}

// out = W r
template <class Lanes>
[[gnu::always_inline]] inline void multiplyDense(const double* W, const double* r, int m, double* out) {
  constexpr int kTile = 4;
  int row = 0;
  for (; row + kTile * Lanes::count <= m; row += kTile * Lanes::count)
    multiplyTile<Lanes, kTile>(W + row, r, m, out + row);
  for (; row + Lanes::count <= m; row += Lanes::count) multiplyTile<Lanes, 1>(W + row, r, m, out + row);
  for (; row < m; ++row) {
    double sum = 0;
    for (int l = 0; l < m; ++l) sum += W[l * m + row] * r[l];
    out[row] = sum;
  }
}

}  // namespace

ScaledProblem scaleProblem(const ContactProblem& problem, bool dense, SolverScratch& scratch) {
  const int n = problem.contactCount();
  for (int i = 0; i < n; ++i) {
    const double scale = scratch.scale[i] = std::sqrt(scratch.weight[static_cast<std::size_t>(i)]);
    for (int row = problem.firstRow(i); row < problem.firstRow(i + 1); ++row)
      scratch.q[row] = problem.q.data()[row] / scale;
  }
  ScaledProblem scaled{problem.first_row,
                       problem.mu,
                       {scratch.sides.data(), problem.sides.size()},
                       nullptr,
                       scratch.q.data(),
                       scratch.scale.data(),
                       scratch.y.data(),
                       referenceSpeed(problem),
                       problem.movers,
                       problem.first_side};
  if (!dense) {
    scaleSides(problem, scratch);
    return scaled;
  }
  for (int i = 0; i < n; ++i) {
    for (int j = i; j < n; ++j) fillBlock(problem, scratch.scale.data(), i, j, scratch.W.data());
  }
  scaled.W = scratch.W.data();
  return scaled;
}

void scaleSides(const ContactProblem& problem, SolverScratch& scratch) {
  PINCER_ASSERT(problem.sides.size() <= scratch.sides.size());
  for (int i = 0; i < problem.contactCount(); ++i) {
    const std::span<const ContactSide> from = problem.sidesOf(i);
    scaleContact(from, problem.rows(i), 1 / scratch.scale[i],
                 scratch.sides.data() + (from.data() - problem.sides.data()));
  }
}

void multiply(const ScaledProblem& problem, const double* r, double* out) {
  const int m = problem.rowCount();
  if (problem.W)
    return wide([&](auto lanes)
                    __attribute__((always_inline)) { multiplyDense<decltype(lanes)>(problem.W, r, m, out); });
  for (int row = 0; row < m; ++row) out[row] = 0;
  std::fill(problem.y, problem.y + kMoverFreedoms * problem.movers, 0.0);
  for (int i = 0; i < problem.contactCount(); ++i) {
    addImpulse(problem.sidesOf(i), problem.rows(i), r + problem.firstRow(i), problem.y);
  }
  for (int i = 0; i < problem.contactCount(); ++i) {
    addVelocity(problem.sidesOf(i), problem.rows(i), problem.y, out + problem.firstRow(i));
  }
}

std::int64_t costOfLook(const ScaledProblem& problem) {
  constexpr std::int64_t kPerContact = 150, kPerProduct = 100;  // a product of movers: two blocks of 18, to and fro
  const std::int64_t n = problem.contactCount(), m = problem.rowCount();
  return kPerContact * n + (problem.W ? m * m : kPerProduct * n);
}

void judge(const ScaledProblem& problem, Iterate& it) {
  WorstResidual worst;
  for (int i = 0; i < problem.contactCount(); ++i) {
    const int first = problem.firstRow(i);
    const double* const u_i = it.u + first;
    // in scaled variables w_i is 1
    const double error2 = naturalMap2(it.r + first, u_i, problem.rows(i), problem.friction(i), 1);
    const double scale = problem.scale[i];
    worst.add(error2 * scale * scale, u_i[kNormalRow], scale * it.r[first + kNormalRow]);
  }
  it.residual = worst.relativeTo(problem.speed).residual;
}

void evaluate(const ScaledProblem& problem, Iterate& it) {
  multiply(problem, it.r, it.u);
  for (int row = 0; row < problem.rowCount(); ++row) it.u[row] += problem.q[row];
  judge(problem, it);
}

}  // namespace pincer::engine
