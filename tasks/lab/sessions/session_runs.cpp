#include "pincer/tasks/lab/sessions/session_runs.h"

#include <cmath>
#include <exception>
#include <filesystem>
#include <mutex>

#include "pincer/contact/error.h"
#include "pincer/tasks/run/process/threads.h"

namespace pincer::tasks {
namespace {

enum class Left : std::uint8_t { kNothing, kBegun, kWhole };

Left look(const SessionRun& run) {
  if (!std::filesystem::exists(run.path)) return Left::kNothing;
  const SessionReader there(run.path);
  const SessionInfo& a = there.info();
  const SessionInfo& b = run.info;
  if (a.task != b.task || a.protocol_json != b.protocol_json || a.participants_json != b.participants_json ||
      a.seed != b.seed) {
    throw InputError(
        run.path + ": is of another design, seed or of other participants than would be run now. Give another --out.");
  }
  return there.complete() ? Left::kWhole : Left::kBegun;
}

class SessionWorkshop {
 public:
  SessionWorkshop(const std::vector<SessionRun>& runs, const std::atomic<bool>& interrupted,
                  const std::function<void(std::int64_t, std::int64_t)>& progress)
      : runs_(runs), interrupted_(interrupted), progress_(progress), shares_(runs.size()) {
    for (const SessionRun& run : runs) found_.push_back(look(run));
  }

  void run(int threads) {
    onThreads(threads, [this] { work(); });
    if (failure_) std::rethrow_exception(failure_);
  }

 private:
  void work() {
    try {
      for (std::size_t k = next_++; k < runs_.size() && !interrupted_; k = next_++) {
        if (found_[k] != Left::kWhole) runs_[k].run(found_[k] == Left::kBegun, [&](double share) { note(k, share); });
        if (!interrupted_) note(k, 1);
      }
    } catch (...) {
      const std::lock_guard lock(mutex_);
      if (!failure_) failure_ = std::current_exception();
      next_ = runs_.size();
    }
  }
  void note(std::size_t k, double share) {
    const std::lock_guard lock(mutex_);
    sum_ += share - shares_[k];
    shares_[k] = share;
    if (progress_) progress_(std::lround(1000 * sum_), 1000 * static_cast<std::int64_t>(shares_.size()));
  }

  const std::vector<SessionRun>& runs_;
  const std::atomic<bool>& interrupted_;
  const std::function<void(std::int64_t, std::int64_t)>& progress_;
  std::vector<Left> found_;
  std::atomic<std::size_t> next_{0};
  std::mutex mutex_;  // guards the rest
  std::vector<double> shares_;
  double sum_ = 0;
  std::exception_ptr failure_;
};

}  // namespace

void runSessions(const std::vector<SessionRun>& runs, int threads, const std::atomic<bool>& interrupted,
                 const std::function<void(std::int64_t, std::int64_t)>& progress) {
  SessionWorkshop(runs, interrupted, progress).run(threads);
}

}  // namespace pincer::tasks
