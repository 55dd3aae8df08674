// A box between two jaws that sit 0.45 m out on a hand, while the hand is swung by 2 rad.
#include <fmt/format.h>
#include <gtest/gtest.h>

#include <atomic>
#include <cmath>

#include "pincer/tasks/run/scene.h"
#include "pincer/tasks/run/scene/sim_run.h"

namespace pincer::tasks {
namespace {

constexpr double kReach = 0.45;  // of the box from the hand's axis [m]

enum class Hand : std::uint8_t { kDriveEach, kCoupled };

Scene swing(Hand hand, double mass, double rate, double tick) {
  const std::string drive =
      R"({{"name":"{}","joint":"{}","type":"position","stiffness":4000,"damping":80,"target":-0.005}})";
  const std::string grip = fmt::format(fmt::runtime(drive), "grip", "left");
  const bool is_coupled = hand == Hand::kCoupled;
  const std::string other = is_coupled ? "" : ", " + fmt::format(fmt::runtime(drive), "grip2", "right");
  const std::string coupling = is_coupled ? R"("couplings":[{"joint":"right","follows":"left"}],)" : "";
  return parseScene(fmt::format(R"({{"version":1, "duration":{:.3f}, "tick":{},
        "bodies":[
          {{"name":"hand", "shapes":[{{"shape":{{"type":"box","size":[0.1,0.1,0.02]}},"position":[0.45,0,0.1]}}],
            "mass":1, "position":[0,0,0.3]}},
          {{"name":"a", "shape":{{"type":"box","size":[0.02,0.008,0.024]}}, "mass":0.05, "position":[0.45,0.024,0.3],
            "material":{{"mu_s":0.7}}}},
          {{"name":"b", "shape":{{"type":"box","size":[0.02,0.008,0.024]}}, "mass":0.05, "position":[0.45,-0.024,0.3],
            "material":{{"mu_s":0.7}}}},
          {{"name":"box", "shape":{{"type":"box","size":[0.04,0.04,0.04]}}, "mass":{}, "position":[0.45,0,0.3],
            "material":{{"mu_s":0.7}}}}],
        "joints":[{{"name":"yaw","type":"pivot","body":"hand","point":[0,0,0.3],"axis":[0,0,1]}},
          {{"name":"left","type":"slider","body":"a","to":"hand","axis":[0,1,0]}},
          {{"name":"right","type":"slider","body":"b","to":"hand","axis":[0,-1,0]}}], {}
        "drives":[{{"name":"turn","joint":"yaw","type":"position","stiffness":2e5,"damping":4000,"trajectory":
          {{"keyframes":[{{"time":0,"value":0}},{{"time":0.2,"value":0}},{{"time":{:.4f},"value":2}}]}}}}, {}{}],
        "pairs":[{{"bodies":["a","b"],"touch":false}}]}})",
                                0.4 + 3.6 / rate, tick, mass, coupling, 0.2 + 3.6 / rate, grip, other),
                    "swung.json");
}

void expectHeld(Hand hand, double mass, double rate, double tick, double slip) {
  Simulation sim(swing(hand, mass, rate, tick));
  const std::atomic<bool> never = false;
  const SimResult result = runScene(sim, {}, never, [](std::int64_t) {});
  const Vec3 p_W = engine::bodyPose(sim.model().world, sim.state().world, 3).p;
  const std::string what = fmt::format("{} kg at {} rad/s, ticks of {} s", mass, rate, tick);
  EXPECT_NEAR(std::hypot(p_W.x(), p_W.y()), kReach, slip) << what;
  EXPECT_NEAR(p_W.z(), 0.3, slip) << what;
  for (std::size_t kind = 0; kind < kStatusKinds.size(); ++kind)
    EXPECT_EQ(result.statuses.of(kind), 0) << what << ": " << kStatusKinds[kind].key;
}

struct Swing {
  double rate, tick;  // [rad/s], [s]
};
constexpr Swing kSwings[] = {{1, 2e-3}, {1, 4e-3}, {2, 5e-4}, {2, 1e-3}, {2, 2e-3}, {2, 4e-3},
                             {4, 5e-4}, {4, 1e-3}, {4, 2e-3}, {8, 5e-4}, {8, 1e-3}, {8, 2e-3}};
constexpr double kSlip = 1e-8;   // [m]; 1.1e-9 measured, the chord of an arc is shorter by 5e-9 per tick at most
constexpr double kLight = 0.05;  // [kg]; needs 1.5 N at most, where friction bears 14 N

TEST(SwungJaws, WithADriveEachHoldWhatTheyGripAtEveryRateAndTick) {
  for (const auto& [rate, tick] : kSwings) expectHeld(Hand::kDriveEach, kLight, rate, tick, kSlip);
}

// Joints keep both faces parallel: more than the box has freedoms.
TEST(SwungJaws, ThatACouplingTiesHoldWhatTheyGripAtEveryRateAndTick) {
  for (const auto& [rate, tick] : kSwings) expectHeld(Hand::kCoupled, kLight, rate, tick, kSlip);
}

// Four fifths of what friction bears: contacts share it anew as the load turns from face to face.
TEST(SwungJaws, ThatACouplingTiesHoldNearlyAllThatFrictionBears) {
  constexpr double kHeavy = 0.9;  // [kg]; 11.3 N at 4 rad/s
  for (const double tick : {1e-3, 2e-3}) expectHeld(Hand::kCoupled, kHeavy, 4, tick, kSlip);
}

}  // namespace
}  // namespace pincer::tasks
