#include "engine/solve/residual.h"

#include "engine/solve/cascade.h"
#include "engine/solve/mobility.h"

namespace pincer::engine {

double meanDiagonal(const ContactProblem& problem, int contact) {
  const int rows = problem.rows(contact);
  double sum = 0;
  for (const ContactSide& side : problem.sides[static_cast<std::size_t>(contact)]) {
    if (side.mover < 0) continue;
    for (int k = 0; k < rows; ++k) sum += dot6(side.A[k], side.A[k]);
  }
  return sum / rows;
}

double referenceSpeed(const ContactProblem& problem) {
  double speed = kVelocityFloor;
  for (int row = 0; row < problem.rowCount(); ++row) speed = std::max(speed, std::abs(problem.q.data()[row]));
  return speed;
}

double contactResidual(const ContactProblem& problem, const Eigen::Ref<const Eigen::VectorXd>& r, SolverScratch& scratch,
                       Eigen::Ref<Eigen::VectorXd> u) {
  contactVelocities(problem.sides, problem.first_row, problem.q.data(), r.data(), problem.movers, scratch.y.data(), u.data());
  WorstResidual worst;
  for (int i = 0; i < problem.contactCount(); ++i) {
    const int first = problem.firstRow(i);
    const int rows = problem.rows(i);
    const double* const u_i = u.data() + first;
    const double w = meanDiagonal(problem, i);
    worst.add(naturalMap2(r.data() + first, u_i, rows, problem.friction(i), w), u_i[kNormalRow], w * r.data()[first + kNormalRow]);
  }
  return worst.relativeTo(referenceSpeed(problem));
}

}  // namespace pincer::engine
