// The servo's step may be solved on several threads. The name puts it among the tests that
// run under the thread sanitizer (tests/run).
#include <gtest/gtest.h>

#include "pincer/engine/world/scratch.h"
#include "pincer/tasks/run/simulation.h"

namespace pincer::tasks {
namespace {

// Six islands that come and go: two balls meet, the others land, slide and roll on a floor of their own friction.
Scene sixIslands(int threads) {
  Scene scene = parseScene(R"({"version": 1, "duration": 0.2, "bodies": [{"shape": {"type": "half_space"}}],
    "fingers": [{"position": [0.3, 0, 0.05]}]})",
                           "islands.json");
  for (int i = 0; i < 7; ++i) {
    engine::BodySpec ball{"ball" + std::to_string(i), contact::Sphere{0.02}, true, 0.1, {}};
    ball.material.mu_s = ball.material.mu_d = 0.1 * (1 + i);
    scene.bodies.push_back(ball);
    scene.starts.push_back(
        {{Quat::Identity(), {0.1 * i, 0, 0.02 + 0.001 * i}}, {i == 0 ? 1.5 : 0, 0.1 * i, 0}, {10, 0, 0}});
  }
  scene.options.threads = threads;
  return scene;
}

TEST(ServoThreads, SolveIslandsToTheSameBitsAsOne) {
  Simulation one(sixIslands(1)), two(sixIslands(2));
  std::size_t most_islands = 0;
  while (one.ticks() < one.scene().ticks()) {
    one.tick();
    two.tick();
    most_islands = std::max(most_islands, grasp::worldOf(two.scratch()).islands.islands.size());
    ASSERT_EQ(engine::hashOf(one.state().world), engine::hashOf(two.state().world)) << "tick " << one.ticks();
  }
  EXPECT_GE(most_islands, 6U);  // or the threads had nothing to share
}

}  // namespace
}  // namespace pincer::tasks
