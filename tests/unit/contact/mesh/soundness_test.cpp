// Meshes that are bad in ways which looked sound: normals that oppose each other, numbers that are none, files with
// one bad polygon, sheets without thickness.
#include <gtest/gtest.h>

#include <limits>
#include <random>

#include "pincer/contact/generated_meshes.h"
#include "pincer/contact/mesh_reader.h"
#include "pincer/contact/mesh_repair.h"
#include "pincer/contact/mesh_report.h"
#include "pincer/tests/support/error_of.h"
#include "pincer/tests/support/touch.h"

namespace pincer::contact {
namespace {

using tests::errorOf;

bool holds(const std::string& text, const std::string& part) { return text.find(part) != std::string::npos; }

const MeshFinding* findingOf(const MeshReport& report, const std::string& name) {
  for (const MeshFinding& finding : report.findings) {
    if (finding.name == name) return &finding;
  }
  return nullptr;
}

// A ball whose corners have normals of their own, each in any direction at all.
TriangleMesh ballWithRandomNormals(unsigned seed) {
  std::mt19937 random(seed);
  std::normal_distribution<double> normal;
  TriangleMesh mesh = icosphere(0.02, 1);
  for (std::size_t t = 0; t < mesh.triangles.size(); ++t) {
    const auto first = static_cast<std::int32_t>(mesh.normals.size());
    for (int i = 0; i < 3; ++i)
      mesh.normals.push_back(Vec3(normal(random), normal(random), normal(random)).normalized());
    mesh.triangle_normals.push_back({first, first + 1, first + 2});
  }
  return mesh;
}

// The same with one normal per vertex, in part reversed: what a program makes
// that averages facets which face both ways.
TriangleMesh ballWithReversedNormals(int every) {
  TriangleMesh mesh = icosphere(0.02, 2);
  for (std::size_t i = 0; i < mesh.vertices.size(); ++i) {
    const double sign = i % static_cast<std::size_t>(every) == 0 ? -1 : 1;
    mesh.normals.push_back(sign * mesh.vertices[i].normalized());
  }
  mesh.triangle_normals = mesh.triangles;
  return mesh;
}

void expectFiniteContacts(const TriangleMesh& mesh) {
  const auto surface = SmoothMesh::build(mesh);
  std::mt19937 random(5);
  std::normal_distribution<double> normal;
  for (int i = 0; i < 5000; ++i) {
    const Vec3 direction = Vec3(normal(random), normal(random), normal(random)).normalized();
    SurfaceTracker tracker;
    const SurfaceContact c = touch(*surface, 0.027 * direction, 0.008, tracker);
    ASSERT_TRUE(c.p_BS.allFinite() && c.n_B.allFinite() && std::isfinite(c.phi)) << "query " << i;
    ASSERT_NEAR(c.n_B.norm(), 1, 1e-12);
  }
}

TEST(MeshSoundness, NormalsThatOpposeEachOtherGiveFiniteContacts) {
  for (unsigned seed = 1; seed <= 4; ++seed) expectFiniteContacts(ballWithRandomNormals(seed));
  for (const int every : {1, 2, 3, 7}) expectFiniteContacts(ballWithReversedNormals(every));
}

// Normals that all point inwards say nothing: the facets decide, to the last bit.
TEST(MeshSoundness, ReversedNormalsAreAsIfThereWereNone) {
  const TriangleMesh plain = icosphere(0.02, 2);
  const auto expected = SmoothMesh::build(plain), reversed = SmoothMesh::build(ballWithReversedNormals(1));
  SurfaceTracker a, b;
  const Vec3 p(0.01, 0.02, 0.015);
  EXPECT_EQ(touch(*expected, p, 0.008, a).p_BS, touch(*reversed, p, 0.008, b).p_BS);
}

TEST(MeshSoundness, NamesOpposingNormalsAndDropsThem) {
  const TriangleMesh mesh = ballWithReversedNormals(7);
  const MeshReport report = inspect(mesh);
  const MeshFinding* finding = findingOf(report, "opposing-normals");
  ASSERT_NE(finding, nullptr);
  EXPECT_FALSE(finding->unfit);
  EXPECT_TRUE(holds(finding->text, "--repair")) << finding->text;
  const RepairedMesh repaired = repair(mesh);
  ASSERT_EQ(repaired.changes.size(), 1u);
  EXPECT_EQ(repaired.changes[0].name, "dropped-normals");
  EXPECT_EQ(repaired.changes[0].count, finding->count);
  EXPECT_TRUE(inspect(repaired.mesh).findings.empty());
  EXPECT_TRUE(repair(ballWithReversedNormals(1)).mesh.triangle_normals.empty()) << "where none is left there are none";
}

TEST(SmoothMeshBuild, NamesWhatNoReaderWouldLetThrough) {
  const auto messageOf = [](auto damage) {
    TriangleMesh mesh = icosphere(0.02, 0);
    mesh.normals = {Vec3::UnitX()};
    mesh.triangle_normals.assign(20, {-1, -1, -1});
    damage(mesh);
    return errorOf([&] { SmoothMesh::build(mesh); });
  };
  const double nan = std::numeric_limits<double>::quiet_NaN();
  EXPECT_EQ(messageOf([](TriangleMesh&) {}), "");
  EXPECT_TRUE(holds(messageOf([&](TriangleMesh& m) { m.vertices[3].y() = nan; }), "vertices[3] = ("))
      << "a NaN was a segmentation fault";
  EXPECT_TRUE(holds(messageOf([&](TriangleMesh& m) { m.vertices[3].y() = 1 / 0.0; }), "vertices[3]"));
  EXPECT_TRUE(holds(messageOf([](TriangleMesh& m) { m.triangles[2][1] = 12; }),
                    "triangles[2] uses vertex 12, out of range 0 .. 11"));
  EXPECT_TRUE(holds(messageOf([](TriangleMesh& m) { m.triangles[2][1] = -1; }), "triangles[2] uses vertex -1"));
  EXPECT_TRUE(holds(messageOf([](TriangleMesh& m) { m.triangles[2][1] = m.triangles[2][0]; }), "names a vertex twice"));
  EXPECT_TRUE(
      holds(messageOf([](TriangleMesh& m) { m.triangle_normals[4][0] = 1; }), "triangle_normals[4] uses normal 1"));
  EXPECT_TRUE(
      holds(messageOf([](TriangleMesh& m) { m.triangle_normals.pop_back(); }), "triangle_normals has 19 entries"));
  EXPECT_TRUE(holds(messageOf([](TriangleMesh& m) { m.smoothing_groups = {1}; }), "smoothing_groups has 1 entries"));
  EXPECT_TRUE(holds(messageOf([&](TriangleMesh& m) { m.normals[0].x() = nan; }), "normals[0]"));
  EXPECT_TRUE(
      holds(messageOf([](TriangleMesh& m) { m.normals[0] *= 2; }), "normals[0] = (2, 0, 0) must have the length 1"));
}

struct Told {
  std::vector<std::string> left_out;
  TriangleMesh mesh;
};
Told readLeavingOut(const std::string& text, MeshFormat format) {
  Told told;
  ReadOptions options{.degenerate = Degenerate::keep};
  options.left_out = [&](const std::string& what) { told.left_out.push_back(what); };
  told.mesh = parseMesh(text, format, "bad", options);
  return told;
}

TEST(MeshReader, OneBadPolygonIsNamedAndTheOthersAreRead) {
  const std::string obj = "v 0 0 0\nv 1 0 0\nv 0 1 0\nv 0 0 1\nv 1 1 0\n";
  for (const char* bad : {"f 1 2 9\n", "f 1 2\n", "f\n", "f 1 2 0\n", "f 1 2 -9\n", "f 1 2 x\n", "f 1 2 99999999999\n",
                          "f 1 5 2 3\n", "f 1//1 2 3\n"}) {
    const std::string text = obj + "f 1 3 2\n" + bad + "f 1 2 4\nf 1 4 3\nf 2 3 4\n";
    EXPECT_NE(errorOf([&] { parseMesh(text, MeshFormat::obj, "bad"); }), "") << bad;
    const Told told = readLeavingOut(text, MeshFormat::obj);
    ASSERT_EQ(told.left_out.size(), 1u) << bad;
    EXPECT_TRUE(holds(told.left_out[0], "bad:7: ")) << told.left_out[0];
    EXPECT_EQ(told.mesh.triangles,
              (std::vector<std::array<std::int32_t, 3>>{{0, 2, 1}, {0, 1, 3}, {0, 3, 2}, {1, 2, 3}}))
        << bad;
  }
  EXPECT_EQ(
      readLeavingOut("OFF\n3 2 0\n0 0 0\n1 0 0\n0 1 0\n3 0 1 9\n3 0 1 2\n", MeshFormat::off).mesh.triangles.size(), 1u);
  const std::string ply =
      "ply\nformat ascii 1.0\nelement vertex 3\nproperty float x\nproperty float y\nproperty float z\nelement face 3\n"
      "property list char int vertex_indices\nend_header\n0 0 0\n1 0 0\n0 1 0\n3 0 1 9\n2 0 1\n3 0 1 2\n";
  EXPECT_EQ(readLeavingOut(ply, MeshFormat::ply).left_out.size(), 2u);
  EXPECT_TRUE(
      holds(errorOf([&] { readLeavingOut(obj + "f 1 2 9\n", MeshFormat::obj); }), "none of its 1 faces can be used"));
}

TEST(PlyReader, ReadsTriangleStrips) {
  const std::string head =
      "ply\nformat ascii 1.0\nelement vertex 6\nproperty float x\nproperty float y\nproperty float z\n"
      "element tristrips 1\nproperty list int int vertex_indices\nend_header\n"
      "0 0 0\n1 0 0\n0 1 0\n1 1 0\n0 2 0\n1 2 0\n";
  using Triangles = std::vector<std::array<std::int32_t, 3>>;
  const auto trianglesOf = [&](const std::string& strip) {
    return parseMesh(head + strip, MeshFormat::ply, "strips").triangles;
  };
  EXPECT_EQ(trianglesOf("6 0 1 2 3 4 5\n"), (Triangles{{0, 1, 2}, {2, 1, 3}, {2, 3, 4}, {4, 3, 5}}));
  EXPECT_EQ(trianglesOf("9 0 1 2 -1 2 1 3 -1 5\n"), (Triangles{{0, 1, 2}, {2, 1, 3}})) << "-1 begins another strip";
  EXPECT_EQ(trianglesOf("7 0 1 2 2 3 4 5\n"), (Triangles{{0, 1, 2}, {3, 2, 4}, {3, 4, 5}}))
      << "a vertex twice turns the strip round";
  EXPECT_TRUE(holds(errorOf([&] { trianglesOf("3 0 1 9\n"); }), "uses vertex 9"));
}

TEST(MeshRepair, AFlatSheetIsNotClosedToZeroThickness) {
  TriangleMesh sheet = gridBox(Vec3(0.02, 0.02, 0.005), 4);
  std::erase_if(sheet.triangles, [&](const auto& t) {
    for (const std::int32_t v : t) {
      if (sheet.vertices[static_cast<std::size_t>(v)].z() < 0.005 - 1e-9) return true;
    }
    return false;
  });
  const RepairedMesh sheet_left = repair(sheet, {.fill_holes = 100});
  EXPECT_EQ(sheet_left.mesh.triangles.size(), sheet.triangles.size()) << "its rim is a loop of 16 edges, but no hole";
  EXPECT_FALSE(inspect(sheet_left.mesh).isFit());
  const RepairedMesh lone =
      repair({{{0, 0, 0}, {0.02, 0, 0}, {0, 0.02, 0}}, {{0, 1, 2}}, {}, {}, {}, "lone"}, {.fill_holes = 3});
  EXPECT_EQ(lone.mesh.triangles.size(), 1u) << "the other side would be a duplicate face";
}

TEST(MeshReport, NamesAPieceWithoutThickness) {
  TriangleMesh two_sided = box(Vec3(0.02, 0.02, 1e-9));
  const MeshReport report = inspect(two_sided);
  ASSERT_NE(findingOf(report, "zero-thickness"), nullptr);
  EXPECT_FALSE(report.isFit());
  const MeshReport card = inspect(box(Vec3(0.0428, 0.027, 0.0004)));
  EXPECT_EQ(findingOf(card, "zero-thickness"), nullptr) << "a bank card is thick enough";
}

}  // namespace
}  // namespace pincer::contact
