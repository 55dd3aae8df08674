// A finger that touches one body at several places: grooves and corners of a mesh.
#include <gtest/gtest.h>

#include <cmath>
#include <memory>

#include "contact/mesh/generated_meshes.h"
#include "contact/surface/smooth_mesh.h"
#include "grasp/step.h"
#include "tests/support/notched_blocks.h"
#include "tests/support/worlds.h"

namespace pincer::grasp {
namespace {

constexpr double kStiffness = 1000;  // [N/m]
constexpr double kDamping = 0.05;    // [N s/m] a tip without mass nor damping swings about its place for ever; this ends it within 20 ticks
constexpr double kWay = 1e-6;        // of the device per tick [m]: 1 mm/s

// A fixed mesh without friction and one finger with a massless tip on a spring, at rest at `start`.
struct Pressed {
  Pressed(const contact::TriangleMesh& mesh, const Vec3& start) : device(start) {
    engine::WorldBuilder builder{engine::WorldOptions{}};
    builder.addBody({"block", contact::Mesh{contact::SmoothMesh::build(mesh)}, false, 0, {0, 0, 0, 0}});
    model = buildGrasp(builder, {tests::softFinger("finger", kStiffness, kDamping)});
    state = makeState(model, {tests::startAt(Vec3::Zero())}, {start});
    scratch = std::make_unique<GraspScratch>(model);
  }
  const FingerReport& moveTo(const Vec3& p_WF) {
    FingerInput input;
    input.v_WF = (p_WF - device) / model.world.options.h;
    input.p_WF = device = p_WF;
    step(model, state, *scratch, std::span(&input, 1));
    return scratch->fingers[0];
  }
  void leadTo(const Vec3& p_WF) {
    const Vec3 from = device;
    for (int i = 1; i <= 1000; ++i) moveTo(from + (p_WF - from) * i / 1000);
    for (int i = 0; i < 200; ++i) moveTo(p_WF);
  }
  int activeContacts() const {
    int n = 0;
    for (const engine::Contact& c : scratch->world.contacts) n += c.active();
    return n;
  }

  GraspModel model;
  GraspState state;
  std::unique_ptr<GraspScratch> scratch;
  Vec3 device;
};

// What changes in a tick, per way of the device in it.
struct FeltChange {
  double place = 0, force = 0;  // of the place on the pad [-] and of the force [N/m]
  int fewest = 99, most = 0;    // contacts that push

  void see(const FingerModel& finger, const FingerReport& now, int contacts, double way) {
    const Vec2 place_now = placeOnPad(finger, now.touch);
    if (seen_) {
      place = std::max(place, (place_now - place_).norm() / way);
      force = std::max(force, (now.f_contact_W - force_).norm() / way);
    }
    place_ = place_now;
    force_ = now.f_contact_W;
    seen_ = true;
    fewest = std::min(fewest, contacts);
    most = std::max(most, contacts);
  }

