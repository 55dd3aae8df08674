// stage_clock: time of each stage of a tick, for `pincer plan` and the recorder. Off unless somebody asks.
#pragma once
#include <array>
#include <chrono>
#include <cstddef>
#include <cstdint>

namespace pincer::engine {

enum class Stage : std::uint8_t { kPredict, kCollideBodies, kFingerContacts, kSolve, kAdvance, kFingerReport, kCount };
// Stages of a tick in their order, and their names in tables of times.
constexpr int kStageCount = static_cast<int>(Stage::kCount);
constexpr std::array<const char*, kStageCount> kStageNames = {"predict", "body contacts", "finger contacts",
                                                              "solve",   "advance",       "pad places"};

struct WorldScratch;

struct StageClock {
  using Clock = std::chrono::steady_clock;
  Clock::time_point last = Clock::now();
  std::array<double, kStageCount> seconds{};  // of the last tick

  void start() {
    seconds = {};
    last = Clock::now();
  }
  void mark(Stage stage) {
    const auto now = Clock::now();
    seconds[static_cast<std::size_t>(stage)] += std::chrono::duration<double>(now - last).count();
    last = now;
  }
};

// From now on the stages of steps with `scratch` are timed by `clock`, which must outlive them; null: no more.
void timeStages(StageClock* clock, WorldScratch& scratch);

}  // namespace pincer::engine
