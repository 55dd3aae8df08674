// Costs of touching pairs, printed: nanoseconds per query. Asserts nothing about time.
#include <fmt/format.h>
#include <gtest/gtest.h>

#include <chrono>

#include "pincer/contact/generated_meshes.h"
#include "pincer/contact/pair_query.h"
#include "pincer/contact/shape/separation.h"
#include "pincer/contact/smooth_mesh.h"
#include "pincer/contact/surface/patch_cache.h"
#include "pincer/tests/support/sampled_surface.h"

namespace pincer::contact {
namespace {

// a above b, turned a little about both horizontal axes, 10 um apart along z.
Pose above(const Shape& a, const Shape& b) {
  const Quat q(Eigen::AngleAxisd(0.01, Vec3(1, 2, 3).normalized()));
  const PosedSolid A{a, q.toRotationMatrix(), Vec3::Zero()}, B{b, Mat3::Identity(), Vec3::Zero()};
  return {q, (1e-5 - gapAlong(A, B, Vec3::UnitZ()) + roundingOf(a) + roundingOf(b)) * Vec3::UnitZ()};
}

double nanoseconds(const Shape& a, const Pose& X_WA, const Shape& b, PairPoints& out) {
  PatchCache cache;
  constexpr int kQueries = 300;
  const auto start = std::chrono::steady_clock::now();
  for (int i = 0; i < kQueries; ++i) collideShapes(a, X_WA, b, Pose{}, 1e-3, cache, out);
  return std::chrono::duration<double, std::nano>(std::chrono::steady_clock::now() - start).count() / kQueries;
}

TEST(PairCost, OfTouchingSolids) {
  const std::vector<tests::NamedShape>& solids = tests::sampleConvexSolids();
  for (const tests::NamedShape& a : solids) {
    for (const tests::NamedShape& b : solids) {
      PairPoints out;
      const double ns = nanoseconds(a.shape, above(a.shape, b.shape), b.shape, out);
      ASSERT_GE(out.count, 1);
      fmt::print("{:28} {:28} {} points {:8.0f} ns\n", a.name, b.name, out.count, ns);
    }
  }
}

// A sphere's mesh, then a cube's, on a box.
TEST(PairCost, OfTouchingMeshes) {
  for (const auto& [name, triangles] : {std::pair("sphere, 5120 triangles", icosphere(0.02, 4)),
                                        std::pair("cube, 12 triangles", box({0.02, 0.02, 0.02}))}) {
    const Shape mesh = Mesh{SmoothMesh::build(triangles)};
    const Pose X{Quat::Identity(), {0, 0, 0.04}};
    const Box other{{0.02, 0.02, 0.02}};
    PairPoints out;
    const double ns = nanoseconds(mesh, X, other, out);
    ASSERT_GE(out.count, 1);
    fmt::print("{:28} {:28} {} points {:8.0f} ns\n", name, "box", out.count, ns);
  }
}

}  // namespace
}  // namespace pincer::contact
