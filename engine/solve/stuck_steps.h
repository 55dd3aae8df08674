// stuck_steps: stuck_contacts.h's steps from the warm start, of problems that have a form of their own.
#pragma once
#include "pincer/engine/solve/residual.h"
#include "pincer/engine/solve/stuck_contacts.h"

namespace pincer::engine {

// True if the warm start, or a few steps from there, solved it, by the rules of stuck_contacts.h; fills `result`.
//   Form  error() of its impulses, which finds their velocities; speed(); holdWhatPushes(); allStayAsTheyAre(); step();
//         holdsWith(share of friction); maySqueeze()
template <class Form>
bool holdNearest(const ContactProblem& problem, const SolverOptions& options, Form& form, SolverScratch& scratch,
                 SolveResult& result) {
  const ContactError start = form.error();
  result = {SolveMethod::kWarmStart, 0, start.residual, start.speed, start.residual, true};
  if (isGoodStart(problem, options, start, form.speed())) return true;
  const std::int64_t operations_left = scratch.operations_left, cost = stuckOperations(problem);
  const double enough = (start.residual <= options.tolerance ? kStrictness : 0.5) * options.tolerance;
  result.method = SolveMethod::kNewton;
  form.holdWhatPushes();
  while (result.iterations < kMostStuckSteps && spend(cost, scratch) && form.allStayAsTheyAre() && form.step() &&
         form.holdsWith(kStuckFrictionUsed)) {
    const ContactError error = form.error();
    ++result.iterations;
    result.residual = error.residual;
    result.error = error.speed;
    if (!(error.residual <= enough)) continue;
    if (!form.maySqueeze()) return true;
    break;
  }
  scratch.operations_left = operations_left;
  return false;
}

}  // namespace pincer::engine
