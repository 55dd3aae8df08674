// Solids resting on each other stay at rest, and each contact carries the exact weight above it.
#include <gtest/gtest.h>

#include "pincer/contact/generated_meshes.h"
#include "pincer/contact/polytope.h"
#include "pincer/contact/smooth_mesh.h"
#include "pincer/engine/state.h"
#include "pincer/engine/step.h"
#include "pincer/engine/world/scratch.h"
#include "pincer/tests/support/constants.h"

namespace pincer::engine {
namespace {

using contact::Box;
using contact::Shape;
using tests::kGravity;

struct Block {
  Shape shape;
  double mass;    // [kg]
  double height;  // of the shape, its frame in the middle of it [m]
  Quat q = Quat::Identity();
};

// Piles the blocks on a static table whose top is z = 0, lets them settle, and asks for a second of rest.
void expectRest(const std::string& name, const std::vector<Block>& blocks, double largest_speed) {
  WorldBuilder builder{WorldOptions{}};
  builder.addBody({"table", Box{{0.2, 0.2, 0.02}}, false, 0, {0.5, 0.5, 0, 0}});
  std::vector<BodyStart> starts = {{{Quat::Identity(), {0, 0, -0.02}}, Vec3::Zero(), Vec3::Zero()}};
  double top = 0, total = 0;
  for (const Block& block : blocks) {
    builder.addBody({"block", block.shape, true, block.mass, {0.5, 0.5, 0, 0}});
    starts.push_back({{block.q, {0, 0, top + block.height / 2}}, Vec3::Zero(), Vec3::Zero()});
    top += block.height;
    total += block.mass;
  }
  const WorldModel model = builder.build();
  WorldState state = makeState(model, starts, {});
  WorldScratch scratch(model);
  for (int tick = 0; tick < 200; ++tick) step(model, state, scratch);
  std::vector<Pose> before;
  for (std::size_t i = 1; i <= blocks.size(); ++i) before.push_back(bodyPose(model, state, static_cast<int>(i)));
  double speed = 0;
  for (int tick = 0; tick < 500; ++tick) {
    const StepReport report = step(model, state, scratch);
    ASSERT_EQ(report.status, static_cast<std::uint32_t>(kStepOk)) << name << " tick " << tick;
    for (const BodyState& body : state.bodies) speed = std::max(speed, body.v_W.norm());
  }
  EXPECT_LE(speed, largest_speed) << name;
  for (std::size_t i = 1; i <= blocks.size(); ++i) {
    EXPECT_LE((bodyPose(model, state, static_cast<int>(i)).p - before[i - 1].p).norm(), largest_speed)
        << name << " " << i;
  }
  // The bodies below each contact plane carry all those above it.
  double above = total;
  for (int below = 0; below < static_cast<int>(blocks.size()); ++below) {
    double impulse = 0;
    for (const Contact& c : scratch.contacts) {
      if (c.a.index == below && c.b.index == below + 1) impulse -= c.impulse_W.z();
      if (c.b.index == below && c.a.index == below + 1) impulse += c.impulse_W.z();
    }
    // the solver's tolerance
    EXPECT_NEAR(impulse / model.options.h, above * kGravity, 1e-6 * total * kGravity) << name << " " << below;
    above -= blocks[static_cast<std::size_t>(below)].mass;
  }
}

constexpr double kStill = 1e-8;  // [m/s], and [m] in half a second

TEST(BodiesAtRest, FiveCubesHeaviestOnTop) {
  std::vector<Block> cubes;
  for (const double mass : {0.01, 0.1, 1.0, 10.0, 100.0}) cubes.push_back({Box{{0.02, 0.02, 0.02}}, mass, 0.04});
  expectRest("cubes", cubes, kStill);
}

TEST(BodiesAtRest, TurnedBoxOnABox) {
  expectRest("turned",
             {{Box{{0.02, 0.02, 0.02}}, 0.2, 0.04},
              {Box{{0.015, 0.02, 0.01}}, 0.1, 0.02, Quat(Eigen::AngleAxisd(0.5, Vec3::UnitZ()))}},
             kStill);
}

TEST(BodiesAtRest, CapsuleAcrossABox) {
  expectRest("capsule",
             {{Box{{0.03, 0.03, 0.02}}, 0.2, 0.04},
              {contact::Capsule{0.01, 0.02}, 0.05, 0.02, Quat(Eigen::AngleAxisd(M_PI / 2, Vec3::UnitY()))}},
             kStill);
}

TEST(BodiesAtRest, CylindersStandingAndLying) {
  const contact::Cylinder can{0.02, 0.02}, lid{0.03, 0.005};
  const Quat lying(Eigen::AngleAxisd(M_PI / 2, Vec3::UnitY()));
  expectRest("standing", {{can, 0.2, 0.04}, {lid, 0.1, 0.01}, {Box{{0.02, 0.03, 0.01}}, 0.1, 0.02}, {can, 0.1, 0.04}},
             kStill);
  expectRest("lying", {{Box{{0.03, 0.03, 0.02}}, 0.2, 0.04}, {contact::Cylinder{0.01, 0.02}, 0.05, 0.02, lying}},
             kStill);
  const contact::CylinderWithFlat cut{0.02, 0.015, 0.012};
  expectRest("on its flat", {{cut, 0.2, 0.032, Quat(Eigen::AngleAxisd(M_PI / 2, Vec3::UnitY()))}}, kStill);
}

TEST(BodiesAtRest, HullsOnEachOther) {
  std::vector<Vec3> stone;
  for (const double y : {-0.02, 0.02}) {
    for (const Vec2& xz : {Vec2(-0.03, -0.02), Vec2(0.03, -0.02), Vec2(0.02, 0.02), Vec2(-0.02, 0.02)})
      stone.emplace_back(xz.x(), y, xz.y());
  }
  const contact::Convex hull{contact::Polytope::hullOf(stone, "stone")};
  expectRest("hulls", {{hull, 0.3, 0.04}, {hull, 0.2, 0.04}, {hull, 0.1, 0.04}}, kStill);
}

TEST(BodiesAtRest, MeshOnABoxAndABoxOnTheMesh) {
  const contact::Mesh mesh{contact::SmoothMesh::build(contact::box({0.025, 0.025, 0.02}))};
  expectRest("mesh", {{Box{{0.03, 0.03, 0.02}}, 0.2, 0.04}, {mesh, 0.2, 0.04}, {Box{{0.01, 0.015, 0.01}}, 0.1, 0.02}},
             kStill);
}

TEST(BodiesAtRest, MeshesOnEachOther) {
  const contact::Mesh block{contact::SmoothMesh::build(contact::box({0.025, 0.025, 0.02}))},
      small{contact::SmoothMesh::build(contact::box({0.01, 0.015, 0.01}))};
  expectRest("equal meshes", {{block, 0.2, 0.04}, {block, 0.2, 0.04}, {small, 0.1, 0.02}}, kStill);
  expectRest("a turned mesh", {{block, 0.2, 0.04}, {block, 0.2, 0.04, Quat(Eigen::AngleAxisd(0.5, Vec3::UnitZ()))}},
             kStill);
  std::vector<Vec3> corners;
  for (int i = 0; i < 8; ++i) corners.emplace_back(i & 1 ? 0.02 : -0.02, i & 2 ? 0.02 : -0.02, i & 4 ? 0.02 : -0.02);
  const contact::Convex hull{contact::Polytope::hullOf(corners, "cube")};
  expectRest("hull, mesh, cylinder, mesh",
             {{hull, 0.2, 0.04}, {small, 0.1, 0.02}, {contact::Cylinder{0.02, 0.01}, 0.1, 0.02}, {small, 0.1, 0.02}},
             kStill);
}

// A ring of triangles around a post, lying on a plate that is a mesh: it is carried all round,
// and the post in its hole leaves it alone.
TEST(BodiesAtRest, RingAroundAPost) {
  WorldBuilder builder{WorldOptions{}};
  const contact::Mesh ring{contact::SmoothMesh::build(contact::torus(0.03, 0.008, 24, 12))},
      post{contact::SmoothMesh::build(contact::cylinder(0.01, 0.05, 24, 2))},
      plate{contact::SmoothMesh::build(contact::box({0.1, 0.1, 0.01}))};
  builder.addBody({"plate", plate, false, 0, {0.5, 0.5, 0, 0}});
  builder.addBody({"post", post, false, 0, {0.5, 0.5, 0, 0}});
  builder.addBody({"ring", ring, true, 0.1, {0.5, 0.5, 0, 0}});
  const WorldModel model = builder.build();
  WorldState state = makeState(model,
                               {{{Quat::Identity(), {0, 0, -0.01}}, Vec3::Zero(), Vec3::Zero()},
                                {{Quat::Identity(), {0, 0, 0.05}}, Vec3::Zero(), Vec3::Zero()},
                                {{Quat::Identity(), {0.001, 0, 0.0085}}, Vec3::Zero(), Vec3::Zero()}},
                               {});
  WorldScratch scratch(model);
  for (int tick = 0; tick < 1000; ++tick) step(model, state, scratch);
  EXPECT_LE(state.bodies[2].v_W.norm(), 1e-6);
  EXPECT_NEAR(bodyPose(model, state, 2).p.z(), 0.008, 3e-4);  // the tube's facets lie up to 0.27 mm within the circle
  double weight = 0;
  for (const Contact& c : scratch.contacts) weight += c.b.index == 2 ? -c.impulse_W.z() : c.impulse_W.z();
  EXPECT_NEAR(weight / model.options.h, 0.1 * kGravity, 1e-6 * kGravity);
}

// A pyramid of logs of 0.25 kg between two stakes.
struct Logs {
  int rows;
  contact::Shape log;
  double mu, heading, play;  // [-, rad, m]

