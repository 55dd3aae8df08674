// Memory from tick to tick: what contacts know of those of the last.
#include <gtest/gtest.h>

#include "pincer/engine/step.h"
#include "pincer/tests/support/worlds.h"

namespace pincer::engine {
namespace {

// Where two contacts became one, which knew the impulse of one only, a heap of cans began such ticks 0.01 m/s off and
// solved all of itself anew. Here a fifth one, at the place of one of a box's four corners, has carried half of it.
TEST(Recall, OneOfTwoContactsAtAPlaceCarriesWhatBothDid) {
  WorldOptions options;
  options.sleep = false;
  WorldBuilder builder{options};
  builder.addBody({"floor", contact::HalfSpace{}, false, 0, {}});
  builder.addBody({"box", contact::Box{{0.02, 0.015, 0.01}}, true, 0.1, {}});
  const WorldModel model = builder.build();
  WorldState state = makeState(model, {BodyStart{}, tests::startAt({0, 0, 0.01})}, {});
  WorldScratch scratch(model);
  for (int tick = 0; tick < 100; ++tick) step(model, state, scratch);
  ASSERT_EQ(state.contact_count, 4);
  ASSERT_EQ(step(model, state, scratch).solve.iterations, 0);

  ContactMemory& half = state.contacts[2];
  half.r *= 0.5;
  ContactMemory& other = state.contacts[4] = half;
  other.id = state.contacts[3].id + 100;
  state.contact_count = 5;
  const StepReport report = step(model, state, scratch);
  EXPECT_EQ(report.contacts, 4);
  EXPECT_EQ(report.solve.iterations, 0);
  EXPECT_EQ(kineticEnergy(model, state), 0);
}

}  // namespace
}  // namespace pincer::engine
