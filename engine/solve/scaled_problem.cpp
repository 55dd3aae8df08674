#include "engine/solve/scaled_problem.h"

#include "engine/solve/residual.h"

namespace pincer::engine {
namespace {

void scaleColumn(const ContactProblem& problem, const double* scale, double scale_j, const double* from, double* to) {
  for (int i = 0; i < problem.contactCount(); ++i) {
    const double factor = 1 / (scale[i] * scale_j);
    for (int row = problem.firstRow(i); row < problem.firstRow(i + 1); ++row) to[row] = from[row] * factor;
  }
}

}  // namespace

ScaledProblem scaleProblem(const ContactProblem& problem, SolverScratch& scratch) {
  const int m = problem.rowCount();
  double* const scale = scratch.scale.data();
  for (int i = 0; i < problem.contactCount(); ++i) scale[i] = std::sqrt(meanDiagonal(problem, i));
  for (int j = 0; j < problem.contactCount(); ++j)
    for (int row = problem.firstRow(j); row < problem.firstRow(j + 1); ++row) {
      scaleColumn(problem, scale, scale[j], problem.W.data() + row * m, scratch.W.data() + row * m);
      scratch.q.data()[row] = problem.q.data()[row] / scale[j];
    }
  return {problem.first_row, problem.mu, scratch.W.data(), scratch.q.data(), scale, referenceSpeed(problem)};
}

void evaluate(const ScaledProblem& problem, Iterate& it) {
  contactVelocities(problem.W, problem.q, it.r, problem.rowCount(), it.u);
  WorstResidual worst;
  for (int i = 0; i < problem.contactCount(); ++i) {
    const int first = problem.firstRow(i);
    const int rows = problem.rows(i);
    const double* const u_i = it.u + first;
    const double error2 = naturalMap2(it.r + first, u_i, rows, problem.friction(i), 1);  // in scaled variables w_i is 1
    worst.add(error2 * problem.scale[i] * problem.scale[i], u_i[kNormalRow], problem.scale[i] * it.r[first + kNormalRow]);
  }
  it.residual = worst.relativeTo(problem.speed);
}

}  // namespace pincer::engine
