#include "pincer/engine/solve/contact_solver.h"

#include <algorithm>

#include "pincer/contact/functions/invariants.h"
#include "pincer/engine/solve/cone.h"
#include "pincer/engine/solve/few_contacts.h"
#include "pincer/engine/solve/residual.h"
#include "pincer/engine/solve/search.h"
#include "pincer/engine/solve/small_problem.h"
#include "pincer/engine/solve/squeeze.h"
#include "pincer/engine/solve/stuck_contacts.h"
#include "pincer/engine/solve/sweeps.h"

namespace pincer::engine {
namespace {

constexpr std::int64_t kPerSmallStep = 1000;  // multiplications; of three contacts at most

// Scales r so that the energy that it brings in,  E(r) = r . (q + W r / 2),  isn't positive:
// to the minimum of E on its ray.
// The biases within q count as velocities, and compliance within W as inertia: the best that can be said without
// knowing the bodies, and on the safe side but for work that a bias does on purpose (a penetration pushed out, a
// restitution). False if there was nothing to do.
bool removeAddedEnergy(const ContactProblem& problem, double* r, const double* u) {
  double work = 0;      // r . q
  double response = 0;  // r . W r
  for (int row = 0; row < problem.rowCount(); ++row) {
    work += r[row] * problem.q.data()[row];
    response += r[row] * (u[row] - problem.q.data()[row]);
  }
  if (work + 0.5 * response <= 0) return false;
  const double scale = work < 0 ? -work / response : 0;
  for (int row = 0; row < problem.rowCount(); ++row) r[row] *= scale;
  return true;
}

void solveFew(const ContactProblem& problem, const SolverOptions& options, SolverScratch& scratch, double* r, double* u,
              SolveResult& result) {
  weighContacts(problem, scratch);
  const ContactError start = errorOf(problem, r, scratch, u);
  result = {SolveMethod::kWarmStart, 0, start.residual, start.speed, start.residual, true};
  if (isGoodStart(problem, options, start, referenceSpeed(problem))) return;
  if (!solveStuckContacts(problem, options, scratch, r, u, result))
    solveFewContacts(problem, options, start.residual, scratch, r, u, result);
}

// An unsolved problem brings no energy in.
void settleEnergy(const ContactProblem& problem, SolverScratch& scratch, double* r, double* u, SolveResult& result) {
  if (result.converged || result.yields || !removeAddedEnergy(problem, r, u)) return;
  const ContactError error = errorOf(problem, r, scratch, u);
  result.residual = error.residual;
  result.error = error.speed;
}

}  // namespace

void solveContacts(const ContactProblem& problem, const SolverOptions& options, SolverScratch& scratch, double* r,
                   double* u, SolveResult& result) {
  result = {};
  if (problem.contactCount() == 0) return;
  PINCER_ASSERT(problem.first_row.size() == problem.mu.size() + 1);
  PINCER_ASSERT(problem.firstRow(problem.contactCount()) == problem.rowCount());
  projectOntoCones(problem, r);
  const bool is_solved = solveSmallProblem(problem, options, r, u, result);
  spend(kPerSmallStep * (1 + result.iterations), scratch);
  if (is_solved) return;
  if (problem.contactCount() > kFewContacts) {
    result = searchImpulses(problem, options, scratch, r, u);
  } else {
    solveFew(problem, options, scratch, r, u, result);
  }
  settleEnergy(problem, scratch, r, u, result);
}

bool restsAsItIs(const ContactProblem& problem, const SolverOptions& options, SolverScratch& scratch, const double* r,
                 double* u, SolveResult& result) {
  weighContacts(problem, scratch);
  const ContactError error = errorOf(problem, r, scratch, u);
  if (!(error.speed <= restErrorOf(options))) return false;
  result = {SolveMethod::kWarmStart, 0, error.residual, error.speed, error.residual, true};
  return true;
}

double contactResidual(const ContactProblem& problem, const Eigen::Ref<const Eigen::VectorXd>& r,
                       SolverScratch& scratch, Eigen::Ref<Eigen::VectorXd> u) {
  weighContacts(problem, scratch);
  return errorOf(problem, r.data(), scratch, u.data()).residual;
}

void stopBySweeps(const ContactProblem& problem, int sweeps, SolverScratch& scratch, VectorMap r, VectorMap u) {
  weighContacts(problem, scratch);
  Sweeps(problem, scratch, r.data()).stop(sweeps);
  if (isSqueezed(problem, scratch.weight, r.data())) r.setZero();
  errorOf(problem, r.data(), scratch, u.data());
  if (removeAddedEnergy(problem, r.data(), u.data())) errorOf(problem, r.data(), scratch, u.data());
}

}  // namespace pincer::engine
