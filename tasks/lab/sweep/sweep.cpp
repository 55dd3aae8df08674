#include "pincer/tasks/lab/sweep/sweep.h"

#include <fmt/format.h>

#include <algorithm>
#include <charconv>
#include <exception>
#include <limits>
#include <mutex>

#include "pincer/contact/error.h"
#include "pincer/tasks/run/process/threads.h"

namespace pincer::tasks {
namespace {

// -0.0 would come back as 0 from some files and not from others.
CaseResult plain(CaseResult result) {
  for (double& value : result.values) value = value == 0 ? 0 : value;
  result.done = true;
  return result;
}

CaseResult failedCase(const SweepTable& table, const InputError& error) {
  return {true, std::vector<double>(table.measures.size(), std::numeric_limits<double>::quiet_NaN()), "", error.what()};
}

class SweepRun {
 public:
  SweepRun(SweepJob& job, const SweepOptions& options, const std::atomic<bool>& interrupted)
      : job_(job), options_(options), interrupted_(interrupted) {
    for (std::size_t i = 0; i < job.table.points.size(); ++i) {
      if (!options.shard.has(i)) continue;
      ++total_;
      if (job.table.results[i].done)
        ++done_;
      else
        cases_.push_back(i);
    }
  }

  void run() {
    onThreads(options_.threads, [this] {
      for (std::size_t k = next_++; k < cases_.size() && !interrupted_; k = next_++) {
        try {
          runOne(cases_[k]);
        } catch (...) {
          const std::lock_guard lock(mutex_);
          if (!failure_) failure_ = std::current_exception();
          next_ = cases_.size();
        }
      }
    });
    if (failure_) std::rethrow_exception(failure_);
  }

 private:
  void runOne(std::size_t point) {
    CaseResult result = measuredCase(job_, point, interrupted_);
    if (interrupted_) return;  // half a run
    const std::lock_guard lock(mutex_);
    if (options_.finished) options_.finished(point, result);
    job_.table.results[point] = std::move(result);
    if (options_.progress) options_.progress(++done_, total_);
  }

  SweepJob& job_;
  const SweepOptions& options_;
  const std::atomic<bool>& interrupted_;
  std::vector<std::size_t> cases_;
  std::atomic<std::size_t> next_{0};
  std::mutex mutex_;  // guards the rest
  std::int64_t done_ = 0, total_ = 0;
  std::exception_ptr failure_;
};

}  // namespace

std::size_t SweepTable::done() const {
  return static_cast<std::size_t>(
      std::count_if(results.begin(), results.end(), [](const CaseResult& r) { return r.done; }));
}

std::size_t SweepTable::failed() const {
  return static_cast<std::size_t>(
      std::count_if(results.begin(), results.end(), [](const CaseResult& r) { return !r.error.empty(); }));
}

SweepShard parseShard(const std::string& text) {
  SweepShard shard;
  const char* const end = text.data() + text.size();
  const auto first = std::from_chars(text.data(), end, shard.index);
  const bool has_two = first.ec == std::errc() && first.ptr != end && *first.ptr == '/';
  const auto second = has_two ? std::from_chars(first.ptr + 1, end, shard.count) : first;
  constexpr int kMostShards = 100'000;  // as many as a sweep of scenes has cases at most (kMostSceneCases)
  const bool is_whole = has_two && second.ec == std::errc() && second.ptr == end;
  if (is_whole && shard.count >= 1 && shard.count <= kMostShards && shard.index >= 1 && shard.index <= shard.count)
    return shard;
  throw InputError(fmt::format("--shard {}: write I/N, the I-th of N shares, 1 <= I <= N <= {}; for example 2/7", text,
                               kMostShards));
}

CaseResult measuredCase(const SweepJob& job, std::size_t point, const std::atomic<bool>& interrupted) {
  try {
    return plain(job.measure(point, interrupted));
  } catch (const InputError& error) {
    return failedCase(job.table, error);
  }
}

void runSweep(SweepJob& job, const SweepOptions& options, const std::atomic<bool>& interrupted) {
  job.table.results.resize(job.table.points.size());
  SweepRun(job, options, interrupted).run();
  job.table.interrupted = interrupted;
}

}  // namespace pincer::tasks
