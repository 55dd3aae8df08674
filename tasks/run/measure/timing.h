// timing: what a call costs, on a machine that does other things too.
//
// Cost: the median over batches of (thread's CPU time of a batch) / (calls in it), after a warm-up; CPU time doesn't
// count what others use. Tail: the q-th smallest of single calls by the steady clock, less the median cost of reading
// that clock; whatever interrupts the process is in it. Ratio of two: batches of one and the other by turns, median of
// the pairs' ratios, so that a slow spell hits both.
#pragma once
#include <cstdint>
#include <functional>
#include <vector>

namespace pincer::tasks {

// `q` in [0, 1], nearest rank; NaN of nothing.
double quantileOf(std::vector<double> values, double q);

double threadCpuSeconds();   // used by this thread so far [s]
double processCpuSeconds();  // by all threads
double steadySeconds();      // [s]

struct CallCost {
  double median = 0;  // ns per call, over batches
  double p999 = 0;    // ns, of single calls
  double worst = 0;   // ns, of single calls
};

struct TimingBudget {
  int warm_up = 1000;  // calls before anything is timed
  int batches = 21;
  int calls_per_batch = 1000;
  int single_calls = 20000;  // timed one by one; 0: no tail
};

// `work(i)` does one call, i = 0, 1, 2, ... without end: paths are walked, not repeated in place.
CallCost costOfCalls(const std::function<void(std::int64_t i)>& work, const TimingBudget& budget = {});

// The q-th smallest cost of a walk's calls [ns], each the least of several walks: a call does the same in all of them,
// what interrupts it doesn't. `begin` puts the walk back to its start, `work(i)` does its i-th call.
double tailOfWalk(const std::function<void()>& begin, const std::function<void(std::int64_t i)>& work,
                  std::int64_t calls, double q = 0.999, int walks = 7);

// Cost of `a` over cost of `b`, each a batch of work [-].
double ratioOfCosts(const std::function<void()>& a, const std::function<void()>& b, int rounds = 11);

}  // namespace pincer::tasks
