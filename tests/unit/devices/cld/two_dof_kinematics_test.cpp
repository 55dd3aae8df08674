#include "pincer/devices/cld/two_dof_kinematics.h"

#include <gtest/gtest.h>

#include <cmath>
#include <stdexcept>

#include "pincer/tests/support/constants.h"
#include "pincer/tests/support/random_numbers.h"

namespace pincer::devices {
namespace {

const TwoDofKinematics kIndex;

PadWay drawWay(tests::RandomNumbers& draw, const TwoDofGeometry& g = {}) {
  return {draw.uniform(g.place_min, g.place_max), draw.uniform(-g.carriage_max, g.carriage_max)};
}

TEST(TwoDofKinematics, JacobianIsTheDerivativeOfTheTactorsRoot) {
  tests::RandomNumbers draw(1);
  for (int i = 0; i < 200; ++i) {
    const Vec3 q(draw.uniform(-0.01, 0.01), draw.uniform(0, 1.4), draw.uniform(-1.2, 1.2));
    const Mat3 J = kIndex.jacobian(q);
    for (int k = 0; k < 3; ++k) {
      const Vec3 h = 1e-6 * Vec3::Unit(k);
      const Vec3 slope = (kIndex.tactorRoot(q + h) - kIndex.tactorRoot(q - h)) / 2e-6;
      EXPECT_NEAR((slope - J.col(k)).norm(), 0, 1e-9);
    }
    EXPECT_NEAR(J.determinant(), -0.019 * 0.019 * std::cos(q[2]) * std::cos(q[2]) * std::sin(q[1]), 1e-15);
  }
}

TEST(TwoDofKinematics, IsSingularWithTheRingUprightOrTheCarriageAtItsSide) {
  EXPECT_EQ(kIndex.jacobian(Vec3(0.002, 0, 0.3)).determinant(), 0);
  EXPECT_NEAR(kIndex.jacobian(Vec3(0.002, 0.7, tests::kPi / 2)).determinant(), 0, 1e-18);
}

// The tactor sticks out R - r towards the ring's centre: its tip lies on the finger wherever the profile leads it.
TEST(TwoDofKinematics, TheProfileKeepsTheTactorOnTheFinger) {
  tests::RandomNumbers draw(2);
  for (int i = 0; i < 1000; ++i) {
    const PadWay way = drawWay(draw);
    const Vec3 q = kIndex.actuatorsAt(way);
    const Vec3 centre(q[0], 0, 0);  // of the ring
    const Vec3 tip = centre + (kIndex.tactorRoot(q) - centre) * (0.008 / 0.019);
    const double on_axis = std::min(tip.x(), 0.0);
    EXPECT_NEAR((tip - Vec3(on_axis, 0, 0)).norm(), 0.008, 1e-12) << way.along << ", " << way.round;
  }
}

TEST(TwoDofKinematics, ForwardAndInverseUndoEachOther) {
  tests::RandomNumbers draw(3);
  for (int i = 0; i < 2000; ++i) {
    const PadWay way = drawWay(draw);
    const PadWay back = kIndex.wayOf(kIndex.actuatorsAt(way));
    EXPECT_NEAR(back.along, way.along, 1e-15);
    EXPECT_EQ(back.round, way.round);
    const PadWay again = kIndex.wayTo(kIndex.placeAt(way));
    EXPECT_NEAR(again.along, way.along, 1e-11);  // atan2 and asin near a quarter turn
    EXPECT_NEAR(again.round, way.round, 1e-9);
  }
}

// Near the pad's centre a place is a way along and one round, on either half.
TEST(TwoDofKinematics, PlacesAreArcLengths) {
  EXPECT_NEAR((kIndex.placeAt({0.005, 0}) - Vec2(0.005, 0)).norm(), 0, 1e-15);
  EXPECT_NEAR((kIndex.placeAt({-0.005, 0.5}) - Vec2(-0.005, 0.004)).norm(), 0, 1e-15);
  for (const double s : {-1e-9, 1e-9}) {  // no step between the halves
    EXPECT_NEAR((kIndex.placeAt({s, 0.7}) - Vec2(0, 0.0056)).norm(), 0, 1e-8);
  }
  const Vec2 place = kIndex.placeAt({0.004, 0.4});
  const Vec3 direction(std::cos(0.4) * std::sin(0.5), std::sin(0.4), -std::cos(0.4) * std::cos(0.5));
  EXPECT_NEAR(place.norm(), 0.008 * std::acos(-direction.z()), 1e-12);
}

TEST(TwoDofKinematics, ReachesWhatItCanExactly) {
  tests::RandomNumbers draw(4);
  for (int i = 0; i < 1000; ++i) {
    const PadWay way = drawWay(draw);
    const Vec2 place = kIndex.placeAt(way);
    const Reach reach = kIndex.reach(place);
    EXPECT_FALSE(reach.moved) << place.transpose();
    EXPECT_EQ(reach.place_L, place);
  }
}

// Against a fine grid over all that can be reached.
TEST(TwoDofKinematics, GivesTheNearestReachablePlaceForAllOthers) {
  tests::RandomNumbers draw(5);
  const TwoDofGeometry g;
  int outside = 0;
  for (int i = 0; i < 60; ++i) {
    const Vec2 place(draw.uniform(-0.03, 0.03), draw.uniform(-0.03, 0.03));
    const Reach reach = kIndex.reach(place);
    if (!reach.moved) continue;
    ++outside;
    double best = 1;
    for (int a = 0; a <= 300; ++a) {
      for (int b = 0; b <= 300; ++b) {
        const PadWay way{g.place_min + (g.place_max - g.place_min) * a / 300, g.carriage_max * (b - 150) / 150};
        best = std::min(best, (kIndex.placeAt(way) - place).norm());
      }
    }
    EXPECT_LE((reach.place_L - place).norm(), best + 1e-9) << place.transpose();
    EXPECT_GE((reach.place_L - place).norm(), best - 1e-4) << "nearer than anything can be: the grid's step is 80 um";
    EXPECT_FALSE(kIndex.reach(kIndex.placeAt({0.999 * reach.way.along, 0.999 * reach.way.round})).moved);
  }
  EXPECT_GT(outside, 30);
}

TEST(TwoDofKinematics, FollowsAMeasuredProfile) {
  const FingerProfile flat{0.008,
                           {{-0.012, -0.011, 0}, {-0.002, -0.003, 0.1}, {0.004, 0.001, 0.5}, {0.012, 0.002, 1.3}}};
  const TwoDofKinematics kinematics({}, flat);
  for (const ProfilePoint& p : flat.points) {
    EXPECT_NEAR((kinematics.actuatorsAt({p.place, 0.2}) - Vec3(p.plate, p.tilt, 0.2)).norm(), 0, 1e-15);
    EXPECT_NEAR(kinematics.wayOf(Vec3(p.plate, p.tilt, 0)).along, p.place, 1e-12);
  }
  for (double s = -0.012; s < 0.012; s += 1e-4)
    EXPECT_NEAR(kinematics.wayOf(kinematics.actuatorsAt({s, 0})).along, s, 1e-12);
}

TEST(TwoDofKinematics, NamesWhatIsOutOfRange) {
  TwoDofGeometry geometry;
  geometry.ring_radius = 0;
  EXPECT_THROW(TwoDofKinematics{geometry}, std::invalid_argument);
  geometry = {};
  geometry.place_max = 0.02;
  EXPECT_NE(problemWith(geometry, FingerProfile::capsule(0.008)).value().find("place_max"), std::string::npos);
  geometry = {};
  geometry.place_min = 0.001;
  EXPECT_NE(problemWith(geometry, FingerProfile::capsule(0.008)).value().find("place_min"), std::string::npos);
  geometry = {};
  geometry.carriage_max = 2;
  EXPECT_NE(problemWith(geometry, FingerProfile::capsule(0.008)).value().find("carriage_max"), std::string::npos);
  geometry = {};
  EXPECT_NE(problemWith(geometry, FingerProfile::capsule(0.02)).value().find("radius"), std::string::npos);
  EXPECT_NE(problemWith(geometry, {0.008, {{0, 0, 0}}}).value().find("two points"), std::string::npos);
  EXPECT_NE(problemWith(geometry, {0.008, {{0, 0, 0}, {0.01, -0.001, 1}}}).value().find("point 1"), std::string::npos);
}

}  // namespace
}  // namespace pincer::devices
