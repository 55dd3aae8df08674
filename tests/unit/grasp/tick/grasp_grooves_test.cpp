// A finger that touches one body at several places: grooves and corners of a mesh.
#include <gtest/gtest.h>

#include <cmath>
#include <memory>

#include "pincer/contact/generated_meshes.h"
#include "pincer/contact/smooth_mesh.h"
#include "pincer/grasp/step.h"
#include "pincer/grasp/tick/scratch.h"
#include "pincer/tests/support/notched_blocks.h"
#include "pincer/tests/support/worlds.h"

namespace pincer::grasp {
namespace {

constexpr double kStiffness = 1000;  // [N/m]
// [N s/m] a tip without mass nor damping swings about its place for ever; this ends it within 20 ticks
constexpr double kDamping = 0.05;
constexpr double kWay = 1e-6;  // of the device per tick [m]: 1 mm/s

// A world with one finger, led by its device.
struct Led {
  explicit Led(const Vec3& start) : device(start) {}
  const FingerReport& moveTo(const Vec3& p_WF) {
    FingerInput input;
    input.v_WF = (p_WF - device) / model.world.options.h;
    input.p_WF = device = p_WF;
    flagged += step(model, state, *scratch, std::span(&input, 1)).status != engine::kStepOk;
    return scratch->fingers[0];
  }

