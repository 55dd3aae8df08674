#include <gtest/gtest.h>

#include <algorithm>
#include <set>

#include "pincer/contact/generated_meshes.h"
#include "pincer/contact/mesh_report.h"
#include "pincer/contact/smooth_mesh.h"
#include "pincer/contact/surface/edge_cubic.h"
#include "pincer/contact/surface/surface_net.h"
#include "pincer/tests/support/constants.h"

namespace pincer::contact {
namespace {

using tests::kCreaseAngle;

struct EdgePoint {
  Vec3 S, N;
};

// Point s of edge i, by the whole patch's formula.
EdgePoint onEdge(const Patch& patch, std::size_t i, double s) {
  std::array<double, 3> b{};
  b[i] = 1 - s;
  b[(i + 1) % 3] = s;
  const PatchPoint x = evaluate(patch, b[1], b[2]);
  return {x.S, x.N.normalized()};
}

struct Gaps {
  double place = 0, normal = 0;  // [m], [rad]
  int edges = 0;                 // that were compared, from both sides
};

Gaps widestGaps(const SurfaceNet& net, bool sharp) {
  Gaps widest;
  for (std::int32_t t = 0; t < net.size(); ++t) {
    const SurfaceCell cell = net.build(t);
    for (std::size_t i = 0; i < 3; ++i) {
      const Neighbour other = cell.neighbours[i];
      if (cell.sharp[i] != sharp || other.triangle < 0) continue;
      ++widest.edges;
      for (int k = 0; k <= 16; ++k) {
        const EdgePoint a = onEdge(cell.patch, i, k / 16.0);
        const EdgePoint b = onEdge(net.build(other.triangle).patch, static_cast<std::size_t>(other.edge), 1 - k / 16.0);
        widest.place = std::max(widest.place, (a.S - b.S).norm());
        widest.normal = std::max(widest.normal, a.N.cross(b.N).norm());
      }
    }
  }
  return widest;
}

// The design asks for 1e-12 m and 1e-9 degrees; control points are shared, so
// all that differs is the order of summing.
TEST(SurfaceNet, HasNoGapAcrossSmoothEdges) {
  for (const TriangleMesh& mesh : {icosphere(0.02, 1), torus(0.03, 0.012, 12, 8), roundedCube(0.02, 0.004, 3),
                                   cylinderWithFlat(0.025, 0.03, 0.018, 20, 6)}) {
    const Gaps gaps = widestGaps(SurfaceNet(mesh, kCreaseAngle, true), false);
    EXPECT_GE(gaps.edges, 200) << mesh.source;  // 240 of the coarsest
    EXPECT_LT(gaps.place, 1e-16) << mesh.source;
    EXPECT_LT(gaps.normal, 1e-14) << mesh.source;
  }
}

TEST(SurfaceNet, HasNoHoleAlongCreases) {
  for (const TriangleMesh& mesh :
       {cylinderWithFlat(0.025, 0.03, 0.018, 20, 6), cylinder(0.025, 0.03, 12, 1), box({0.02, 0.01, 0.03})}) {
    const Gaps gaps = widestGaps(SurfaceNet(mesh, kCreaseAngle, true), true);
    EXPECT_GE(gaps.edges, 24) << mesh.source;  // a box's twelve, from both sides
    EXPECT_LT(gaps.place, 1e-16) << mesh.source;
  }
}

// A crease that ends inside a smooth surface: the rule differs at its two ends.
TEST(SurfaceNet, HasNoHoleWhereACreaseFadesOut) {
  TriangleMesh mesh;
  mesh.vertices = {{0, 0, 0},          {0.01, 0, 0},          {0.02, 0, 0},
                   {0, 0.01, -0.012},  {0.01, 0.01, -0.005},  {0.02, 0.01, 0.001},
                   {0, -0.01, -0.012}, {0.01, -0.01, -0.005}, {0.02, -0.01, 0.001}};
  mesh.triangles = {{0, 1, 4}, {0, 4, 3}, {1, 2, 5}, {1, 5, 4}, {6, 7, 1}, {6, 1, 0}, {7, 8, 2}, {7, 2, 1}};
  const SurfaceNet net(mesh, 1.2, true);
  int sharp = 0, half_sharp = 0;
  for (std::int32_t t = 0; t < net.size(); ++t) {
    const SurfaceCell cell = net.build(t);
    for (std::size_t i = 0; i < 3; ++i) {
      if (!cell.sharp[i] || cell.neighbours[i].triangle < 0) continue;
      ++sharp;
      const auto n = edgeNormals(cell.patch, static_cast<int>(i));
      const auto m = edgeNormals(net.build(cell.neighbours[i].triangle).patch, cell.neighbours[i].edge);
      half_sharp += (n[0] == m[2]) != (n[2] == m[0]);
    }
  }
  EXPECT_GT(half_sharp, 0) << "the mesh is meant to have such an edge; sharp: " << sharp;
  EXPECT_LT(widestGaps(net, true).place, 1e-16);
}

// Central differences of step 1e-6 err by 1e-12 of the third derivative and by round-off of 1e-16 / 1e-6.
TEST(SurfaceNet, DerivativesAreThoseOfThePatch) {
  const SurfaceNet net(torus(0.03, 0.012, 12, 8), kCreaseAngle, true);
  const Patch p = net.build(17).patch;
  const double e = 1e-6;
  for (const auto& [u, v] : {std::pair{0.2, 0.3}, {0.6, 0.1}, {0.05, 0.9}}) {
    const PatchPoint x = evaluate(p, u, v), pu = evaluate(p, u + e, v), mu = evaluate(p, u - e, v),
                     pv = evaluate(p, u, v + e), mv = evaluate(p, u, v - e);
    EXPECT_LT(((pu.S - mu.S) / (2 * e) - x.Su).norm(), 1e-10);
    EXPECT_LT(((pv.S - mv.S) / (2 * e) - x.Sv).norm(), 1e-10);
    EXPECT_LT(((pu.N - mu.N) / (2 * e) - x.Nu).norm(), 1e-9);
    EXPECT_LT(((pv.N - mv.N) / (2 * e) - x.Nv).norm(), 1e-9);
    EXPECT_LT((place(p, u, v) - x.S).norm(), 3e-17);  // 4 ulp of 40 mm
  }
}

// Walton and Meek's cubic follows a circular arc to fourth order; a flat edge stays straight with thirds as handles.
TEST(EdgeCubic, FollowsAnArc) {
  const double R = 0.025;
  double last = 0;
  for (const double angle : {1.0471975511965976, 0.5235987755982988, 0.2617993877991494}) {
    const Vec3 n0(1, 0, 0), n1(std::cos(angle), std::sin(angle), 0);
    const auto [V1, V2] = edgeHandles({R * n0, n0, n0}, {R * n1, n1, n1});
    const Vec3 middle = (R * n0 + 3 * V1 + 3 * V2 + R * n1) / 8;
    const double error = std::abs(middle.norm() - R);
    if (last > 0) {
      EXPECT_GT(last / error, 12) << "16 in the limit";
    }
    last = error;
  }
  EXPECT_LT(last, 5e-7) << "the design's 0.5 um, at 15 degrees of a 25 mm cylinder";
  const auto [V1, V2] =
      edgeHandles({Vec3(0, 0, 0), Vec3::UnitZ(), Vec3::UnitZ()}, {Vec3(0.03, 0, 0), Vec3::UnitZ(), Vec3::UnitZ()});
  EXPECT_LT((V1 - Vec3(0.01, 0, 0)).norm() + (V2 - Vec3(0.02, 0, 0)).norm(), 1e-17);
}

TEST(EdgeCubic, BendsAreThoseOfTheUnitNormal) {
  const Vec3 c(0.01, -0.004, 0.003), n0 = Vec3(0.2, 0.1, 1).normalized(), n1 = Vec3(-0.1, 0.3, 1).normalized(),
                                     longer = 3.7 * n1;
  const auto unit = edgeBends(c, n0, n1, 1.0), any = edgeBends(c, n0, longer, longer.squaredNorm());
  EXPECT_NEAR(any.rho, unit.rho, 1e-18) << "a few units in the last place of 1e-3";
  EXPECT_LT((any.sigma * longer - unit.sigma * n1).norm(), 1e-18);
}

TEST(EdgeCubic, ACreaseLeavesAlongBothSides) {
  const Vec3 top = Vec3::UnitZ(), n0(1, 0, 0), n1(std::cos(0.3), std::sin(0.3), 0);  // a cylinder's rim
  const auto [V1, V2] = edgeHandles({0.025 * n0, n0, top}, {0.025 * n1, n1, top});
  EXPECT_NEAR(V1.z(), 0, 1e-18);
  const Vec3 middle = (0.025 * n0 + 3 * V1 + 3 * V2 + 0.025 * n1) / 8;
  EXPECT_NEAR(middle.norm(), 0.025, 1e-8) << "the rim is round: the handles are those of an arc, of sixth order";
}

TEST(EdgeCubic, MiddleNormalIsTheSameFromBothEnds) {
  const Vec3 p0(0.01, 0.002, 0), p1(0.013, -0.004, 0.003), n0 = Vec3(0.2, 0.1, 1).normalized(),
                                                           n1 = Vec3(-0.1, 0.3, 1).normalized();
  EXPECT_EQ(middleNormal(p0, p1, n0, n1), middleNormal(p1, p0, n1, n0));
}

// Memory of a triangle that nothing has touched: its share of vertices,
// numbers, neighbours, normals, tree and hull.
TEST(SurfaceNet, KeepsAtMost160BytesPerUntouchedTriangle) {
  for (const TriangleMesh& mesh : {icosphere(0.02, 5), torus(0.03, 0.012, 100, 50), roundedCube(0.02, 0.004, 20),
                                   gridBox({0.02, 0.02, 0.02}, 20), noisy(icosphere(0.02, 4), 1e-3, 1)}) {
    const auto object = SmoothMesh::build(mesh);
    EXPECT_LE(object->memoryBytes(), 160 * mesh.triangles.size()) << mesh.source;
  }
}

TEST(SurfaceNet, ACacheOfOnePatchGivesTheSamePatches) {
  const SurfaceNet net(torus(0.03, 0.012, 12, 8), kCreaseAngle, true), other(icosphere(0.02, 2), kCreaseAngle, true);
  PatchCache small(1), large(1024);
  for (std::int32_t t = 0; t < net.size(); ++t) {
    other.cell(t, small);  // several meshes may share one
    const SurfaceCell a = net.cell(t, small), b = net.cell(t, large), c = net.cell(t, large);
    for (std::size_t i = 0; i < 10; ++i) {
      ASSERT_EQ(controlPoints(a.patch)[i], controlPoints(b.patch)[i]);
      ASSERT_EQ(controlPoints(b.patch)[i], controlPoints(c.patch)[i]);
    }
    ASSERT_EQ(a.vertices, b.vertices);
  }
}

TEST(SurfaceNet, VisitsEachCornerOfAVertexOnce) {
  TriangleMesh open = icosphere(0.02, 1);
  std::erase_if(open.triangles, [](const auto& t) { return t[0] == 0 || t[1] == 0 || t[2] == 0; });  // a border
  for (const TriangleMesh& mesh : {icosphere(0.02, 1), torus(0.03, 0.012, 12, 8), open}) {
    ASSERT_EQ(inspect(mesh).nonmanifold_vertices, 0) << mesh.source;
    const SurfaceNet net(mesh, kCreaseAngle, true);
    for (std::int32_t t = 0; t < net.size(); ++t) {
      for (int i = 0; i < 3; ++i) {
        const std::int32_t vertex = mesh.triangles[static_cast<std::size_t>(t)][static_cast<std::size_t>(i)];
        std::size_t expected = 0;
        for (const auto& v : mesh.triangles)
          expected += static_cast<std::size_t>(std::count(v.begin(), v.end(), vertex));
        std::set<std::int32_t> seen;
        net.visitCorners({t, i}, [&](const CellCorner& c) {
          EXPECT_EQ(mesh.triangles[static_cast<std::size_t>(c.triangle)][static_cast<std::size_t>(c.corner)], vertex);
          EXPECT_TRUE(seen.insert(c.triangle).second);
        });
        EXPECT_EQ(seen.size(), expected);
      }
    }
  }
}

TEST(SurfaceNet, ReportsFolds) {
  EXPECT_TRUE(SmoothMesh::build(icosphere(0.02, 1))->foldedTriangles().empty());
  TriangleMesh mesh = icosphere(0.02, 1);
  for (const Vec3& v : mesh.vertices) {  // normals that contradict the triangles, as far as they are taken
    const double way = mesh.normals.size() % 2 == 0 ? 1 : -1;
    mesh.normals.push_back((0.2 * v.normalized() + way * v.cross(Vec3(1, 2, 3)).normalized()).normalized());
  }
  mesh.triangle_normals = mesh.triangles;
  EXPECT_GT(SmoothMesh::build(mesh)->foldedTriangles().size(), 20u);
}

TEST(SurfaceNet, FindsTheTightestHollow) {
  EXPECT_GT(SmoothMesh::build(icosphere(0.02, 2))->tightestConcaveRadius(), 1e3) << "convex";
  const double inner = 0.03 - 0.012;  // a torus is hollow along its inner equator only
  // 48 segments
  EXPECT_NEAR(SmoothMesh::build(torus(0.03, 0.012, 48, 24))->tightestConcaveRadius(), inner, 0.01 * inner);
}

}  // namespace
}  // namespace pincer::contact
