// A ball that friction jams between two walls, pressed some micrometres into both. To get out it would have to slide
// up, and no impulse makes it: the harder the walls push, the more friction holds.
#include <gtest/gtest.h>

#include <cmath>

#include "pincer/contact/math.h"
#include "pincer/engine/step.h"
#include "pincer/engine/world/scratch.h"
#include "pincer/tests/support/worlds.h"

namespace pincer::engine {
namespace {

constexpr double kJammedRadius = 0.01, kJammedMass = 0.06, kJammedFriction = 0.5;  // [m, kg, -]

struct Groove {
  double half_angle, heading, overlap;  // [rad, rad, m]
  int flagged = 0, moved_ticks = 0;
  double way = 0;  // of the ball [m]
  bool asleep = false;

  void run() {
    WorldBuilder builder{WorldOptions{}};
    const Material material{kJammedFriction, kJammedFriction, 0, 0};
    builder.addBody({"ball", contact::Sphere{kJammedRadius}, true, kJammedMass, material});
    std::vector<BodyStart> starts{tests::startAt(Vec3::Zero())};
    const Quat turn = quatFromRotationVector(heading * Vec3::UnitZ());
    for (const double side : {-1.0, 1.0}) {
      // its outer normal, towards the ball: a little upwards
      const Vec3 n_W = turn * Vec3(-side * std::cos(half_angle), 0, std::sin(half_angle));
      builder.addBody({side < 0 ? "left" : "right", contact::Box{Vec3(0.05, 0.05, 0.01)}, false, 0, material});
      BodyStart start = tests::startAt(-(kJammedRadius - overlap + 0.01) * n_W);
      start.X_WB.q = Quat::FromTwoVectors(Vec3::UnitZ(), n_W);
      starts.push_back(start);
    }
    const WorldModel model = builder.build();
    WorldState state = makeState(model, starts, {});
    WorldScratch scratch(model);
    for (int i = 0; i < 1000; ++i) {
      const StepReport report = step(model, state, scratch, StepInputs{});
      flagged += report.status != kStepOk;
      asleep = report.asleep;
    }
    way = state.bodies[0].X_WI.p.norm();
  }
};

TEST(JammedBody, RestsWhereFrictionHoldsItsOverlapShut) {
  for (const double half_angle : {0.03, 0.1, 0.3}) {  // all below atan(0.5) = 0.46
    for (const double heading : {0.0, 0.7}) {
      for (const double overlap : {0.5e-6, 2e-6, 4e-6}) {
        Groove groove{half_angle, heading, overlap};
        groove.run();
        EXPECT_EQ(groove.flagged, 0) << half_angle << ' ' << heading << ' ' << overlap;
        EXPECT_TRUE(groove.asleep) << half_angle << ' ' << heading << ' ' << overlap;
        EXPECT_LE(groove.way, overlap / std::sin(half_angle)) << half_angle << ' ' << heading << ' ' << overlap;
      }
    }
  }
}

}  // namespace
}  // namespace pincer::engine
