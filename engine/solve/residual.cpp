#include "pincer/engine/solve/residual.h"

#include "pincer/engine/solve/mobility.h"
#include "pincer/engine/solve/round_contact.h"

namespace pincer::engine {

void weighContacts(const ContactProblem& problem, SolverScratch& scratch) {
  for (int i = 0; i < problem.contactCount(); ++i) {
    if (!problem.round.empty() && problem.round[static_cast<std::size_t>(i)].isRound()) {
      const RoundContact& c = problem.round[static_cast<std::size_t>(i)];
      scratch.weight[static_cast<std::size_t>(i)] = (2 / c.inverse_W_tt + 1 / c.inverse_W_nn) / kTorsionRow;
      continue;
    }
    const int rows = problem.rows(i);
    double sum = 0;
    for (const ContactSide& side : problem.sides[static_cast<std::size_t>(i)]) {
      if (side.mover < 0) continue;
      for (int k = 0; k < rows; ++k) sum += dot6(side.A[k], side.A[k]);
    }
    scratch.weight[static_cast<std::size_t>(i)] = sum / rows;
  }
}

double referenceSpeed(const ContactProblem& problem) {
  double speed = kVelocityFloor;
  for (int row = 0; row < problem.rowCount(); ++row) speed = std::max(speed, std::abs(problem.q.data()[row]));
  return speed;
}

double weighedResidual(const ContactProblem& problem, const double* r, SolverScratch& scratch, double* u) {
  double* const y = scratch.y.data();
  std::fill(y, y + kMoverFreedoms * problem.movers, 0.0);
  for (int i = 0; i < problem.contactCount(); ++i)
    withForm(problem, i, [&](auto rows, const auto& form) { addImpulse(form, rows, r + problem.firstRow(i), y); });
  return respondedResidual(problem, r, scratch, u);
}

double respondedResidual(const ContactProblem& problem, const double* r, SolverScratch& scratch, double* u) {
  WorstResidual worst;
  for (int i = 0; i < problem.contactCount(); ++i) {
    const int first = problem.firstRow(i);
    withForm(problem, i,
             [&](auto rows, const auto& form) { velocityOf(form, rows, problem.q.data() + first, scratch.y.data(), u + first); });
    const double w = scratch.weight[static_cast<std::size_t>(i)];
    worst.add(naturalMap2(r + first, u + first, problem.rows(i), problem.friction(i), w), u[first + kNormalRow], w * r[first + kNormalRow]);
  }
  return worst.relativeTo(referenceSpeed(problem));
}

double contactResidual(const ContactProblem& problem, const Eigen::Ref<const Eigen::VectorXd>& r, SolverScratch& scratch,
                       Eigen::Ref<Eigen::VectorXd> u) {
  weighContacts(problem, scratch);
  return weighedResidual(problem, r.data(), scratch, u.data());
}

}  // namespace pincer::engine
