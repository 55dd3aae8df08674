// How far a pad's contact wanders over a curved surface.
#include "pincer/contact/shape/wander.h"

#include <gtest/gtest.h>

#include "pincer/contact/finger_query.h"
#include "pincer/contact/surface/patch_cache.h"

namespace pincer::contact {
namespace {

constexpr double kBall = 5e-4, kStep = 1e-5;  // radius of the pad's ball; how far beside it is asked [m]

Mat3 wanderOn(const Shape& shape, const Vec3& p_BC) {
  PatchCache cache(256);
  SurfaceTracker tracker;
  const SurfaceContact main = querySphere(shape, p_BC, kBall, 1e-3, tracker, cache).main();
  return wanderAt(shape, main, kBall, kStep, tracker, cache);
}

TEST(Wander, OfABallIsItsRadiusAcrossTheNormal) {
  const double radius = 0.03;
  const Vec3 n = Vec3(0.2, -0.3, 0.9).normalized();
  const Mat3 right = radius * (Mat3::Identity() - n * n.transpose());
  EXPECT_LT((wanderOn(Sphere{radius}, (radius + kBall) * n) - right).norm(), 1e-6 * radius);
}

// Turned about its axis it rolls; about the other tangent its wall is flat, as far as anybody asks.
TEST(Wander, OfACylinderIsItsRadiusAboutItsAxis) {
  const double radius = 0.03;
  const Mat3 wander = wanderOn(Cylinder{radius, 0.02}, Vec3(radius + kBall, 0, 0.001));
  EXPECT_NEAR(wander(2, 2), radius, 1e-6 * radius);
  EXPECT_GT(wander(1, 1), 10);
  EXPECT_LT(wander.col(0).norm(), 1e-9);
}

TEST(Wander, IsNoneAcrossAnEdge) {
  const double half = 0.01, out = kBall / std::sqrt(2.0);
  const Mat3 wander = wanderOn(Box{Vec3::Constant(half)}, Vec3(half + out, half + out, 0.001));
  EXPECT_NEAR(wander(2, 2), 0, 1e-3 * kBall);  // about the edge; kStep is a fiftieth of the ball
}

}  // namespace
}  // namespace pincer::contact
