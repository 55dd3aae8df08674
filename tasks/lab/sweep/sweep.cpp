#include "pincer/tasks/lab/sweep/sweep.h"

#include <algorithm>
#include <exception>
#include <mutex>

#include "pincer/tasks/run/process/threads.h"

namespace pincer::tasks {

void runSweep(SweepTable& table, const SweepOptions& options, const std::atomic<bool>& interrupted,
              const std::function<std::vector<double>(std::size_t)>& measure) {
  table.results.assign(table.points.size(), {});
  std::atomic<std::size_t> next{0};
  std::mutex mutex;  // guards the rest
  std::int64_t done = 0;
  std::exception_ptr failure;
  const auto work = [&] {
    for (std::size_t i = next++; i < table.points.size(); i = next++) {
      try {
        std::vector<double> result = measure(i);
        if (interrupted) return;  // half a run
        const std::lock_guard lock(mutex);
        table.results[i] = std::move(result);
        if (options.progress) options.progress(++done, static_cast<std::int64_t>(table.points.size()));
      } catch (...) {
        const std::lock_guard lock(mutex);
        if (!failure) failure = std::current_exception();
        next = table.points.size();
      }
    }
  };
  onThreads(options.threads, work);
  if (failure) std::rethrow_exception(failure);
  table.interrupted = interrupted;
}

}  // namespace pincer::tasks
