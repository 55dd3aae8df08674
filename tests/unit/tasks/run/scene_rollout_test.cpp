// A scene as model and state apart: the bits of Simulation, states as values, rollouts whose threads show in nothing.
#include <gtest/gtest.h>

#include <cmath>

#include "pincer/tasks/run/rollout/rollout.h"
#include "pincer/tasks/run/rollout/state_bytes.h"
#include "pincer/tasks/run/rollout/state_rows.h"
#include "pincer/tasks/run/scene/builtin_scenes.h"
#include "pincer/tasks/run/simulation.h"
#include "pincer/tests/support/error_of.h"
#include "pincer/tests/support/run_app.h"

namespace pincer::tasks {
namespace {

using tests::contains;
using tests::errorOf;

bool never() { return false; }

TEST(SceneStepper, HasTheBitsOfTheSimulation) {
  for (const char* name : {"s4_pinch", "pickup", "turn_ball", "conveyed_ball", "mug"}) {
    Simulation simulation(readBuiltinScene(name));
    const SceneModel model(readBuiltinScene(name));
    SceneState state(model), told(model);
    SceneStepper stepper(model);
    for (int t = 0; t < 300; ++t) simulation.tick();
    EXPECT_EQ(stepper.step(state, 300).ticks, 300);
    stepper.step(told, SceneInputs(model), 300);
    EXPECT_EQ(hashText(state), hashText(simulation.state().world)) << name;
    EXPECT_EQ(hashText(told), hashText(state)) << name;
  }
}

TEST(SceneState, ComesBackFromItsBytes) {
  const SceneModel model(readBuiltinScene("two_jaw_gripper"));
  SceneState state(model), back(model);
  SceneStepper stepper(model);
  stepper.step(state, 700);
  setFromBytes(back, bytesOf(state));
  EXPECT_EQ(hashText(back), hashText(state));
  stepper.step(state, 300);
  stepper.step(back, 300);
  EXPECT_EQ(hashText(back), hashText(state));
  const std::string bytes = bytesOf(state);
  const std::string before = hashText(back);
  EXPECT_TRUE(contains(errorOf([&] { setFromBytes(back, bytes.substr(0, bytes.size() / 2)); }), "cut off"));
  EXPECT_TRUE(contains(errorOf([&] { setFromBytes(back, "pincer state 0 x\n"); }), "another build"));
  const SceneModel other(readBuiltinScene("mug"));
  SceneState state_of_other(other);
  EXPECT_TRUE(contains(errorOf([&] { setFromBytes(state_of_other, bytes); }), "another model"));
  EXPECT_EQ(hashText(back), before);
}

TEST(SceneState, PlacesABodyAnew) {
  const SceneModel model(readBuiltinScene("mug"));
  SceneState state(model);
  SceneStepper stepper(model);
  stepper.step(state, 200);
  const int body = model.bodyNamed("mug");
  engine::BodyStart start;
  start.X_WB = {Quat(0, 3, 0, 4), Vec3(0.1, 0.2, 0.3)};  // of length 5
  start.v_W = Vec3(1, 2, 3);
  start.w_W = Vec3(4, 5, 6);
  placeBody(model, state, body, start);
  std::vector<double> places(7 * model.scene.bodies.size()), rates(6 * model.scene.bodies.size());
  writePlaces(model, state, places);
  writeRates(model, state, rates);
  const std::vector<double> place{0.1, 0.2, 0.3, 0, 0.6, 0, 0.8}, rate{1, 2, 3, 4, 5, 6};
  // A frame that isn't the inertial one goes there and back: a few roundings.
  for (std::size_t i = 0; i < 7; ++i) EXPECT_NEAR(places[7 * static_cast<std::size_t>(body) + i], place[i], 1e-15) << i;
  for (std::size_t i = 0; i < 6; ++i) EXPECT_NEAR(rates[6 * static_cast<std::size_t>(body) + i], rate[i], 1e-13) << i;
  start.X_WB.q.coeffs().setZero();
  EXPECT_TRUE(contains(errorOf([&] { placeBody(model, state, body, start); }), "is no rotation"));
}

TEST(SceneStepper, TakesADeviceEvenlyToItsPlace) {
  const SceneModel model(readBuiltinScene("roll_between_fingers"));
  SceneState state(model);
  SceneStepper stepper(model);
  const Vec3 start = state.grasp.world.points[0].p_target_W, place = start + Vec3(0, 0.001, 0);
  state.held[0] = place;
  stepper.step(state, 8);
  EXPECT_EQ(state.grasp.world.points[0].p_target_W, place);
  EXPECT_NEAR(state.grasp.world.points[0].v_target_W.y(), 0.001 / 0.008, 1e-12);
  stepper.step(state, 1);
  EXPECT_EQ(state.grasp.world.points[0].v_target_W, Vec3::Zero());
}

RolloutJob jobOf(const std::shared_ptr<const SceneModel>& model, std::vector<SceneState>& states,
                 std::vector<double>& rows, std::int64_t chunk) {
  RolloutJob job;
  job.models = {model};
  for (SceneState& state : states) job.states.push_back(&state);
  job.ticks = 40;
  rows.assign(states.size() * 40 * stateSize(*model), 0);
  job.state = rows;
  job.chunk = chunk;
  return job;
}

TEST(Rollout, IsTheSameForAnyThreadsAndChunks) {
  const auto model = std::make_shared<const SceneModel>(readBuiltinScene("pickup"));
  const auto rows = [&](int threads, std::int64_t chunk) {
    std::vector<SceneState> states(9, SceneState(*model));
    for (std::size_t i = 0; i < states.size(); ++i)
      states[i].held[0] = Vec3(-0.03, 0, 0.03 + 1e-3 * static_cast<double>(i));
    std::vector<double> out;
    RolloutPool pool(threads);
    EXPECT_TRUE(pool.run(jobOf(model, states, out, chunk), never));
    return out;
  };
  const std::vector<double> wanted = rows(1, 1);
  for (const int threads : {1, 2, 7}) {
    for (const std::int64_t chunk : {0, 2, 100}) EXPECT_EQ(rows(threads, chunk), wanted) << threads << " " << chunk;
  }
}

TEST(Rollout, EndsSoonAfterItIsStopped) {
  const auto model = std::make_shared<const SceneModel>(readBuiltinScene("pickup"));
  std::vector<SceneState> states(2, SceneState(*model));
  RolloutJob job;
  job.models = {model};
  for (SceneState& state : states) job.states.push_back(&state);
  job.ticks = 1'000'000'000;
  RolloutPool pool(2);
  EXPECT_FALSE(pool.run(job, [] { return true; }));
  EXPECT_LT(states[0].grasp.world.tick, 100'000'000);
}

}  // namespace
}  // namespace pincer::tasks
