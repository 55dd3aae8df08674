// Loops of bodies whose gaps and stick offsets ask for what no motion gives.
#include <gtest/gtest.h>

#include "pincer/engine/step.h"
#include "pincer/tests/support/worlds.h"

namespace pincer::engine {
namespace {

// Ten balls thrown into a narrow box wedge each other. Once they lie still each tick has an answer that obeys the law:
// without the fit each of them was flagged, for ever.
TEST(IslandBias, LetsBallsInABoxComeToRest) {
  WorldBuilder builder{WorldOptions{}};
  std::vector<BodyStart> starts;
  for (const Vec3& n : {Vec3(0, 0, 1), Vec3(1, 0, 0), Vec3(-1, 0, 0), Vec3(0, 1, 0), Vec3(0, -1, 0)}) {
    builder.addBody({"wall", contact::HalfSpace{}, false, 0, {}});
    starts.push_back({{Quat::FromTwoVectors(Vec3::UnitZ(), n), n.z() > 0 ? Vec3(0, 0, 0) : Vec3(-0.0225 * n)},
                      Vec3::Zero(),
                      Vec3::Zero()});
  }
  for (int i = 0; i < 10; ++i) {
    builder.addBody({"ball", contact::Sphere{0.01}, true, 0.05, {}});
    const double jitter = 1e-4 * (i * 7 % 5 - 2);
    starts.push_back(tests::startAt(
        {0.0215 * (i % 2 - 0.5) + jitter, 0.0215 * (i / 2 % 2 - 0.5) - 0.7 * jitter, 0.0112 + 0.0215 * (i / 4)}));
  }
  const WorldModel model = builder.build();
  WorldState state = makeState(model, starts, {});
  WorldScratch scratch(model);
  int flagged = 0;
  for (int i = 0; i < 1000; ++i) {
    const StepReport report = step(model, state, scratch);
    if (i >= 900) flagged += report.status != kStepOk;
  }
  EXPECT_LT(kineticEnergy(model, state), 1e-15);
  EXPECT_EQ(flagged, 0);
}

}  // namespace
}  // namespace pincer::engine
