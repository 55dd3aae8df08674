// stuck_steps: stuck_contacts.h's steps from the warm start, whatever form the problem has.
#pragma once
#include "pincer/engine/solve/residual.h"
#include "pincer/engine/solve/stuck_contacts.h"

namespace pincer::engine {

// True if a few steps from the warm start, whose residual `result` has, solved it, by the rules of stuck_contacts.h.
//   Form  error() of its impulses, which finds their velocities; holdWhatPushes(); allStayAsTheyAre(); step();
//         holdsWith(share of friction); maySqueeze()
template <class Form>
bool holdNearest(const ContactProblem& problem, const SolverOptions& options, Form& form, SolverScratch& scratch,
                 SolveResult& result) {
  const double enough = (result.residual <= options.tolerance ? kStrictness : 0.5) * options.tolerance;
  form.holdWhatPushes();
  while (result.iterations < kMostStuckSteps && spend(stuckOperations(problem), scratch) && form.allStayAsTheyAre() &&
         form.step() && form.holdsWith(kStuckFrictionUsed)) {
    const ContactError error = form.error();
    ++result.iterations;
    result.residual = error.residual;
    result.error = error.speed;
    if (error.residual <= enough && !form.maySqueeze()) return true;
  }
  return false;
}

}  // namespace pincer::engine
