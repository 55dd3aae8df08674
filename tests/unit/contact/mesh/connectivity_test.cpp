#include "pincer/contact/mesh/connectivity.h"

#include <gtest/gtest.h>

#include "pincer/contact/generated_meshes.h"
#include "pincer/tests/support/constants.h"

namespace pincer::contact {
namespace {

using tests::kCreaseAngle;

TEST(Connectivity, NeighboursAgree) {
  const TriangleMesh mesh = torus(0.03, 0.012, 12, 8);
  const Neighbours neighbours = findNeighbours(mesh);
  for (std::size_t t = 0; t < mesh.triangles.size(); ++t) {
    for (std::size_t i = 0; i < 3; ++i) {
      const auto [other, edge] = neighbours[t][i];
      ASSERT_GE(other, 0);
      const auto s = static_cast<std::size_t>(other), j = static_cast<std::size_t>(edge);
      EXPECT_EQ(neighbours[s][j].triangle, static_cast<std::int32_t>(t));
      EXPECT_EQ(neighbours[s][j].edge, static_cast<std::int8_t>(i));
      EXPECT_EQ(mesh.triangles[t][i], mesh.triangles[s][(j + 1) % 3]) << "the same edge, run the other way";
      EXPECT_EQ(mesh.triangles[t][(i + 1) % 3], mesh.triangles[s][j]);
    }
  }
}

TEST(Connectivity, AnOpenBorderHasNoNeighbourAndIsSharp) {
  TriangleMesh mesh;
  mesh.vertices = {{0, 0, 0}, {1, 0, 0}, {0, 1, 0}};
  mesh.triangles = {{0, 1, 2}};
  const Neighbours neighbours = findNeighbours(mesh);
  const CornerNormals corners = findCornerNormals(mesh, neighbours, kCreaseAngle, true);
  for (std::size_t i = 0; i < 3; ++i) {
    EXPECT_EQ(neighbours[0][i].triangle, -1);
    EXPECT_TRUE(corners.sharp[0][i]);
    EXPECT_EQ(corners.normals[0][i], Vec3(0, 0, 1));
  }
}

TEST(Connectivity, ABoxHasOneNormalPerSideAtEachCorner) {
  const TriangleMesh mesh = box({0.02, 0.03, 0.01});
  const CornerNormals corners = findCornerNormals(mesh, findNeighbours(mesh), kCreaseAngle, true);
  for (std::size_t t = 0; t < mesh.triangles.size(); ++t) {
    for (const Vec3& n : corners.normals[t]) {
      EXPECT_NEAR(n.cwiseAbs().maxCoeff(), 1, 1e-15);  // along an axis, to round-off
      EXPECT_EQ(n, corners.normals[t][0]);
    }
  }
}

// Max's weights are exact where the vertices lie on a sphere.
TEST(Connectivity, NormalsOfAnIcospherePointOutwards) {
  for (const int level : {1, 2, 3}) {
    const TriangleMesh mesh = icosphere(0.02, level);
    const CornerNormals corners = findCornerNormals(mesh, findNeighbours(mesh), M_PI, true);
    double worst = 0;
    for (std::size_t t = 0; t < mesh.triangles.size(); ++t) {
      for (std::size_t i = 0; i < 3; ++i) {
        const Vec3 radial = mesh.vertices[static_cast<std::size_t>(mesh.triangles[t][i])].normalized();
        worst = std::max(worst, corners.normals[t][i].cross(radial).norm());
      }
    }
    EXPECT_LT(worst, 1e-14) << level;
  }
}

// At the flat's edges the round side's normal is the cylinder's, though only one side of the vertex is round.
TEST(Connectivity, NormalsContinueToACrease) {
  const TriangleMesh mesh = cylinderWithFlat(0.025, 0.03, 0.018, 20, 6);
  const CornerNormals corners = findCornerNormals(mesh, findNeighbours(mesh), kCreaseAngle, true);
  int checked = 0;
  for (std::size_t t = 0; t < mesh.triangles.size(); ++t) {
    for (std::size_t i = 0; i < 3; ++i) {
      const Vec3& p = mesh.vertices[static_cast<std::size_t>(mesh.triangles[t][i])];
      const Vec3 radial = Vec3(p.x(), p.y(), 0) / 0.025;
      const Vec3& n = corners.normals[t][i];
      const bool on_flat = n.x() > 0.99 && radial.x()<0.9, on_cap = std::abs(n.z())> 0.9,
                 at_corner = std::abs(p.z()) == 0.03;
      if (on_flat || on_cap || at_corner) continue;
      ++checked;
      EXPECT_LT(n.cross(radial).norm(), 1e-14) << p.transpose();  // round-off: the mirror of a regular polygon is exact
    }
  }
  EXPECT_GT(checked, 100);
}

TEST(Connectivity, FileNormalsDecideWhatIsSharp) {
  TriangleMesh mesh = box({0.02, 0.02, 0.02});
  for (const Vec3& v : mesh.vertices) mesh.normals.push_back(v.normalized());
  mesh.triangle_normals = mesh.triangles;  // one normal per vertex: a smooth cube
  const Neighbours neighbours = findNeighbours(mesh);
  const CornerNormals smooth = findCornerNormals(mesh, neighbours, kCreaseAngle, true);
  const CornerNormals sharp = findCornerNormals(mesh, neighbours, kCreaseAngle, false);
  int smooth_edges = 0, sharp_edges = 0;
  for (std::size_t t = 0; t < mesh.triangles.size(); ++t) {
    for (std::size_t i = 0; i < 3; ++i) {
      smooth_edges += !smooth.sharp[t][i];
      sharp_edges += sharp.sharp[t][i];
      EXPECT_LT(
          (smooth.normals[t][i] - mesh.vertices[static_cast<std::size_t>(mesh.triangles[t][i])].normalized()).norm(),
          1e-15);
    }
  }
  EXPECT_EQ(smooth_edges, 36);
  EXPECT_EQ(sharp_edges, 24) << "twelve edges, seen from both sides";
}

// 8 sides of 45 degrees to each other, which the crease angle takes for sharp.
TriangleMesh groupedCylinder(std::int32_t side_group) {
  TriangleMesh mesh = cylinder(0.02, 0.03, 8, 2);
  for (const auto& triangle : mesh.triangles) {
    double rim = 0;
    for (const std::int32_t v : triangle) rim += mesh.vertices[static_cast<std::size_t>(v)].z() / 0.09;
    mesh.smoothing_groups.push_back(std::abs(rim) < 0.99 ? side_group : 2);
  }
  return mesh;
}

// of the edges whose triangles have normals about z, or not
double sharpShare(const TriangleMesh& mesh, bool sides, bool use_file) {
  const CornerNormals corners = findCornerNormals(mesh, findNeighbours(mesh), kCreaseAngle, use_file);
  int sharp = 0, all = 0;
  for (std::size_t t = 0; t < mesh.triangles.size(); ++t) {
    if ((mesh.smoothing_groups[t] == 2) == sides) continue;
    for (const bool s : corners.sharp[t]) {
      ++all;
      sharp += s;
    }
  }
  return static_cast<double>(sharp) / all;
}

// The side has 8 x 2 rows x 2 triangles, so 96 of their edges: 16 on the rims, 16 between the rows, 32 diagonals and 32
// between the 8 flat sides. Each cap has 8 triangles with 24 edges, 8 of them on the rim.
TEST(Connectivity, SmoothingGroupsDecideWhatIsSharp) {
  EXPECT_EQ(sharpShare(groupedCylinder(1), true, true), 16.0 / 96) << "only the rims";
  EXPECT_EQ(sharpShare(groupedCylinder(0), true, true), 48.0 / 96) << "s off: every edge but those within a flat side";
  EXPECT_EQ(sharpShare(groupedCylinder(1), true, false), 48.0 / 96) << "not asked: the crease angle";
  EXPECT_EQ(sharpShare(groupedCylinder(1), false, true), 16.0 / 48) << "the caps' rims";
}

TEST(Connectivity, FileNormalsWinOverSmoothingGroups) {
  TriangleMesh mesh = icosphere(0.02, 1);
  for (const Vec3& p : mesh.vertices) mesh.normals.push_back(p.normalized());
  mesh.triangle_normals = mesh.triangles;
  for (std::size_t t = 0; t < mesh.triangles.size(); ++t)
    mesh.smoothing_groups.push_back(static_cast<std::int32_t>(t) + 1);
  const CornerNormals corners = findCornerNormals(mesh, findNeighbours(mesh), kCreaseAngle, true);
  for (const auto& sharp : corners.sharp) EXPECT_EQ(sharp, (std::array<bool, 3>{false, false, false}));
}

}  // namespace
}  // namespace pincer::contact
