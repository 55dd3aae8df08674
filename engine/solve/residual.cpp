#include "engine/solve/residual.h"

#include "engine/solve/cascade.h"

namespace pincer::engine {

double meanDiagonal(const ContactProblem& problem, int contact) {
  const int rows = problem.rows(contact);
  const int next = problem.rowCount() + 1;
  const double* const diagonal = problem.W.data() + problem.firstRow(contact) * next;
  const double sum = diagonal[0] + diagonal[next] + diagonal[2 * next];
  return rows == 4 ? 0.25 * (sum + diagonal[3 * next]) : sum / 3;
}

double referenceSpeed(const ContactProblem& problem) {
  double speed = kVelocityFloor;
  for (int row = 0; row < problem.rowCount(); ++row) speed = std::max(speed, std::abs(problem.q.data()[row]));
  return speed;
}

double contactResidual(const ContactProblem& problem, const Eigen::Ref<const Eigen::VectorXd>& r, Eigen::Ref<Eigen::VectorXd> u) {
  contactVelocities(problem.W.data(), problem.q.data(), r.data(), problem.rowCount(), u.data());
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