  int flagged = 0;  // ticks that the step complained of
  GraspModel model;
  GraspState state;
  std::unique_ptr<GraspScratch> scratch;
  Vec3 device;  // p_WF
};

// A fixed mesh without friction and one finger with a massless tip on a spring, at rest at `start`.
struct Pressed : Led {
  Pressed(const contact::TriangleMesh& mesh, const Vec3& start) : Led(start) {
    engine::WorldBuilder builder{engine::WorldOptions{}};
    builder.addBody({"block", contact::Mesh{contact::SmoothMesh::build(mesh)}, false, 0, {0, 0, 0, 0}});
    model = buildGrasp(builder, {tests::softFinger("finger", kStiffness, kDamping)});
    state = makeState(model, {tests::startAt(Vec3::Zero())}, {start});
    scratch = std::make_unique<GraspScratch>(model);
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
};

// Changes of a tick, per way of the device in it.
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

// Without friction the force is the spring's: it changes by k dx, and the place by r k dx / |f|: with the device about
// 4 mm below where the finger rests, 8 mm / 4 mm = 2 um per um. On one wall alone it stands still, and where the second
// comes or goes it carries nothing. A single contact would jump by a quarter of the finger's circumference, 12.6 mm.
TEST(GraspGrooves, AcrossAGrooveForceAndPlaceAreContinuous) {
  const double r = 0.008, rest = r * std::sqrt(2.0), depth = 0.004;
  Pressed finger(contact::grooveBlock(M_PI / 4, 0.02, 0.04, 0.04), Vec3(-0.006, 0.001, rest + 0.006));
  finger.leadTo(Vec3(-0.006, 0.001, rest - depth));
  FeltChange felt;
  for (int i = 0; i < 12000; ++i)
    felt.see(finger.model.fingers[0], finger.moveTo(Vec3(-0.006 + kWay * i, 0.001, rest - depth)),
             finger.activeContacts(), kWay);
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
    const Vec3 at = Vec3(0.005, 0.02 - 0.015 * s, 0.02 - 0.0155 * s) +
                    1e-3 * s * Vec3(std::sin(1e-3 * i), std::cos(8e-4 * i) - 1, 0);
    felt.see(finger.model.fingers[0], finger.moveTo(at), finger.activeContacts(), std::max(kWay, (at - last).norm()));
    last = at;
  }
  EXPECT_EQ(felt.most, 3);
  EXPECT_LT(felt.place, kLanding * r / 0.002);
  EXPECT_LT(felt.force, kLanding * kStiffness);
}

// Down into a torus, the finger half a millimetre narrower than the hole: the
// tip's centre is on a circle of 0.5 mm there.
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

// A tip without mass nor damping that lands fast on a nearly flat mesh: ticks that move it by its end velocity
// alternated with a spring taken at the mean of both, and it flew off with 40 N.
TEST(GraspGrooves, AFingerWithoutDampingStaysWhereItLands) {
  for (const double mu : {0.0, 0.5}) {
    engine::WorldOptions options;
    options.gravity_W = Vec3::Zero();
    engine::WorldBuilder builder(options);
    builder.addBody({"cube",
                     contact::Mesh{contact::SmoothMesh::build(contact::roundedCube(0.02, 0.004, 3))},
                     false,
                     0,
                     {mu, mu, 0, 0}});
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

// One finger behind a spring alone, and a body that doesn't move.
struct Undamped : Led {
  Undamped(contact::Shape shape, double mu, const Vec3& start) : Led(start) {
    engine::WorldOptions options;
    options.gravity_W = Vec3::Zero();
    engine::WorldBuilder builder(options);
    builder.addBody({"body", std::move(shape), false, 0, {mu, mu}});
    // may be hollow, for all that the engine knows
    const auto far_away = contact::SmoothMesh::build(contact::geodesicSphere(0.01, 2));
    builder.addBody({"mesh", contact::Mesh{far_away}, false, 0, {}});
    model = buildGrasp(builder, {tests::softFinger("finger", kStiffness, 0)});
    state = makeState(model, {tests::startAt(Vec3::Zero()), tests::startAt(Vec3(0, 0, 100))}, {start});
    scratch = std::make_unique<GraspScratch>(model);
  }
  const FingerReport& leadTo(const Vec3& p_WF, int ticks) {
    const Vec3 from = device;
    for (int i = 1; i <= ticks; ++i) moveTo(from + (p_WF - from) * i / ticks);
    return scratch->fingers[0];
  }
  const engine::PointState& tip() const { return state.world.points[0]; }
};

// Half of what its velocity changed by came back with the other sign in each tick, for ever.
TEST(GraspGrooves, ATipWithoutMassNorDampingDoesNotRing) {
  Undamped finger(contact::HalfSpace{}, 0, Vec3(0, 0, 0.01));
  finger.leadTo(Vec3(0.01, 0, 0.006), 100);  // 100 mm/s along the floor, and stops at once
  for (int i = 0; i < 20; ++i) finger.moveTo(finger.device);
  EXPECT_LT(finger.tip().v_W.norm(), 0.1 * std::pow(3, -19));
}

// Pressed 2 mm into a hollow that leaves the tip's centre a sphere of radius rho, without friction: it lies in
// the direction of the device. Ticks that take the wall where it is in their middle threw it to the other side, 2
// mm / rho times as far, and through the wall.
TEST(GraspGrooves, InAHollowHardlyWiderThanItATipWithoutDampingFollowsTheDevice) {
  constexpr double kTickWay = 1e-4;  // of the device: 100 mm/s, reached within 100 ticks
  for (const double rho : {0.5e-3, 1e-3, 4e-3}) {
    const double radius = 8e-3 + rho, depth = rho + 2e-3, per_tick = kTickWay / depth;
    const Vec3 centre(0, 0, radius);
    Undamped finger(contact::Dish{radius}, 0, centre);
    finger.leadTo(centre - Vec3(0, 0, depth), 100);
    for (int i = 1; i < 2000; ++i) {
      const double a = per_tick * (i < 100 ? 0.005 * i * i : i - 50);
      finger.moveTo(centre + depth * Vec3(std::sin(a), 0, -std::cos(a)));
      const Vec3 off = finger.tip().p_W - centre;
      // A tick's way leaves the curve by its sagitta at most; swings from setting out fade within
      // 50 ticks, then half a tick's lag is left.
      ASSERT_LT(off.norm(), rho + 0.5 * kTickWay * kTickWay / rho) << rho << ' ' << i;
      ASSERT_LT((off.normalized() - (finger.device - centre).normalized()).norm(), (i < 150 ? 3 : 0.5) * per_tick)
          << rho << ' ' << i;
    }
  }
}

// Between the walls of a steep groove friction holds by squeezing, whatever pulls: rigid walls may
// squeeze by any amount. Along the groove it takes mu P / sin(alpha) to slide, P pressing in, 2 alpha the
// opening; and what is pulled out comes out.
TEST(GraspGrooves, ASteepGrooveDoesNotKeepTheFinger) {
  const double alpha = 0.25, mu = 0.5, r = 8e-3, rest = r / std::sin(alpha);  // tan(alpha) = 0.255: it locks
  const contact::Mesh groove{contact::SmoothMesh::build(contact::grooveBlock(alpha, 0.06, 0.06, 0.06))};
  Undamped finger(groove, mu, Vec3(1e-4, -0.02, rest + 1e-3));
  finger.leadTo(Vec3(0, -0.02, rest - 2e-3), 100);
  const FingerReport& pressed = finger.leadTo(Vec3(0, 0.02, rest - 2e-3), 400);
  const double press = pressed.f_user_W.z();
  EXPECT_NEAR(press, 2e-3 * kStiffness, 1e-3);
  EXPECT_NEAR(-pressed.f_user_W.y(), mu * press / std::sin(alpha), 1e-3 * press);
  for (const engine::Contact& c : finger.scratch->world.contacts)
    EXPECT_LT(c.r[2] / finger.model.world.options.h, press / std::sin(alpha));
  const FingerReport& pulled = finger.leadTo(Vec3(0, 0.02, rest + 2e-3), 100);
  EXPECT_LT(pulled.f_user_W.norm(), 0.2);
}

// A finger that lands on one wall of a groove that locks while it sticks to the other asks for what no
// motion gives. There was no answer: such ticks were flagged, or taken for solved with a squeeze of 1e9 N,
// and the finger was thrown out by up to 8e7 N.
TEST(GraspGrooves, AFingerThatWandersInASteepGrooveHasAnAnswerInEachTick) {
  for (const double mu : {0.5, 0.8, 1.2}) {
    const double alpha = 0.25, rest = 8e-3 / std::sin(alpha);
    const contact::Mesh groove{contact::SmoothMesh::build(contact::grooveBlock(alpha, 0.06, 0.06, 0.06))};
    Undamped finger(groove, mu, Vec3(1e-4, 0, rest + 1e-3));
    for (int i = 0; i < 10000; ++i) {
      const double t = 1e-3 * i;
      const Vec3 way(2e-3 * std::sin(7 * t) + 1e-3 * std::sin(31 * t), 0.01 * std::sin(2 * t),
                     2e-3 * std::sin(5 * t) + 1e-3 * std::sin(23 * t));
      const FingerReport& felt = finger.moveTo(Vec3(0, 0, rest - 1e-3) + way);
      // it sticks up to some way behind the device
      ASSERT_LT(felt.f_user_W.norm(), kStiffness * 0.03) << mu << ' ' << i;
    }
    EXPECT_EQ(finger.flagged, 0) << mu;
  }
}

}  // namespace
}  // namespace pincer::grasp
