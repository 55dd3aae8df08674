// Hints that the window gives somebody at a mouse.
#include "pincer/tasks/lab/experiments/hand_hints.h"

#include <gtest/gtest.h>

#include <string>

namespace pincer::tasks {
namespace {

// Fingers `apart`, their middle off the object's by `off_W`.
std::string reach(const Vec3& off_W, double apart = 0.07) {
  const Vec3 half(0.5 * apart, 0, 0), middle_W(0.1, 0.2, 0.02);
  return reachHint({middle_W + off_W - half, middle_W + off_W + half, middle_W});
}

TEST(HandHints, LeadTheFingersBesideTheObject) {
  EXPECT_EQ(reach({0, 0, 0}), "");
  EXPECT_EQ(reach({0, 0, -0.003}), "");
  EXPECT_EQ(reach({0, 0, 0.03}), "Lower the fingers beside the object");
  EXPECT_EQ(reach({0.015, 0, 0.03}), "It is on the left: move there");
  EXPECT_EQ(reach({-0.015, 0, 0.03}), "It is on the right: move there");
  EXPECT_TRUE(reach({0, -0.01, 0.03}).starts_with("It is farther away"));
  EXPECT_TRUE(reach({0, 0.01, 0.03}).starts_with("It is nearer"));
}

// Who had squeezed in the air was told to lower the fingers, which then came down on top of the object.
TEST(HandHints, FingersThatAreClosedInTheAirAreToBeOpenedFirst) {
  EXPECT_TRUE(reach({0, 0, 0.03}, 0.01).starts_with("Let go"));
  EXPECT_TRUE(reach({0, 0, 0}, 0.03).starts_with("Let go"));
}

TEST(HandHints, SayWhichWayToTurnAndWhereTheHandEnds) {
  const std::string left = turnHint(0, 1, true), right = turnHint(0, -1, true);
  EXPECT_TRUE(left.starts_with("Turn to the left: Q")) << left;
  EXPECT_TRUE(right.starts_with("Turn to the right: E")) << right;
  EXPECT_TRUE(std::string(turnHint(1.19, 1, true)).starts_with("So far the hand goes")) << "1.2 is its end";
  EXPECT_TRUE(std::string(turnHint(1.19, -1, true)).starts_with("Turn to the right")) << "there it can go on";
  EXPECT_EQ(std::string(turnHint(1.19, 1, false)), "Turn the hand back to the right: E");
  EXPECT_EQ(std::string(turnHint(-1.19, -1, false)), "Turn the hand back to the left: Q");
  EXPECT_TRUE(std::string(turnHint(-1.19, 1, false)).starts_with("Squeeze"));
}

// Index and thumb are told apart by nothing: a line has no sense.
TEST(HandHints, TheHandsTurnIsThatOfTheLineBetweenTheFingers) {
  const Vec3 along(0.03 * math::cos(0.7), 0.03 * math::sin(0.7), 0);
  EXPECT_NEAR(handTurn({-along, along, Vec3::Zero()}), 0.7, 1e-12);
  EXPECT_NEAR(handTurn({along, -along, Vec3::Zero()}), 0.7, 1e-12);
}

}  // namespace
}  // namespace pincer::tasks
