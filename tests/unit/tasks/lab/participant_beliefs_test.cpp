#include <gtest/gtest.h>

#include <cmath>
#include <numbers>

#include "pincer/tasks/lab/participants/flat_belief.h"
#include "pincer/tasks/lab/participants/place_belief.h"

namespace pincer::tasks {
namespace {

constexpr double kTurn = 2 * std::numbers::pi;

struct HiddenCylinder {
  double theta = 0;
  std::array<Vec2, 2> misplacement;  // true minus felt place of a fingertip [m]
};

HiddenCylinder drawHiddenCylinder(const FlatModel& model, Random& random) {
  const double theta = random.uniform(-std::numbers::pi, std::numbers::pi);
  const Vec2 a = model.placement_sd * random.normal2(), b = model.placement_between_sd * random.normal2();
  return {theta, {Vec2(a - 0.5 * b), Vec2(a + 0.5 * b)}};
}

// A pinch at `angle`, each finger as near to the axis as the surface lets it, read with the model's own noise.
std::array<FlatPercept, 2> pinchHiddenCylinder(const FlatModel& model, const HiddenCylinder& truth, double angle,
                                               Random& random) {
  std::array<FlatPercept, 2> pinch;
  for (std::size_t i = 0; i < 2; ++i) {
    const Vec2 outwards = (i == 0 ? -1 : 1) * Vec2(std::cos(angle), std::sin(angle));
    double inside = 0, outside = 0.08;
    for (int k = 0; k < 40; ++k) {
      const double middle = 0.5 * (inside + outside);
      const bool clear =
          cutCircle(model, truth.theta, truth.misplacement[i] + middle * outwards).distance > model.tip_radius;
      (clear ? outside : inside) = middle;
    }
    FlatPercept& percept = pinch[i];
    const double normal = cutCircle(model, truth.theta, truth.misplacement[i] + outside * outwards).normal;
    percept.p_felt = outside * outwards + model.span_sd * random.normal2();
    percept.pad = i == 0 ? std::numbers::pi : 0;
    percept.push = normal + model.push_sd * random.normal();
    percept.place =
        percept.pad + model.place_gain * std::remainder(normal - percept.pad, kTurn) + model.place_sd * random.normal();
  }
  return pinch;
}

// A bootstrap filter of 600 hypotheses was sure of its direction to 5 degrees where it was 65 degrees off, in most
// trials: alignment errors of up to 175 degrees. In a world that is as the belief supposes, five pinches leave 17
// degrees on average (3000 hypotheses: the same), and what is beyond 2.5 of the spreads claimed is rare; 12 % and 26
// degrees leave room for the 120 trials drawn.
TEST(FlatBelief, IsNoSurerThanItMayBe) {
  const FlatModel model;
  Random random(5);
  constexpr int kTrials = 120;
  double error = 0;
  int too_sure = 0;
  FlatBelief belief;
  for (int trial = 0; trial < kTrials; ++trial) {
    belief.begin(model, random);
    const HiddenCylinder truth = drawHiddenCylinder(model, random);
    for (const double angle : {-0.96, 0.0, 0.96, -0.96, 0.0})
      belief.observe(pinchHiddenCylinder(model, truth, angle, random), random);
    const double off = std::abs(std::remainder(belief.direction() - truth.theta, kTurn));
    error += off / kTrials;
    too_sure += off > 2.5 * belief.spread();
  }
  EXPECT_LT(error * 360 / kTurn, 26);
  EXPECT_LT(too_sure, 0.12 * kTrials);
}

// Once sure, it went on pinching where the object no longer was, whatever the pads said.
TEST(PlaceBelief, FollowsAnObjectThatRolledAside) {
  const PlaceModel model;
  Random random(3);
  PlaceBelief belief;
  belief.begin(model, random);
  for (int k = 0; k < 6; ++k) belief.placeRead(Vec2::Zero(), random);
  EXPECT_LT(belief.offset().norm(), 2e-3);
  const Vec2 aside(0.015, 0);
  for (int k = 0; k < 4; ++k) {
    belief.letGo(random);
    belief.placeRead(model.place_gain * aside, random);
  }
  EXPECT_NEAR(belief.offset().x(), aside.x(), 4e-3);  // the standard deviation of one reading
}

// It rolls in its dish and doesn't rise: what is known of its height stays.
TEST(PlaceBelief, LettingGoForgetsNoHeight) {
  const PlaceModel model;
  Random random(3);
  PlaceBelief belief;
  belief.begin(model, random);
  for (int k = 0; k < 6; ++k) belief.placeRead(model.place_gain * Vec2(0, 0.010), random);
  const double height = belief.offset().y();
  for (int k = 0; k < 6; ++k) belief.letGo(random);
  EXPECT_EQ(belief.offset().y(), height);
}

// The dish tells the height, whatever was believed of it.
TEST(PlaceBelief, TheDishSaysHowHighTheObjectIs) {
  const PlaceModel model;
  Random random(3);
  PlaceBelief belief;
  belief.begin(model, random);
  for (int k = 0; k < 6; ++k) belief.placeRead(model.place_gain * Vec2(0, 0.010), random);
  belief.heightFound(random);
  // three standard errors of 300 hypotheses
  EXPECT_NEAR(belief.offset().y(), 0, 3 * model.height_sd / std::sqrt(300.0));
}

}  // namespace
}  // namespace pincer::tasks
