// measured: shared by the accuracy tests: where the scenes are, and how a measured figure is shown and judged.
#pragma once
#include <fmt/format.h>
#include <gtest/gtest.h>

#include <string>

#include "tasks/scene/simulation.h"

namespace pincer::tasks {

inline Simulation openScene(const std::string& name) { return Simulation(readScene(PINCER_SOURCE_DIR "/tasks/scenes/" + name + ".json")); }

// Every figure is printed beside its bound, so that a run of this suite is the accuracy report of this build.
inline void expectBelow(const std::string& what, double value, double bound, const std::string& unit) {
  fmt::print("  {:<44} {:>11.3g} < {:<8.3g} {}\n", what, value, bound, unit);
  EXPECT_LT(value, bound) << what << " [" << unit << "]";
}

// One whole scene, tick by tick; `look` is called after each. Every tick must be a clean one.
template <typename Look>
void runThrough(Simulation& simulation, const Look& look) {
  for (std::int64_t i = simulation.scene().ticks(); i > 0; --i) {
    ASSERT_EQ(simulation.tick().status, engine::kStepOk) << "at " << simulation.time() << " s";
    look();
  }
}

}  // namespace pincer::tasks
