#include "pincer/devices/arm/replay_arm.h"

#include <gtest/gtest.h>

#include <stdexcept>

#include "pincer/tests/support/constants.h"

namespace pincer::devices {
namespace {

TEST(ReplayArm, GoesStraightBetweenRecordedPlaces) {
  ReplayArm arm("a", {{1, Vec3(0, 0, 0)}, {2, Vec3(0.1, 0, 0)}, {4, Vec3(0.1, 0.2, 0)}});
  arm.moveTo(0.5);
  EXPECT_EQ(arm.sample().p_DF, Vec3::Zero()) << "it waits where it begins";
  EXPECT_FALSE(arm.sample().v_DF);
  arm.moveTo(1.5);
  EXPECT_NEAR((arm.sample().p_DF - Vec3(0.05, 0, 0)).norm(), 0, 1e-15);
  EXPECT_NEAR((*arm.sample().v_DF - Vec3(0.1, 0, 0)).norm(), 0, 1e-15);
  arm.moveTo(3);
  EXPECT_NEAR((arm.sample().p_DF - Vec3(0.1, 0.1, 0)).norm(), 0, 1e-15);
  EXPECT_EQ(arm.sample().time, 3);
  arm.moveTo(4);
  EXPECT_TRUE(arm.sample().valid);
  arm.moveTo(4.001);
  EXPECT_FALSE(arm.sample().valid) << "after its end it knows nothing";
  arm.moveTo(1);
  EXPECT_TRUE(arm.sample().valid);
}

TEST(ReplayArm, RefusesWhatCantBeReplayed) {
  EXPECT_THROW(ReplayArm("a", {}), std::invalid_argument);
  EXPECT_THROW(ReplayArm("a", {{1, Vec3::Zero()}, {1, Vec3::Zero()}}), std::invalid_argument);
  EXPECT_THROW(ReplayArm("a", {{1, Vec3(tests::kNan, 0, 0)}}), std::invalid_argument);
}

}  // namespace
}  // namespace pincer::devices
