#include "pincer/tasks/run/measure/timing.h"

#include <algorithm>
#include <chrono>
#include <cmath>
#include <ctime>
#include <limits>

#include "pincer/contact/functions/invariants.h"

namespace pincer::tasks {
namespace {

double secondsBy(clockid_t clock) {
  timespec t{};
  clock_gettime(clock, &t);
  return static_cast<double>(t.tv_sec) + 1e-9 * static_cast<double>(t.tv_nsec);
}

double costOfReadingTheClock() {
  std::vector<double> pauses;
  for (int i = 0; i < 1001; ++i) {
    const double start = steadySeconds();
    pauses.push_back(steadySeconds() - start);
  }
  return quantileOf(std::move(pauses), 0.5);
}

double cpuSecondsOf(const std::function<void()>& work) {
  const double start = threadCpuSeconds();
  work();
  return threadCpuSeconds() - start;
}

}  // namespace

double quantileOf(std::vector<double> values, double q) {
  PINCER_ASSERT(0 <= q && q <= 1);
  if (values.empty()) return std::numeric_limits<double>::quiet_NaN();
  const double rank = std::ceil(q * static_cast<double>(values.size())) - 1;
  const auto nth = values.begin() + static_cast<std::ptrdiff_t>(std::max(rank, 0.0));
  std::nth_element(values.begin(), nth, values.end());
  return *nth;
}

double threadCpuSeconds() { return secondsBy(CLOCK_THREAD_CPUTIME_ID); }
double processCpuSeconds() { return secondsBy(CLOCK_PROCESS_CPUTIME_ID); }

double steadySeconds() {
  return std::chrono::duration<double>(std::chrono::steady_clock::now().time_since_epoch()).count();
}

CallCost costOfCalls(const std::function<void(std::int64_t i)>& work, const TimingBudget& budget) {
  std::int64_t i = 0;
  for (; i < budget.warm_up; ++i) work(i);
  std::vector<double> batches, singles;
  for (int k = 0; k < budget.batches; ++k) {
    const double seconds = cpuSecondsOf([&] {
      for (int j = 0; j < budget.calls_per_batch; ++j) work(i++);
    });
    batches.push_back(1e9 * seconds / budget.calls_per_batch);
  }
  const double reading = costOfReadingTheClock();
  for (int k = 0; k < budget.single_calls; ++k) {
    const double start = steadySeconds();
    work(i++);
    singles.push_back(1e9 * (steadySeconds() - start - reading));
  }
  return {quantileOf(batches, 0.5), quantileOf(singles, 0.999), quantileOf(singles, 1)};
}

double tailOfWalk(const std::function<void()>& begin, const std::function<void(std::int64_t i)>& work,
                  std::int64_t calls, double q, int walks) {
  const double reading = costOfReadingTheClock();
  std::vector<double> least(static_cast<std::size_t>(calls), std::numeric_limits<double>::infinity());
  for (int k = 0; k < walks; ++k) {
    begin();
    for (std::int64_t i = 0; i < calls; ++i) {
      const double start = steadySeconds();
      work(i);
      double& cost = least[static_cast<std::size_t>(i)];
      cost = std::min(cost, 1e9 * (steadySeconds() - start - reading));
    }
  }
  return quantileOf(std::move(least), q);
}

double ratioOfCosts(const std::function<void()>& a, const std::function<void()>& b, int rounds) {
  a();
  b();
  std::vector<double> ratios;
  for (int i = 0; i < rounds; ++i) {
    const double cost_a = cpuSecondsOf(a), cost_b = cpuSecondsOf(b);
    ratios.push_back(cost_a / cost_b);
  }
  return quantileOf(std::move(ratios), 0.5);
}

}  // namespace pincer::tasks
