// A mesh as a body: it stands on the corners of its hull, and fingertips and balls meet its surface.
#include <gtest/gtest.h>

#include "pincer/contact/finger_query.h"
#include "pincer/contact/pair_query.h"
#include "pincer/contact/smooth_mesh.h"
#include "pincer/contact/surface/patch_cache.h"
#include "pincer/tests/support/pairs.h"

namespace pincer::contact {
namespace {

using tests::collide;

const Vec3 kHalf(0.03, 0.02, 0.01);

Mesh boxMesh() {
  TriangleMesh m;
  for (int i = 0; i < 8; ++i)
    m.vertices.emplace_back(kHalf.cwiseProduct(Vec3(i & 1 ? 1 : -1, i & 2 ? 1 : -1, i & 4 ? 1 : -1)));
  m.triangles = {{0, 2, 1}, {1, 2, 3}, {4, 5, 6}, {5, 7, 6}, {0, 1, 4}, {1, 5, 4},
                 {2, 6, 3}, {3, 6, 7}, {0, 4, 2}, {2, 4, 6}, {1, 3, 5}, {3, 7, 5}};
  m.source = "box";
  return {SmoothMesh::build(std::move(m))};
}

// The same solid as a mesh and as a box: the same points, but for the names of the corners.
TEST(MeshAsABody, MeetsGroundAndDishLikeTheBoxItIs) {
  const Mesh mesh = boxMesh();
  for (const Shape& support : {Shape(HalfSpace{}), Shape(Dish{0.15})}) {
    for (int i = 0; i < 100; ++i) {
      const Quat q = Quat(std::cos(i), std::sin(2 * i), std::cos(3 * i), std::sin(5 * i)).normalized();
      const Pose X_WA{q, {0.001 * i - 0.05, 0, 0.03}};
      const PairPoints as_mesh = collide(mesh, X_WA, support, Pose{}, 0.01);
      const PairPoints as_box = collide(Box{kHalf}, X_WA, support, Pose{}, 0.01);
      ASSERT_EQ(as_mesh.count, as_box.count) << i;
      for (int k = 0; k < as_box.count; ++k) {
        double nearest = 1;
        for (int j = 0; j < as_mesh.count; ++j)
          nearest = std::min(nearest, (as_mesh.points[j].p_W - as_box.points[k].p_W).norm());
        EXPECT_LE(nearest, 1e-15) << i;  // round-off of the same sums
      }
    }
  }
}

TEST(MeshAsABody, RestsOnTheFourCornersOfItsFace) {
  const PairPoints p = collide(boxMesh(), {Quat::Identity(), {0, 0, kHalf.z()}}, HalfSpace{}, Pose{}, 0.001);
  ASSERT_EQ(p.count, 4);
  Vec3 centre = Vec3::Zero();
  for (int k = 0; k < 4; ++k) {
    EXPECT_NEAR(p.points[k].phi, 0, 1e-15);
    EXPECT_NEAR(p.points[k].p_W.cwiseAbs().x(), kHalf.x(), 1e-15);
    EXPECT_NEAR(p.points[k].p_W.cwiseAbs().y(), kHalf.y(), 1e-15);
    centre += p.points[k].p_W / 4;
  }
  EXPECT_LE(centre.norm(), 1e-15);
}

TEST(MeshAsABody, IsSkippedOutOfReach) {
  const Mesh mesh = boxMesh();
  EXPECT_EQ(collide(mesh, {Quat::Identity(), {0, 0, 0.1}}, HalfSpace{}, Pose{}, 0.01).count, 0);
  EXPECT_EQ(collide(Sphere{0.01}, {Quat::Identity(), {0, 0, 0.1}}, mesh, Pose{}, 0.01).count, 0);
  EXPECT_GE(boundingRadius(mesh), kHalf.norm());
  EXPECT_LE(lowerBoundOfGap(mesh, {0, 0, 0.1}, 0.01), 0.1 - kHalf.z() - 0.01);
}

// 1e-9 m: what the mesh's solver promises (smooth_mesh.h).
TEST(MeshAsABody, FingertipAndBallMeetItsSurface) {
  const Mesh mesh = boxMesh();
  for (const Vec3& p_BC : {Vec3(0.005, 0.004, 0.017), Vec3(-0.036, 0.004, 0.003), Vec3(0.034, 0.023, 0.001)}) {
    SurfaceTracker tracker;
    PatchCache cache(64);
    const SurfaceContact on_mesh = querySphere(mesh, p_BC, 0.008, 0, tracker, cache).main();
    const SurfaceContact on_box = querySphere(Box{kHalf}, p_BC, 0.008, 0, tracker, cache).main();
    EXPECT_NEAR(on_mesh.phi, on_box.phi, 1e-9);
    EXPECT_LE((on_mesh.p_BS - on_box.p_BS).norm(), 1e-9);
    const PairPoints p = collide(Sphere{0.008}, {Quat::Identity(), p_BC}, mesh, Pose{}, 1);
    ASSERT_EQ(p.count, 1);
    EXPECT_EQ(p.points[0].phi, on_mesh.phi);
  }
}

}  // namespace
}  // namespace pincer::contact
