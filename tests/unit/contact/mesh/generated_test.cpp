// The generated meshes are what they say: closed, of the right size, their vertices on the surface.
#include <gtest/gtest.h>

#include "pincer/contact/generated_meshes.h"
#include "pincer/contact/mesh_report.h"

namespace pincer::contact {
namespace {

void expectClosed(const TriangleMesh& mesh, int triangles, double volume, double tolerance) {
  const MeshReport report = inspect(mesh);
  EXPECT_EQ(report.triangles, triangles) << mesh.source;
  EXPECT_TRUE(report.closed) << mesh.source;
  EXPECT_EQ(report.components, 1) << mesh.source;
  EXPECT_EQ(report.duplicate_vertices + report.unused_vertices + report.nonmanifold_vertices, 0) << mesh.source;
  EXPECT_NEAR(report.volume, volume, tolerance * volume) << mesh.source;
}

TEST(GeneratedMeshes, EncloseTheVolumeOfTheirSolid) {
  const double ball = 4 * M_PI / 3 * 8e-6;
  for (const int n : {1, 2, 3, 7, 16})
    expectClosed(geodesicSphere(0.02, n), 20 * n * n, ball, n == 1 ? 0.4 : 0.9 / (n * n));
  expectClosed(icosphere(0.02, 3), 1280, ball, 0.01);
  expectClosed(uvSphere(0.02, 24, 48), 2 * 48 * 23, ball, 0.01);
  expectClosed(ellipsoid({0.03, 0.02, 0.01}, 16), 20 * 256, 4 * M_PI / 3 * 6e-6, 0.01);
  expectClosed(cylinder(0.02, 0.03, 48, 3), 48 * 8, M_PI * 4e-4 * 0.06, 0.01);
  expectClosed(gridBox({0.01, 0.02, 0.03}, 5), 12 * 25, 8 * 6e-6, 1e-14);
  expectClosed(box({0.01, 0.02, 0.03}), 12, 8 * 6e-6, 1e-14);
  expectClosed(torus(0.03, 0.01, 64, 32), 2 * 64 * 32, 2 * M_PI * M_PI * 0.03 * 1e-4, 0.02);
  expectClosed(bumpySphere(0.02, 0.05, 6, 12), 20 * 144, ball, 0.05);
  const double groove = (0.04 * 0.02 - 0.01 * 0.01) * 0.06;  // the block less the V, times the length
  expectClosed(grooveBlock(M_PI / 4, 0.01, 0.02, 0.03), 24, groove, 1e-12);
}

TEST(GeneratedMeshes, HaveTheirVerticesOnTheSurface) {
  for (const TriangleMesh& mesh : {geodesicSphere(0.02, 5), icosphere(0.02, 2), uvSphere(0.02, 9, 13)}) {
    for (const Vec3& v : mesh.vertices) EXPECT_NEAR(v.norm(), 0.02, 1e-17);
  }
  for (const Vec3& v : ellipsoid({0.03, 0.02, 0.01}, 6).vertices)
    EXPECT_NEAR(v.cwiseQuotient(Vec3(0.03, 0.02, 0.01)).norm(), 1, 1e-15);
}

TEST(GeneratedMeshes, NoiseIsBoundedAndReproducible) {
  const TriangleMesh clean = icosphere(0.02, 2), noise = noisy(clean, 1e-4, 5), again = noisy(clean, 1e-4, 5);
  double largest = 0;
  for (std::size_t i = 0; i < clean.vertices.size(); ++i) {
    largest = std::max(largest, (noise.vertices[i] - clean.vertices[i]).cwiseAbs().maxCoeff());
    EXPECT_EQ(noise.vertices[i], again.vertices[i]);
  }
  EXPECT_LE(largest, 1e-4);
  EXPECT_GT(largest, 0.99e-4);
  EXPECT_NE(noise.vertices, noisy(clean, 1e-4, 6).vertices);
}

}  // namespace
}  // namespace pincer::contact
