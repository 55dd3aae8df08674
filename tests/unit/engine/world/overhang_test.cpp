// Bodies over the rim of a table that is a mesh, however its top is cut: they stand while their
// centre of mass is over it, and tip otherwise.
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

struct Overhanging {
  const char* name;
  contact::Shape shape;
  double length, half_height;  // along x, of a shape whose frame is in its middle [m]
};

std::vector<Overhanging> overhangingBodies() {
  const Vec3 half(0.031, 0.017, 0.012);
  std::vector<Vec3> points;  // a prism of six sides
  for (int i = 0; i < 12; ++i)
    points.emplace_back(0.03 * std::cos(i * tests::kPi / 3), 0.03 * std::sin(i * tests::kPi / 3),
                        i < 6 ? -0.012 : 0.012);
  return {{"box", contact::Box{half}, 0.062, 0.012},
          {"cylinder", contact::Cylinder{0.03, 0.012}, 0.06, 0.012},
          {"hull", contact::Convex{contact::Polytope::hullOf(points, "prism")}, 0.06, 0.012},
          {"mesh", contact::Mesh{contact::SmoothMesh::build(contact::gridBox(half, 3))}, 0.062, 0.012}};
}

struct Outcome {
  double moved = 0;   // [m], from a tenth of a second on
  double turned = 0;  // [rad]
  double fallen = 0;  // [m], from the start
};

// A share `over` of the body's length is beyond the rim.
Outcome letGo(const Overhanging& body, double over, int cells, int ticks) {
  const Vec3 half(0.1, 0.1, 0.01);
  WorldBuilder builder{WorldOptions{}};
  builder.addBody(
      {"table", contact::Mesh{contact::SmoothMesh::build(contact::gridBox(half, cells))}, false, 0, {0.5, 0.5, 0, 0}});
  builder.addBody({"body", body.shape, true, 0.1, {0.5, 0.5, 0, 0}});
  const WorldModel model = builder.build();
  const Vec3 place(half.x() + (over - 0.5) * body.length, 0.013, half.z() + body.half_height);
  WorldState state = makeState(model, {{}, {{Quat::Identity(), place}, Vec3::Zero(), Vec3::Zero()}}, {});
  WorldScratch scratch(model);
  Pose settled;
  for (int tick = 0; tick < ticks; ++tick) {
    step(model, state, scratch);
    if (tick == 100) settled = bodyPose(model, state, 1);
  }
  const Pose end = bodyPose(model, state, 1);
  return {(end.p - settled.p).norm(), end.q.angularDistance(settled.q), place.z() - end.p.z()};
}

// Missed points on the rim show in a fraction of a second: the body would tip, or turn about those that are left.
TEST(Overhang, StandsWhileItsCentreOfMassIsOverTheTable) {
  for (const Overhanging& body : overhangingBodies()) {
    for (const int cells : {1, 10}) {
      for (const double over : {0.4, 0.48}) {
        const Outcome o = letGo(body, over, cells, 3000);
        EXPECT_LE(o.moved, 1e-7) << body.name << " " << cells << " " << over;
        EXPECT_LE(o.turned, 1e-6) << body.name << " " << cells << " " << over;
      }
    }
  }
}

TEST(Overhang, TipsWhenItIsBeyond) {
  for (const Overhanging& body : overhangingBodies()) {
    for (const int cells : {1, 10}) EXPECT_GE(letGo(body, 0.52, cells, 1000).fallen, 0.01) << body.name << " " << cells;
  }
}

}  // namespace
}  // namespace pincer::engine
