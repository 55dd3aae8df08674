// Fingers remember little of the shapes around them, and of the nearest only.
#include "pincer/grasp/tick/followed_shapes.h"

#include <gtest/gtest.h>

#include "pincer/contact/polytope.h"
#include "pincer/grasp/tick/scratch.h"
#include "pincer/tests/support/worlds.h"

namespace pincer::grasp {
namespace {

FingerModel padFinger(const std::string& name) {
  FingerModel finger = tests::softFinger(name.c_str());
  std::vector<Vec3> corners;
  for (int i = 0; i < 8; ++i)
    corners.push_back({i & 1 ? 9.5e-3 : -9.5e-3, i & 2 ? 9.5e-3 : -9.5e-3, i & 4 ? 1.5e-3 : -1.5e-3});
  finger.shape = contact::PadTip{contact::Polytope::hullOf(corners, "pad"), 5e-4};
  return finger;
}

// A thousand pads among as many bodies took a tracker for each of a million pairs: 3 GB.
TEST(FollowedShapes, OfAThousandPadsAmongAThousandBodiesTakeLittle) {
  engine::WorldBuilder builder{engine::WorldOptions{}};
  std::vector<engine::BodyStart> starts;
  std::vector<FingerModel> fingers;
  std::vector<Vec3> devices;
  for (int i = 0; i < 1000; ++i) {
    builder.addBody({"box" + std::to_string(i), contact::Box{Vec3::Constant(0.01)}, true, 0.1, {}});
    starts.push_back(tests::startAt(Vec3(0.1 * i, 0, 0)));
    fingers.push_back(padFinger("pad" + std::to_string(i)));
    devices.push_back(Vec3(0.1 * i, 0, 0.05));
  }
  const GraspModel model = buildGrasp(builder, fingers);
  const GraspState state = makeState(model, starts, devices);
  EXPECT_LE(state.followed.trackers.size(), 8000u);
}

TEST(FollowedShapes, OfSpheresAmongClosedFormsAreNone) {
  const tests::GraspWorld w = tests::pinchedBall(0.075, 0.6);
  EXPECT_TRUE(w.state.followed.trackers.empty());
}

FollowedShapes placesOfOne() {
  FollowedShapes all;
  all.per_finger = 3;
  all.colliders.assign(3, -1);
  all.gaps.assign(3, 0);
  all.trackers.resize(3);
  return all;
}

bool follows(const FollowedShapes& all, int collider) {
  return std::find(all.colliders.begin(), all.colliders.end(), collider) != all.colliders.end();
}

void look(FollowedShapes& all, contact::FingerTracker& spare, const std::vector<std::pair<int, double>>& shapes) {
  FingerFollower follower(all, 0, spare);
  for (const auto& [collider, gap] : shapes) {
    contact::FingerTracker& tracker = follower.of(collider);
    EXPECT_EQ(tracker.main.warm, tracker.main.c_F.x() == collider) << collider;  // its own, or a new one
    tracker.main.warm = true;
    tracker.main.c_F.x() = collider;
    follower.noteGap(gap);
  }
}

TEST(FollowedShapes, OfMoreThanThereAreThePlacesForTheNearestStay) {
  FollowedShapes all = placesOfOne();
  contact::FingerTracker spare;
  look(all, spare, {{1, 0.03}, {2, 0.01}, {3, 0.02}, {4, 0.005}, {5, 0.04}});
  for (const int kept : {2, 3, 4}) EXPECT_TRUE(follows(all, kept)) << kept;
  look(all, spare, {{1, 0.03}, {2, 0.01}, {3, 0.02}, {4, 0.005}, {5, 0.04}});
  for (const int kept : {2, 3, 4}) EXPECT_TRUE(follows(all, kept)) << kept;
}

TEST(FollowedShapes, WhatIsNotLookedAtIsForgotten) {
  FollowedShapes all = placesOfOne();
  contact::FingerTracker spare;
  look(all, spare, {{1, 0.03}, {2, 0.01}});
  look(all, spare, {{2, 0.01}});
  EXPECT_FALSE(follows(all, 1));
  EXPECT_TRUE(follows(all, 2));
}

// A pad pressed on twenty slats side by side feels what it feels on one plate.
TEST(FollowedShapes, APadOnTwentySlatsFeelsOnePlate) {
  const auto pressed = [](int slats) {
    engine::WorldBuilder builder{engine::WorldOptions{}};
    std::vector<engine::BodyStart> starts;
    const double width = 0.04 / slats;
    for (int i = 0; i < slats; ++i) {
      builder.addBody(
          {"slat" + std::to_string(i), contact::Box{Vec3(width / 2, 0.02, 0.005)}, false, 0, {0.6, 0.6, 0, 0}});
      starts.push_back(tests::startAt(Vec3(-0.02 + width * (i + 0.5), 0, -0.005)));
    }
    const GraspModel model = buildGrasp(builder, {padFinger("pad")});
    GraspState state = makeState(model, starts, {Vec3(0, 0, 2e-3)});
    GraspScratch scratch(model);
    FingerInput input;
    input.p_WF = Vec3(3e-4, 0, 1e-3);
    for (int i = 0; i < 300; ++i) EXPECT_EQ(step(model, state, scratch, {&input, 1}).status, engine::kStepOk);
    return scratch.fingers[0].f_contact_W;
  };
  EXPECT_LT((pressed(20) - pressed(1)).norm(), 1e-9);
}

}  // namespace
}  // namespace pincer::grasp
