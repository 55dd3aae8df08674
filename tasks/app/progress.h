// progress: how far a long run has come and how long it will still take, on
// standard error, only where that is a terminal.
#pragma once
#include <chrono>
#include <cstdint>
#include <string>

namespace pincer::tasks {

class Progress {
 public:
  // `total` > 0 steps, whatever a step is.
  Progress(std::string what, std::int64_t total);
  ~Progress();  // wipes the line
  Progress(const Progress&) = delete;
  Progress& operator=(const Progress&) = delete;

  // Draws at most ten times a second; costs one reading of the clock.
  void update(std::int64_t done);

 private:
  using Clock = std::chrono::steady_clock;
  std::string what_;
  std::int64_t total_;
  bool shown_;
  Clock::time_point start_ = Clock::now();
  Clock::time_point drawn_ = start_;
};

// "sim   [########------------]  40 %, 12 s left". `elapsed` [s] since the start.
std::string progressLine(const std::string& what, std::int64_t done, std::int64_t total, double elapsed);

}  // namespace pincer::tasks
