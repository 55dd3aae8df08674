#include <gtest/gtest.h>

#include <algorithm>

#include "pincer/contact/generated_meshes.h"
#include "pincer/contact/mesh_report.h"

namespace pincer::contact {
namespace {

std::string errorOf(void (*require)(const TriangleMesh&), const TriangleMesh& mesh) {
  try {
    require(mesh);
  } catch (const InputError& error) {
    return error.what();
  }
  return "";
}

bool mentions(const MeshReport& report, const std::string& part) {
  for (const MeshFinding& finding : report.findings) {
    if (finding.text.find(part) != std::string::npos) return true;
  }
  return false;
}

TEST(MeshReport, MeasuresABoxExactly) {
  const MeshReport report = inspect(box({0.02, 0.015, 0.03}));
  EXPECT_EQ(report.vertices, 8);
  EXPECT_EQ(report.triangles, 12);
  EXPECT_EQ(report.edges, 18);
  EXPECT_EQ(report.crease_edges, 12) << "the diagonals of its sides are flat";
  EXPECT_EQ(report.components, 1);
  EXPECT_TRUE(report.closed);
  EXPECT_FALSE(report.inverted);
  EXPECT_NEAR(report.volume, 8 * 0.02 * 0.015 * 0.03, 1e-18);  // round-off of 12 products of 1e-5 m^3
  EXPECT_NEAR(report.area, 8 * (0.02 * 0.015 + 0.015 * 0.03 + 0.03 * 0.02), 1e-16);  // the same, of 1e-3 m^2
  EXPECT_EQ(report.box_max, Vec3(0.02, 0.015, 0.03));
  EXPECT_TRUE(report.findings.empty()) << report.findings.front().text;
  EXPECT_NO_THROW(requireClosed(box({0.02, 0.015, 0.03})));
}

// Inscribed polyhedra lose 1 - (edge / R)^2 / 4 of a sphere's volume to leading order: a quarter per subdivision.
TEST(MeshReport, SeesAnIcosphereGrowIntoTheBall) {
  const double ball = 4.0 / 3 * M_PI * std::pow(0.02, 3);
  double last = 0;
  for (int level = 1; level < 5; ++level) {
    const MeshReport report = inspect(icosphere(0.02, level));
    EXPECT_EQ(report.edges, 30 * (1 << (2 * level)));
    const double missing = 1 - report.volume / ball;
    EXPECT_GT(missing, 0);
    if (level > 1) {
      EXPECT_NEAR(last / missing, 4, 0.5) << level;  // the next order is a few per cent
    }
    last = missing;
  }
}

TEST(MeshReport, VolumeDoesNotDependOnThePlace) {
  TriangleMesh mesh = icosphere(0.02, 2);
  const double volume = inspect(mesh).volume;
  for (Vec3& v : mesh.vertices) v += Vec3(10, -20, 30);
  EXPECT_NEAR(inspect(mesh).volume / volume, 1, 1e-11);  // vertices themselves are rounded to 1e-15 m of 0.02 m
}

TEST(MeshReport, FindsTheCreasesOfACylinderWithAFlat) {
  const int segments = 20, rows = 6;
  const MeshReport report = inspect(cylinderWithFlat(0.025, 0.03, 0.018, segments, rows));
  EXPECT_EQ(report.crease_edges, 2 * (segments + 1) + 2 * rows) << "two rims and two edges of the flat";
}

TEST(MeshReport, FindsAHole) {
  TriangleMesh mesh = icosphere(0.02, 1);
  mesh.source = "ball.obj";
  mesh.triangles.pop_back();
  const MeshReport report = inspect(mesh);
  EXPECT_EQ(report.boundary_edges, 3);
  EXPECT_FALSE(report.closed);
  EXPECT_TRUE(mentions(report, "3 edges") && mentions(report, "Fill the holes"));
  EXPECT_NO_THROW(requireManifold(mesh));
  const std::string error = errorOf(requireClosed, mesh);
  EXPECT_TRUE(error.starts_with("ball.obj: the mesh is open: 3 edges")) << error;
  EXPECT_NE(error.find("mm"), std::string::npos) << "where";
}

TEST(MeshReport, TellsSeamsFromHoles) {
  TriangleMesh mesh = box({0.02, 0.02, 0.02});
  TriangleMesh apart;  // each triangle with vertices of its own
  for (const auto& t : mesh.triangles) {
    std::array<std::int32_t, 3> own{};
    for (std::size_t i = 0; i < 3; ++i) {
      own[i] = static_cast<std::int32_t>(apart.vertices.size());
      apart.vertices.push_back(mesh.vertices[static_cast<std::size_t>(t[i])]);
    }
    apart.triangles.push_back(own);
  }
  const MeshReport report = inspect(apart);
  EXPECT_EQ(report.boundary_edges, 36);
  EXPECT_EQ(report.duplicate_vertices, 28);
  EXPECT_EQ(report.components, 12);
  EXPECT_TRUE(mentions(report, "All of them are seams") && mentions(report, "--repair"));
  apart.triangles.pop_back();
  EXPECT_TRUE(mentions(inspect(apart), "30 of them are seams")) << "3 edges of the hole remain";
}

TEST(MeshReport, FindsAFlippedTriangle) {
  TriangleMesh mesh = icosphere(0.02, 1);
  std::swap(mesh.triangles[7][0], mesh.triangles[7][1]);
  EXPECT_EQ(inspect(mesh).nonmanifold_edges, 3);
  EXPECT_NE(errorOf(requireManifold, mesh).find("consistent"), std::string::npos);
}

TEST(MeshReport, FindsAFin) {
  TriangleMesh mesh = icosphere(0.02, 1);
  mesh.vertices.emplace_back(0, 0, 0.05);
  mesh.triangles.push_back(
      {mesh.triangles[0][0], mesh.triangles[0][1], static_cast<std::int32_t>(mesh.vertices.size()) - 1});
  const MeshReport report = inspect(mesh);
  EXPECT_EQ(report.nonmanifold_edges, 1);
  EXPECT_EQ(report.boundary_edges, 2);
  EXPECT_NE(errorOf(requireClosed, mesh).find("1 edge,"), std::string::npos);
}

TEST(MeshReport, FindsPiecesThatTouchAtAVertex) {
  TriangleMesh mesh;
  mesh.vertices = {{0, 0, 0}, {0.01, 0, 0}, {0, 0.01, 0}, {0, 0, 0.01}, {-0.01, 0, 0}, {0, -0.01, 0}, {0, 0, -0.01}};
  mesh.triangles = {{0, 2, 1}, {0, 1, 3}, {0, 3, 2}, {1, 2, 3},
                    {0, 4, 5}, {0, 6, 4}, {0, 5, 6}, {4, 6, 5}};  // two tetrahedra share vertex 0
  const MeshReport report = inspect(mesh);
  EXPECT_EQ(report.nonmanifold_edges, 0);
  EXPECT_EQ(report.nonmanifold_vertices, 1);
  EXPECT_EQ(report.components, 2);
  EXPECT_NE(errorOf(requireManifold, mesh).find("vertex 1 at (0, 0, 0) mm"), std::string::npos)
      << errorOf(requireManifold, mesh);
}

TEST(MeshReport, FindsAMeshTurnedInsideOut) {
  TriangleMesh mesh = icosphere(0.02, 1);
  for (auto& t : mesh.triangles) std::swap(t[0], t[1]);
  const MeshReport report = inspect(mesh);
  EXPECT_TRUE(report.closed && report.inverted);
  EXPECT_NE(errorOf(requireClosed, mesh).find("face inwards"), std::string::npos);
}

TEST(MeshReport, CountsPiecesAndUnusedVertices) {
  TriangleMesh mesh = icosphere(0.01, 0), other = icosphere(0.01, 0);
  for (auto t : other.triangles) {
    for (auto& v : t) v += 12;
    mesh.triangles.push_back(t);
  }
  for (const Vec3& v : other.vertices) mesh.vertices.push_back(v + Vec3(0.05, 0, 0));
  mesh.vertices.emplace_back(9, 9, 9);
  const MeshReport report = inspect(mesh);
  EXPECT_EQ(report.components, 2);
  EXPECT_EQ(report.unused_vertices, 1);
  EXPECT_LT(report.box_max.x(), 0.1) << "an unused vertex is no part of the body";
  EXPECT_TRUE(mentions(report, "2 separate pieces") && mentions(report, "1 vertex in no triangle"));
}

bool has(const MeshReport& report, const std::string& name) {
  return std::any_of(report.findings.begin(), report.findings.end(),
                     [&](const MeshFinding& f) { return f.name == name; });
}

TEST(MeshReport, DoubtsTheUnitAndNamesOneThatFits) {
  const MeshReport metres = inspect(icosphere(20, 1));  // 40 mm, read as metres
  EXPECT_TRUE(has(metres, "wrong-scale") && mentions(metres, "--units mm (")) << metres.findings.front().text;
  // 40 mm in metres, read as millimetres
  const MeshReport millimetres = inspect(icosphere(2e-5, 1), {.metres_per_unit = 0.001});
  EXPECT_TRUE(has(millimetres, "wrong-scale") && mentions(millimetres, "--units m ("))
      << millimetres.findings.front().text;
  EXPECT_TRUE(mentions(inspect(icosphere(2e-5, 1)), "--size")) << "no unit above the metre";
  EXPECT_FALSE(metres.isFit());
}

TEST(MeshReport, FindsTrianglesWithoutAreaAndNeedles) {
  TriangleMesh mesh = icosphere(0.02, 1);
  const auto [a, b, c] = mesh.triangles[3];
  const auto middle = static_cast<std::int32_t>(mesh.vertices.size());
  mesh.vertices.push_back(0.5 *
                          (mesh.vertices[static_cast<std::size_t>(a)] + mesh.vertices[static_cast<std::size_t>(b)]));
  mesh.triangles[3] = {a, middle, c};
  mesh.triangles.push_back({middle, b, c});
  mesh.triangles.push_back({a, b, middle});
  const MeshReport flat = inspect(mesh);
  EXPECT_EQ(flat.zero_area_triangles, 1);
  EXPECT_TRUE(flat.closed && has(flat, "zero-area-triangles") && !flat.isFit());
  mesh.vertices[static_cast<std::size_t>(middle)] *= 1 - 1e-5;
  const MeshReport needle = inspect(mesh);
  EXPECT_EQ(needle.zero_area_triangles, 0);
  EXPECT_EQ(needle.needle_triangles, 1);
  EXPECT_TRUE(has(needle, "needle-triangles") && needle.isFit());
  mesh.triangles.push_back({a, a, c});
  EXPECT_EQ(inspect(mesh).zero_area_triangles, 1) << "a triangle that names a vertex twice";
  EXPECT_TRUE(inspect(mesh).closed) << "and hangs on nothing";
}

TEST(MeshReport, CountsHoles) {
  TriangleMesh mesh = icosphere(0.02, 2);
  mesh.triangles.erase(mesh.triangles.begin() + 100, mesh.triangles.begin() + 104);  // the four of one coarse triangle
  mesh.triangles.pop_back();
  const MeshReport report = inspect(mesh);
  EXPECT_EQ(report.boundary_loops, 2);
  EXPECT_TRUE(mentions(report, "2 loops, the longest of 6 edges") && mentions(report, "--fill-holes 6"))
      << report.findings.front().text;
}

TEST(MeshReport, TellsACavityFromAPieceInsideOut) {
  TriangleMesh mesh = icosphere(0.03, 1), inner = icosphere(0.01, 1);
  const auto outer = static_cast<std::int32_t>(mesh.vertices.size());
  for (auto t : inner.triangles) mesh.triangles.push_back({t[1] + outer, t[0] + outer, t[2] + outer});
  mesh.vertices.insert(mesh.vertices.end(), inner.vertices.begin(), inner.vertices.end());
  EXPECT_TRUE(inspect(mesh).isFit());
  EXPECT_NO_THROW(requireClosed(mesh));
  for (std::size_t t = 80; t < 160; ++t) std::swap(mesh.triangles[t][0], mesh.triangles[t][1]);
  EXPECT_TRUE(has(inspect(mesh), "nested-component"));
  for (std::size_t v = 42; v < 84; ++v) mesh.vertices[v].x() += 0.1;
  for (std::size_t t = 80; t < 160; ++t) std::swap(mesh.triangles[t][0], mesh.triangles[t][1]);
  EXPECT_TRUE(has(inspect(mesh), "flipped-component")) << "beside the other it is no cavity";
}

TEST(MeshReport, FileNormalsDecideWhatIsACrease) {
  TriangleMesh mesh = box({0.02, 0.02, 0.02});
  EXPECT_EQ(inspect(mesh).creased_vertices, 8);
  for (const Vec3& v : mesh.vertices) mesh.normals.push_back(v.normalized());
  mesh.triangle_normals = mesh.triangles;
  EXPECT_EQ(inspect(mesh).crease_edges, 0);
  EXPECT_TRUE(inspect(mesh).file_normals);
}

TEST(MeshReport, NamesAreUniqueAndEachFindingSaysWhere) {
  TriangleMesh mesh = icosphere(2, 1);
  mesh.triangles.push_back(mesh.triangles[0]);
  std::swap(mesh.triangles[7][0], mesh.triangles[7][1]);
  mesh.triangles.erase(mesh.triangles.begin() + 40);
  mesh.vertices.emplace_back(0, 0, 0);
  std::vector<std::string> names;
  for (const MeshFinding& finding : inspect(mesh).findings) {
    names.push_back(finding.name);
    EXPECT_NE(finding.text.find("mm"), std::string::npos) << finding.text;
    EXPECT_GT(finding.count, 0);
  }
  const std::vector<std::string> expected = {"boundary-edges",  "nonmanifold-edges", "inconsistent-winding",
                                             "duplicate-faces", "wrong-scale",       "unused-vertices"};
  EXPECT_EQ(names, expected);
}

}  // namespace
}  // namespace pincer::contact
