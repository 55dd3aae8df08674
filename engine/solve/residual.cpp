#include "pincer/engine/solve/residual.h"

#include <algorithm>

#include "pincer/engine/solve/contact_solver.h"
#include "pincer/engine/solve/mobility.h"
#include "pincer/engine/solve/round_contact.h"

namespace pincer::engine {

constexpr double kConeRoundOff =
    1e-14;  // relative: an impulse on the cone isn't projected again, so a warm start that fits stays, to the bit

void projectOntoCones(const ContactProblem& problem, double* r) {
  for (int i = 0; i < problem.contactCount(); ++i) {
    const int rows = problem.rows(i);
    double* const r_i = r + problem.firstRow(i);
    if (isInCone(r_i, rows, problem.friction(i), kConeRoundOff)) continue;
    projectOntoCone(r_i, rows, problem.friction(i), r_i);
    double check = 0;
    for (int k = 0; k < rows; ++k) check += r_i[k];
    if (!std::isfinite(check)) std::fill(r_i, r_i + rows, 0.0);
  }
}

double weightOf(std::span<const ContactSide> sides, int rows) {
  double sum = 0;
  withRows(rows, [&](auto count) {
    for (const ContactSide& side : sides) {
      if (side.mover < 0) continue;
      for (int k = 0; k < count; ++k) sum += dot6(side.A[k], side.A[k]);
    }
  });
  return sum / rows;
}

void weighContacts(const ContactProblem& problem, SolverScratch& scratch) {
  if (!problem.weight.empty()) {
    std::copy(problem.weight.begin(), problem.weight.end(), scratch.weight.begin());
    return;
  }
  for (int i = 0; i < problem.contactCount(); ++i)
    scratch.weight[static_cast<std::size_t>(i)] = weightOf(problem.sidesOf(i), problem.rows(i));
}

double referenceSpeed(const ContactProblem& problem) {
  double speed = kVelocityFloor;
  for (int row = 0; row < problem.rowCount(); ++row) speed = std::max(speed, std::abs(problem.q.data()[row]));
  return speed;
}

void respond(const ContactProblem& problem, const double* r, SolverScratch& scratch) {
  double* const y = scratch.y.data();
  std::fill(y, y + kMoverFreedoms * problem.movers, 0.0);
  for (int i = 0; i < problem.contactCount(); ++i) {
    if (r[problem.firstRow(i) + kNormalRow] == 0) continue;  // in the cone: then all of it is 0
    withForm(problem, i, [&](auto rows, const auto& form) { addImpulse(form, rows, r + problem.firstRow(i), y); });
  }
}

ContactError respondedError(const ContactProblem& problem, const double* r, const SolverScratch& scratch, double* u) {
  WorstResidual worst;
  for (int i = 0; i < problem.contactCount(); ++i) {
    const int first = problem.firstRow(i);
    withForm(problem, i, [&](auto rows, const auto& form) {
      velocityOf(form, rows, problem.q.data() + first, scratch.y.data(), u + first);
    });
    const double w = scratch.weight[static_cast<std::size_t>(i)];
    worst.add(naturalMap2(r + first, u + first, problem.rows(i), problem.friction(i), w), u[first + kNormalRow],
              w * r[first + kNormalRow]);
  }
  return worst.relativeTo(referenceSpeed(problem));
}

bool isGoodStart(const ContactProblem& problem, const SolverOptions& options, const ContactError& start, double speed) {
  if (problem.calm && start.speed <= restErrorOf(options)) return true;
  return start.residual <= options.tolerance &&
         (!problem.strict || start.residual <= exactResidual(options.tolerance, problem.noise, speed));
}

double fastestSlip(const ContactProblem& problem, const double* r, const double* u) {
  double fastest2 = 0;
  for (int i = 0; i < problem.contactCount(); ++i) {
    const int first = problem.firstRow(i);
    if (r[first + kNormalRow] > 0) fastest2 = std::max(fastest2, tangentNorm2(u + first, problem.rows(i)));
  }
  return std::sqrt(fastest2);
}

}  // namespace pincer::engine
