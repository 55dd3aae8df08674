// step_status_text: what a tick had to report (engine::StepStatus), counted over a run, in sentences for a person.
#pragma once
#include <array>
#include <cstdint>
#include <string>
#include <vector>

#include "pincer/engine/step.h"

namespace pincer::tasks {

struct StatusKind {
  std::uint32_t bit;
  const char* key;       // in JSON
  const char* sentence;  // what happened, and what to change
};

// By bit of engine::StepStatus.
constexpr std::array<StatusKind, 8> kStatusKinds = {{
    {engine::kSolverNotConverged, "solver_not_converged",
     "the contact solver stopped before its tolerance; its impulses are safe, but not exact. Loosen solver.tolerance, "
     "or look for contacts "
     "that "
     "contradict each other."},
    {engine::kContactsDropped, "contacts_dropped",
     "there were more contacts than solver.max_contacts: the shallowest were left out. Raise it."},
    {engine::kStateNotFinite, "state_not_finite",
     "a number overflowed; the run was ended. Look for extreme masses, velocities or stiffnesses."},
    {engine::kInputNotFinite, "input_not_finite",
     "a finger's target wasn't a number; the finger stayed at its last one."},
    {engine::kImpactsCut, "impacts_cut",
     "bodies hit each other more often than a tick can be cut; some hits landed. Shorten the tick."},
    {engine::kBudgetSpent, "budget_spent",
     "the solver's budget ran out: the best iterate counts. Raise solver.budget, or simplify the scene."},
    {engine::kToleranceNotMet, "tolerance_not_met",
     "solver.max_parts were too few for solver.position_tolerance. Raise max_parts, or the tolerance."},
    {engine::kTurnsTooFar, "turns_too_far",
     "a joint turned by more than half a radian in a 64th of a tick, or a driven body pushed something almost through "
     "its axis; its course isn't exact. Shorten the tick, or damp the joint."},
}};

class StatusCounts {
 public:
  void add(std::uint32_t status) {
    if (status == engine::kStepOk) return;
    for (std::size_t i = 0; i < kStatusKinds.size(); ++i) counts_[i] += (status & kStatusKinds[i].bit) != 0 ? 1 : 0;
  }
  std::int64_t of(std::size_t kind) const { return counts_[kind]; }

 private:
  std::array<std::int64_t, kStatusKinds.size()> counts_{};  // ticks
};

}  // namespace pincer::tasks
