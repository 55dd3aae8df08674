// Fingers before the first tick: what no finger can be is refused by name, and a body may be felt otherwise than other
// bodies meet it.
#include <gtest/gtest.h>

#include <functional>
#include <limits>

#include "pincer/grasp/tick/scratch.h"
#include "pincer/tests/support/error_of.h"
#include "pincer/tests/support/worlds.h"

namespace pincer::grasp {
namespace {

constexpr double kNotANumber = std::numeric_limits<double>::quiet_NaN();

std::string refusalOf(const std::function<void(FingerModel&)>& change) {
  FingerModel finger = tests::softFinger("index");
  change(finger);
  return tests::errorOf([&] { buildGrasp(engine::WorldBuilder{engine::WorldOptions{}}, {finger}); });
}

TEST(GraspModel, FingersOutOfRangeAreNamed) {
  struct Case {
    std::function<void(FingerModel&)> change;
    const char* says;
  };
  const Case cases[] = {
      {[](FingerModel& f) { f.radius = 0; }, "radius = 0 is out of range (0, 1]"},
      {[](FingerModel& f) { f.radius = 1.5; }, "radius = 1.5 is out of range (0, 1]"},
      {[](FingerModel& f) { f.radius = kNotANumber; }, "radius = nan is out of range (0, 1]"},
      {[](FingerModel& f) { f.reach = -1e-3; }, "reach = -0.001 is out of range [0, 10]"},
      {[](FingerModel& f) { f.reach = 11; }, "reach = 11 is out of range [0, 10]"},
      {[](FingerModel& f) { f.pad.patch_radius = -1; }, "patch_radius = -1 is out of range [0, 0.1]"},
      {[](FingerModel& f) { f.pad.patch_radius = 0.2; }, "patch_radius = 0.2 is out of range [0, 0.1]"},
      {[](FingerModel& f) { f.pad.modulus = -1; }, "modulus = -1 is out of range"},
      {[](FingerModel& f) { f.pad.effective_radius = 20; }, "effective_radius = 20 is out of range [0, 10]"},
      {[](FingerModel& f) { f.pad = {.patch_radius = 5e-3, .modulus = 1e5}; }, "Keep one."},
      {[](FingerModel& f) { f.pad_normal_F *= 2; }, "must be unit vectors at right angles"},
      {[](FingerModel& f) { f.distal_F *= 0.5; }, "must be unit vectors at right angles"},
      {[](FingerModel& f) { f.distal_F = f.pad_normal_F; }, "must be unit vectors at right angles"},
      {[](FingerModel& f) { f.taxels = {.rows = 4}; }, "taxels in 4 rows and 0 columns are out of range 2 .. 64"},
      {[](FingerModel& f) { f.taxels = {.rows = 4, .columns = 65}; }, "taxels in 4 rows and 65 columns"},
      {[](FingerModel& f) { f.taxels = {.rows = 4, .columns = 4, .pitch = 0.2}; }, "pitch of the taxels = 0.2"},
      {[](FingerModel& f) { f.shape = contact::Sphere{-0.01}; }, "finger \"index\": "}};
  EXPECT_EQ(refusalOf([](FingerModel&) {}), "");
  for (const Case& one : cases) {
    const std::string said = refusalOf(one.change);
    EXPECT_NE(said.find(one.says), std::string::npos) << one.says << ", not: " << said;
    EXPECT_NE(said.find("finger \"index\""), std::string::npos) << said;
  }
}

TEST(GraspModel, FingersComeBeforeOtherPoints) {
  engine::WorldBuilder builder{engine::WorldOptions{}};
  builder.addPoint(tests::softFinger("other").coupling);
  const std::string said = tests::errorOf([&] { buildGrasp(builder, {tests::softFinger("index")}); });
  EXPECT_NE(said.find("fingers come first"), std::string::npos) << said;
}

engine::BodySpec fixedBall() { return {"ball", contact::Sphere{0.02}, false, 0, {0.5, 0.5}}; }

GraspModel touchable(const engine::BodySpec& body) {
  engine::WorldOptions options;
  options.gravity_W.setZero();
  engine::WorldBuilder builder{options};
  builder.addBody(body);
  return buildGrasp(builder, {tests::softFinger("index")});
}

// The force on a finger that is pressed to `height` over the body's centre, or a little less far.
double pressedForce(const GraspModel& model, double height) {
  GraspState state = makeState(model, {tests::startAt(Vec3::Zero())}, {Vec3(0, 0, 0.06)});
  GraspScratch scratch(model);
  std::vector<FingerInput> input(1);
  input[0].p_WF = Vec3(0, 0, 0.06);
  constexpr int kTicks = 400;
  for (int i = 1; i <= 2 * kTicks; ++i) {
    input[0].p_WF.z() = 0.06 + (height - 0.06) * std::min(i, kTicks) / kTicks;
    step(model, state, scratch, input);
  }
  return scratch.fingers[0].normal_force;
}

// A larger ball is felt than other bodies meet: 1000 N/m behind a fingertip of 8 mm that is led 2 mm into it.
TEST(GraspModel, FeelsAnotherSurfaceThanBodiesMeet) {
  GraspModel model = touchable(fixedBall());
  EXPECT_EQ(pressedForce(model, 0.036), 0);
  feelAs(model, 0, contact::Sphere{0.03});
  EXPECT_NEAR(pressedForce(model, 0.036), 2, 1e-6);
  EXPECT_EQ(std::get<contact::Sphere>(feltShape(model, 0)).radius, 0.03);
  EXPECT_EQ(std::get<contact::Sphere>(model.world.colliders[0].shape).radius, 0.02);
}

TEST(GraspModel, OtherSurfacesAreOfBodiesWithOneBoundedShape) {
  engine::BodySpec pair = fixedBall();
  const engine::ColliderSpec part{"part", contact::Sphere{0.01}, Pose{}};
  pair.shapes = {part, part};
  const engine::BodySpec floor{"floor", contact::HalfSpace{}, false, 0, {0.5, 0.5}};
  for (const engine::BodySpec& body : {pair, floor}) {
    GraspModel model = touchable(body);
    const std::string said = tests::errorOf([&] { feelAs(model, 0, contact::Sphere{0.03}); });
    EXPECT_NE(said.find("of one bounded shape only"), std::string::npos) << body.name << ": " << said;
  }
  GraspModel model = touchable(fixedBall());
  EXPECT_NE(tests::errorOf([&] { feelAs(model, 0, contact::HalfSpace{}); }), "");
}

}  // namespace
}  // namespace pincer::grasp
