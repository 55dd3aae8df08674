// tick_times: how long ticks took: every one up to a million, then every n-th, so that memory stays bounded (8 MB).
#pragma once
#include <chrono>
#include <cstdint>
#include <vector>

namespace pincer::tasks {

class TickTimes {
 public:
  explicit TickTimes(std::int64_t expected_ticks);

  // Runs `work` and notes how long it took.
  template <typename Work>
  void time(const Work& work) {
    const auto start = Clock::now();
    work();
    if (seen_++ % stride_ == 0) add(std::chrono::duration<double>(Clock::now() - start).count());
  }
  void add(double seconds);

  std::int64_t count() const { return static_cast<std::int64_t>(seconds_.size()); }
  double quantile(double q) const;  // nearest rank, 0 <= q <= 1 [s]; NaN when nothing was timed

 private:
  using Clock = std::chrono::steady_clock;
  std::int64_t stride_;
  std::int64_t seen_ = 0;
  std::vector<double> seconds_;
};

}  // namespace pincer::tasks
