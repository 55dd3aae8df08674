// stress: random worlds by seed, in classes of what is hard about them; what must hold
// whatever happens is checked in every tick.
//
//   finite    every place and velocity is a number
//   cones     r_n >= 0 and |r_T| <= mu r_n, with torsion and rolling in the same
//             cone, for every contact, to 1e-9 relative
//   law       the contact law's residual (natural map) of a tick that isn't flagged, computed here afresh, is below
//             1e-6 of the largest speed with contacts or without, or 2e-8 m/s
//   energy    of worlds without drives never above what it began with, what getting out of an initial overlap may lift,
//             and what the couplings of fingers may have given (StressWorld::mostWork)
//   floor     no centre of mass is more than 10 um below the floor
//   cap       one world in five runs again with a budget of 0.5 ms (engine/solve/solver_scratch.h), under the same
//             checks; shown with its longest ticks: where the tick may not be cut any more, needles can sink into the
//             floor (seeds 61, 196, 296, 921 of inertia), three worlds in a hundred at most
//   threads   one world in twenty ends with the same bits where two threads solve
//   states    and so does it where new working memory goes on from the state after every few ticks
// A tick that the engine flags (StepStatus) may miss the law, nothing else. Every failure
// is named with its seed, which repeats it.
#pragma once
#include <cstdint>
#include <vector>

#include "pincer/tasks/run/measure/measurement.h"

namespace pincer::tasks {

struct StressOptions {
  std::uint64_t first_seed = 1;
  int seeds = 200;  // worlds per class
};

// One measurement per class: "stress/mass-ratio", ...
std::vector<Measurement> stressMeasurements(const StressOptions& options);

}  // namespace pincer::tasks
