// trial_verdict: what the judge of a task says after a tick.
#pragma once
#include <cstdint>

namespace pincer::tasks {

enum class TrialVerdict : std::uint8_t { kRunning, kSuccess, kTimeout };

}  // namespace pincer::tasks
