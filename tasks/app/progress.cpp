#include "pincer/tasks/app/progress.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <cstdio>

#include "pincer/tasks/app/print.h"
#include "pincer/tasks/app/terminal.h"

namespace pincer::tasks {
namespace {

std::string durationText(double seconds) {
  if (seconds < 90) return fmt::format("{:.0f} s", std::ceil(seconds));
  if (seconds < 5400) return fmt::format("{:.0f} min", seconds / 60);
  return fmt::format("{:.1f} h", seconds / 3600);
}

}  // namespace

std::string progressLine(const std::string& what, std::int64_t done, std::int64_t total, double elapsed) {
  constexpr int kWidth = 30;  // [characters] of the bar; chosen
  const double share = std::clamp(static_cast<double>(done) / static_cast<double>(total), 0.0, 1.0);
  const int filled = static_cast<int>(share * kWidth);
  const std::string left = share > 0 ? fmt::format(", {} left", durationText(elapsed * (1 - share) / share)) : "";
  return fmt::format("{} [{:#<{}}{:-<{}}] {:3.0f} %{}", what, "", filled, "", kWidth - filled, 100 * share, left);
}

Progress::Progress(std::string what, std::int64_t total)
    : what_(std::move(what)), total_(std::max<std::int64_t>(total, 1)), shown_(isTerminal(Stream::kError)) {}

Progress::~Progress() {
  if (shown_ && drawn_ != start_) print(stderr, "\r\x1b[K");
}

void Progress::update(std::int64_t done) {
  if (!shown_) return;
  const Clock::time_point now = Clock::now();
  if (now - drawn_ < std::chrono::milliseconds(100)) return;
  drawn_ = now;
  print(stderr, "\r\x1b[K{}", progressLine(what_, done, total_, std::chrono::duration<double>(now - start_).count()));
  std::fflush(stderr);
}

}  // namespace pincer::tasks