  int ticksUntilAsleep(int most) const {
    constexpr double kRadius = 0.02;
    WorldOptions options;
    options.max_contacts = 0;
    WorldBuilder builder{options};
    const Quat along = quatFromRotationVector(heading * Vec3::UnitZ()),
               lying = along * quatFromRotationVector(0.5 * M_PI * Vec3::UnitY());
    builder.addBody({"floor", contact::HalfSpace{}, false, 0, {mu, mu, 0, 0}});
    std::vector<BodyStart> starts{{Pose{}, Vec3::Zero(), Vec3::Zero()}};
    for (const int side : {-1, 1}) {
      builder.addBody({side < 0 ? "left" : "right", Box{{0.01, 0.01, 0.1}}, false, 0, {mu, mu, 0, 0}});
      starts.push_back(
          {{along, along * Vec3(0, side * (rows * kRadius + play + 0.01), 0.1)}, Vec3::Zero(), Vec3::Zero()});
    }
    for (int row = 0; row < rows; ++row) {
      for (int i = 0; i < rows - row; ++i) {
        builder.addBody({"log" + std::to_string(starts.size()), log, true, 0.25, {mu, mu, 0, 0}});
        const Vec3 p(0, (2 * i - (rows - row - 1)) * kRadius, (1 + row * std::sqrt(3.0)) * kRadius);
        starts.push_back({{lying, along * p}, Vec3::Zero(), Vec3::Zero()});
      }
    }
    const WorldModel model = builder.build();
    WorldState state = makeState(model, starts, {});
    WorldScratch scratch(model);
    int ticks = 0;
    while (ticks < most && !step(model, state, scratch).asleep) ++ticks;
    return ticks;
  }
};

// They stirred by 1e-15 m/s for ever: what turned about a cross axis was judged by its least moment of inertia.
TEST(BodiesAtRest, LogsBetweenStakesFallAsleep) {
  const contact::Shape round = contact::Capsule{0.02, 0.1};
  for (const Logs& logs :
       {Logs{2, round, 0.3, 0, 0}, Logs{2, round, 0.5, 0, 0}, Logs{3, round, 0.8, 0.4, 0}, Logs{3, round, 0.8, 0, 0}})
    EXPECT_LT(logs.ticksUntilAsleep(5000), 5000) << logs.rows << ' ' << logs.mu << ' ' << logs.heading;
}

}  // namespace
}  // namespace pincer::engine