 private:
  bool seen_ = false;
  Vec2 place_ = Vec2::Zero();
  Vec3 force_ = Vec3::Zero();
};

// A landing in the middle of a tick leaves half a tick's growth of the force to the next.
constexpr double kLanding = 1.5;

// Without friction the force is the spring's: it changes by k dx, and the place by r k dx / |f|: with the device about 4 mm below where the
// finger rests, 8 mm / 4 mm = 2 um per um. On one wall alone it stands still, and where the second comes or goes it carries nothing.
// A single contact would jump by a quarter of the finger's circumference, 12.6 mm.
TEST(GraspGrooves, AcrossAGrooveForceAndPlaceAreContinuous) {
  const double r = 0.008, rest = r * std::sqrt(2.0), depth = 0.004;
  Pressed finger(contact::grooveBlock(M_PI / 4, 0.02, 0.04, 0.04), Vec3(-0.006, 0.001, rest + 0.006));
  finger.leadTo(Vec3(-0.006, 0.001, rest - depth));
  FeltChange felt;
  for (int i = 0; i < 12000; ++i)
    felt.see(finger.model.fingers[0], finger.moveTo(Vec3(-0.006 + kWay * i, 0.001, rest - depth)), finger.activeContacts(), kWay);
  EXPECT_EQ(felt.fewest, 1);
  EXPECT_EQ(felt.most, 2);
  EXPECT_LT(felt.place, 2.2);
  EXPECT_LT(felt.force, kLanding * kStiffness);
}

// From one wall of a right angle into the corner of three, and around in it, at least 2 mm beyond the walls.
TEST(GraspGrooves, IntoACornerForceAndPlaceAreContinuous) {
  const double r = 0.008;
  Pressed finger(tests::cornerBlock(0.03), Vec3(0.02, 0.02, 0.02));
  finger.leadTo(Vec3(0.005, 0.02, 0.02));
  FeltChange felt;
  Vec3 last(0.005, 0.02, 0.02);
  for (int i = 1; i < 20000; ++i) {
    const double s = std::min(1.0, 1e-4 * i);
    const Vec3 at = Vec3(0.005, 0.02 - 0.015 * s, 0.02 - 0.0155 * s) + 1e-3 * s * Vec3(std::sin(1e-3 * i), std::cos(8e-4 * i) - 1, 0);
    felt.see(finger.model.fingers[0], finger.moveTo(at), finger.activeContacts(), std::max(kWay, (at - last).norm()));
    last = at;
  }
  EXPECT_EQ(felt.most, 3);
  EXPECT_LT(felt.place, kLanding * r / 0.002);
  EXPECT_LT(felt.force, kLanding * kStiffness);
}

// Down into a torus, the finger half a millimetre narrower than the hole: the tip's centre is on a circle of 0.5 mm there.
TEST(GraspGrooves, ThroughATightHoleTheForceIsContinuous) {
  const Vec3 above(0.0004, 0.0003, 0.02);
  Pressed finger(contact::torus(0.0205, 0.012, 48, 24), above);
  finger.leadTo(above);
  FeltChange felt;
  Vec3 last = above;
  for (int i = 1; i < 22000; ++i) {
    const Vec3 at = above + Vec3(2e-4 * std::sin(1e-3 * i), 0, -kWay * i);
    felt.see(finger.model.fingers[0], finger.moveTo(at), finger.activeContacts(), (at - last).norm());
    last = at;
  }
  EXPECT_GE(felt.most, 1);
  EXPECT_LT(felt.force, kLanding * kStiffness);
}

// A tip without mass nor damping that lands fast on a nearly flat mesh: ticks that move it by its end velocity alternated with a spring taken
// at the mean of both, and it flew off with 40 N.
TEST(GraspGrooves, AFingerWithoutDampingStaysWhereItLands) {
  for (const double mu : {0.0, 0.5}) {
    engine::WorldOptions options;
    options.gravity_W = Vec3::Zero();
    engine::WorldBuilder builder(options);
    builder.addBody({"cube", contact::Mesh{contact::SmoothMesh::build(contact::roundedCube(0.02, 0.004, 3))}, false, 0, {mu, mu, 0, 0}});
    const GraspModel model = buildGrasp(builder, {tests::softFinger("finger", kStiffness, 0)});
    Vec3 device(0.0002, 0.0001, 0.032);
    GraspState state = makeState(model, {tests::startAt(Vec3::Zero())}, {device});
    GraspScratch scratch(model);
    for (int i = 1; i < 300; ++i) {
      FingerInput input;
      input.p_WF = Vec3(device.x() + 1e-6 * (i % 7), device.y(), std::max(0.026, device.z() - 2e-4));
      input.v_WF = (input.p_WF - device) / options.h;
      device = input.p_WF;
      step(model, state, scratch, std::span(&input, 1));
      ASSERT_LT((state.world.points[0].p_W - device).head<2>().norm(), 2e-3) << mu << ' ' << i;
      ASSERT_LT(scratch.fingers[0].f_contact_W.norm(), 1.2 * kStiffness * 0.0021) << mu << ' ' << i;
    }
  }
}

}  // namespace
}  // namespace pincer::grasp
