#include <gtest/gtest.h>

#include <algorithm>
#include <filesystem>
#include <random>

#include "pincer/contact/generated_meshes.h"
#include "pincer/contact/mesh_reader.h"
#include "pincer/contact/mesh_repair.h"
#include "pincer/contact/mesh_report.h"
#include "pincer/tests/support/inside_out.h"

namespace pincer::contact {
namespace {

using tests::insideOut;

int countOf(const RepairedMesh& repaired, const std::string& name) {
  for (const MeshChange& change : repaired.changes) {
    if (change.name == name) return change.count;
  }
  return 0;
}

std::string changesOf(const RepairedMesh& repaired) {
  std::string text;
  for (const MeshChange& change : repaired.changes) text += change.name + ": " + change.text + "\n";
  return text;
}

void expectSame(const TriangleMesh& a, const TriangleMesh& b) {
  EXPECT_EQ(a.vertices, b.vertices);
  EXPECT_EQ(a.triangles, b.triangles);
  EXPECT_EQ(a.normals, b.normals);
  EXPECT_EQ(a.triangle_normals, b.triangle_normals);
}

// Each triangle with vertices of its own, as STL has them.
TriangleMesh soup(const TriangleMesh& mesh) {
  TriangleMesh apart;
  apart.source = mesh.source;
  for (const auto& t : mesh.triangles) {
    std::array<std::int32_t, 3> own{};
    for (std::size_t i = 0; i < 3; ++i) {
      own[i] = static_cast<std::int32_t>(apart.vertices.size());
      apart.vertices.push_back(mesh.vertices[static_cast<std::size_t>(t[i])]);
    }
    apart.triangles.push_back(own);
  }
  return apart;
}

void append(TriangleMesh& mesh, const TriangleMesh& other, const Vec3& offset) {
  const auto first = static_cast<std::int32_t>(mesh.vertices.size());
  for (const Vec3& v : other.vertices) mesh.vertices.push_back(v + offset);
  for (auto t : other.triangles) {
    for (auto& v : t) v += first;
    mesh.triangles.push_back(t);
  }
}

void expectClosedLike(const TriangleMesh& original, const RepairedMesh& repaired) {
  const MeshReport report = inspect(repaired.mesh);
  EXPECT_TRUE(report.isFit()) << report.findings.front().text << changesOf(repaired);
  // the same triangles, summed in another order
  EXPECT_NEAR(report.volume, inspect(original).volume, 1e-12 * report.volume);
}

TEST(MeshRepair, LeavesSoundMeshesAsTheyAreToTheLastBit) {
  TriangleMesh touching = box(Vec3::Constant(0.01));
  // two cubes that share a corner's place, each with a vertex there
  append(touching, box(Vec3::Constant(0.01)), {0.02, 0.02, 0.02});
  TriangleMesh hollow = box(Vec3::Constant(0.03));
  append(hollow, insideOut(box(Vec3::Constant(0.01))), Vec3::Zero());  // a cavity faces inwards, and should
  for (const TriangleMesh& sound :
       {icosphere(0.02, 2), torus(0.03, 0.01, 12, 8), cylinder(0.02, 0.03, 20, 3), touching, hollow}) {
    for (const RepairOptions& options : {RepairOptions{}, RepairOptions{.weld = 1e-3, .fill_holes = 100}}) {
      const RepairedMesh repaired = repair(sound, options);
      EXPECT_TRUE(repaired.changes.empty()) << changesOf(repaired);
      expectSame(repaired.mesh, sound);
    }
  }
}

TEST(MeshRepair, WeldsATriangleSoup) {
  const TriangleMesh ball = icosphere(0.02, 2);
  const RepairedMesh repaired = repair(soup(ball));
  EXPECT_EQ(countOf(repaired, "welded-vertices"), 3 * 320 - 162);
  EXPECT_EQ(countOf(repaired, "dropped-vertices"), 3 * 320 - 162);
  EXPECT_EQ(repaired.mesh.vertices.size(), 162u);
  expectClosedLike(ball, repaired);
}

TEST(MeshRepair, WeldsWithinADistanceOnlyWhereAsked) {
  TriangleMesh rough = soup(box(Vec3::Constant(0.01)));
  std::mt19937 random(1);
  for (Vec3& v : rough.vertices)
    v += 1e-7 * Vec3(static_cast<double>(random() % 2), static_cast<double>(random() % 2), 0);
  EXPECT_FALSE(inspect(repair(rough).mesh).closed);
  const RepairedMesh repaired = repair(rough, {.weld = 1e-6});
  EXPECT_EQ(repaired.mesh.vertices.size(), 8u) << changesOf(repaired);
  EXPECT_TRUE(inspect(repaired.mesh).closed);
}

TEST(MeshRepair, ClosesTheGapThatATriangleOfTwoEqualCornersLeaves) {
  TriangleMesh mesh = icosphere(0.02, 1);
  const auto twin = static_cast<std::int32_t>(mesh.vertices.size());
  const auto [a, b, c] = mesh.triangles[0];
  mesh.vertices.push_back(Vec3(mesh.vertices[static_cast<std::size_t>(a)]));
  mesh.triangles[0] = {twin, b, c};
  mesh.triangles.push_back({a, b, twin});  // no area: a and its twin are at one place
  mesh.triangles.push_back({a, twin, c});
  ASSERT_EQ(inspect(mesh).zero_area_triangles, 2);
  const RepairedMesh repaired = repair(mesh);
  EXPECT_EQ(countOf(repaired, "dropped-degenerate-triangles"), 2);
  expectClosedLike(icosphere(0.02, 1), repaired);
}

TEST(MeshRepair, TurnsTheSideOfATriangleWhoseCornersAreInARow) {
  TriangleMesh mesh = box(Vec3::Constant(0.01));
  const auto [a, b, c] = mesh.triangles[0];
  const auto middle = static_cast<std::int32_t>(mesh.vertices.size());
  mesh.vertices.push_back(0.5 *
                          (mesh.vertices[static_cast<std::size_t>(a)] + mesh.vertices[static_cast<std::size_t>(b)]));
  mesh.triangles[0] = {a, middle, c};
  mesh.triangles.push_back({middle, b, c});
  mesh.triangles.push_back({a, b, middle});  // lies on the edge from a to b
  ASSERT_EQ(inspect(mesh).zero_area_triangles, 1);
  ASSERT_TRUE(inspect(mesh).closed);
  const RepairedMesh repaired = repair(mesh);
  EXPECT_EQ(countOf(repaired, "removed-flat-triangles"), 1);
  expectClosedLike(box(Vec3::Constant(0.01)), repaired);
}

TEST(MeshRepair, DropsDuplicateFacesWhicheverWayTheyFace) {
  TriangleMesh mesh = icosphere(0.02, 1);
  const TriangleMesh sound = mesh;
  mesh.triangles.push_back(mesh.triangles[5]);
  mesh.triangles.push_back({mesh.triangles[9][1], mesh.triangles[9][0], mesh.triangles[9][2]});
  EXPECT_EQ(inspect(mesh).duplicate_triangles, 2);
  const RepairedMesh repaired = repair(mesh);
  EXPECT_EQ(countOf(repaired, "dropped-duplicate-faces"), 2);
  expectSame(repaired.mesh, sound);
}

TEST(MeshRepair, OpensAWallBetweenTwoCells) {
  TriangleMesh mesh = box(Vec3::Constant(0.01));  // its right face, both ways: a wall towards a second box
  append(mesh, box(Vec3::Constant(0.01)), {0.02, 0, 0});
  const RepairedMesh repaired = repair(soup(mesh));
  const MeshReport report = inspect(repaired.mesh);
  EXPECT_TRUE(report.closed) << changesOf(repaired);
  EXPECT_NEAR(report.volume, 2 * 8e-6, 1e-18);
}

TEST(MeshRepair, OrientsWhatFacesTheOtherWay) {
  TriangleMesh mesh = icosphere(0.02, 2);
  const TriangleMesh sound = mesh;
  std::mt19937 random(3);
  for (auto& t : mesh.triangles) {
    if (random() % 3 == 0) std::swap(t[1], t[2]);
  }
  expectSame(repair(mesh).mesh, sound);
  const RepairedMesh turned = repair(insideOut(sound));
  EXPECT_EQ(countOf(turned, "turned-pieces"), 320);
  expectClosedLike(sound, turned);
}

TEST(MeshRepair, TurnsPiecesOnTheirOwn) {
  TriangleMesh mesh = icosphere(0.01, 1);
  append(mesh, insideOut(icosphere(0.005, 1)), {0.05, 0, 0});
  const MeshReport report = inspect(mesh);
  ASSERT_FALSE(report.isFit()) << "the larger one's volume must not hide the smaller one's";
  EXPECT_EQ(report.findings.front().name, "flipped-component");
  EXPECT_THROW(requireClosed(mesh), InputError);
  EXPECT_EQ(countOf(repair(mesh), "turned-pieces"), 80);
  EXPECT_TRUE(inspect(repair(mesh).mesh).isFit());
}

TEST(MeshRepair, NormalsOfTheFileTurnWithTheirTriangle) {
  TriangleMesh mesh = icosphere(0.02, 1);
  for (const Vec3& v : mesh.vertices) mesh.normals.push_back(-v.normalized());
  for (auto& t : mesh.triangles) std::swap(t[1], t[2]);
  mesh.triangle_normals = mesh.triangles;
  const TriangleMesh repaired = repair(mesh).mesh;
  for (std::size_t t = 0; t < repaired.triangles.size(); ++t) {
    for (std::size_t i = 0; i < 3; ++i) {
      const Vec3& p = repaired.vertices[static_cast<std::size_t>(repaired.triangles[t][i])];
      EXPECT_GT(repaired.normals[static_cast<std::size_t>(repaired.triangle_normals[t][i])].dot(p), 0);
    }
  }
}

TEST(MeshRepair, SplitsAVertexWherePiecesTouch) {
  TriangleMesh mesh = box(Vec3::Constant(0.01));
  append(mesh, box(Vec3::Constant(0.01)), {0.02, 0.02, 0.02});
  for (auto& t : mesh.triangles) {
    for (auto& v : t) v = v == 8 ? 7 : v;  // the corner that both have is one vertex
  }
  ASSERT_EQ(inspect(mesh).nonmanifold_vertices, 1);
  const RepairedMesh repaired = repair(mesh);
  EXPECT_EQ(countOf(repaired, "split-vertices"), 1);
  EXPECT_TRUE(inspect(repaired.mesh).isFit()) << changesOf(repaired);
}

TEST(MeshRepair, CutsAnEdgeWhereFourTrianglesMeet) {
  TriangleMesh mesh = box(Vec3::Constant(0.01));
  append(mesh, box(Vec3::Constant(0.01)), {0.02, 0.02, 0});  // two cubes with an edge in common
  for (auto& t : mesh.triangles) {
    for (auto& v : t) v = v == 8 ? 3 : v == 12 ? 7 : v;
  }
  ASSERT_EQ(inspect(mesh).nonmanifold_edges, 1);
  const RepairedMesh repaired = repair(mesh);
  const MeshReport report = inspect(repaired.mesh);
  EXPECT_TRUE(report.isFit()) << changesOf(repaired);
  EXPECT_EQ(report.components, 2);
  EXPECT_NEAR(report.volume, 16e-6, 1e-18);
}

TEST(MeshRepair, FillsHolesOfTheSizeAskedFor) {
  TriangleMesh mesh = box(Vec3::Constant(0.02));
  const double volume = inspect(mesh).volume;
  mesh.triangles.erase(mesh.triangles.begin(), mesh.triangles.begin() + 2);  // the whole bottom: a rim of four edges
  EXPECT_TRUE(repair(mesh).changes.empty()) << "only if asked";
  EXPECT_TRUE(repair(mesh, {.fill_holes = 3}).changes.empty()) << "too large";
  const RepairedMesh repaired = repair(mesh, {.fill_holes = 4});
  EXPECT_EQ(countOf(repaired, "filled-holes"), 1);
  EXPECT_NEAR(inspect(repaired.mesh).volume, volume, 1e-18);
  EXPECT_TRUE(inspect(repaired.mesh).isFit());
}

TEST(MeshRepair, LeavesAHoleThatIsNotFlat) {
  TriangleMesh mesh = cylinder(0.02, 0.03, 20, 3);
  const auto top = static_cast<std::int32_t>(mesh.vertices.size()) - 1;
  std::erase_if(mesh.triangles, [&](const auto& t) { return t[0] == top || t[1] == top || t[2] == top; });
  const RepairedMesh flat = repair(mesh, {.fill_holes = 20});
  EXPECT_EQ(countOf(flat, "filled-holes"), 1);
  expectClosedLike(cylinder(0.02, 0.03, 20, 3), flat);
  // a saddle, as high as the rim is wide
  for (Vec3& v : mesh.vertices) v.z() += 0.02 * std::cos(2 * std::atan2(v.y(), v.x()));
  EXPECT_EQ(countOf(repair(mesh, {.fill_holes = 20}), "filled-holes"), 0);
}

// Each triangle has its smoothing group, whatever is dropped, turned or added.
TEST(MeshRepair, SmoothingGroupsStayWithTheirTriangles) {
  TriangleMesh mesh = box(Vec3::Constant(0.02));
  for (std::size_t t = 0; t < 12; ++t) mesh.smoothing_groups.push_back(static_cast<std::int32_t>(t / 2 + 1));
  mesh.triangles.push_back(mesh.triangles[5]);
  mesh.smoothing_groups.push_back(9);
  mesh.triangles.erase(mesh.triangles.begin(), mesh.triangles.begin() + 2);
  mesh.smoothing_groups.erase(mesh.smoothing_groups.begin(), mesh.smoothing_groups.begin() + 2);
  const RepairedMesh repaired = repair(mesh, {.fill_holes = 4});
  const std::vector<std::int32_t> expected = {2, 2, 3, 3, 4, 4,
                                              // the duplicate's is gone, the bottom has one of its own
                                              5, 5, 6, 6, 7, 7};
  EXPECT_EQ(repaired.mesh.smoothing_groups, expected);
  EXPECT_EQ(inspect(repaired.mesh).crease_edges, 12);
}

TEST(MeshRepair, RefusesOptionsOutOfRange) {
  EXPECT_THROW(repair(icosphere(0.02, 0), {.weld = -1}), InputError);
  EXPECT_THROW(repair(icosphere(0.02, 0), {.fill_holes = 1001}), InputError);
}

// Files as people have them: holes, a doubled face, seams. Only rims of holes are asked for; where
// parts pass through each other they still do.
TEST(MeshRepair, MakesRealMeshesFit) {
  const auto folder = std::filesystem::path(PINCER_SOURCE_DIR).parent_path() / "shared" / "data" / "meshes";
  if (!std::filesystem::exists(folder)) GTEST_SKIP() << "the shared meshes aren't beside this checkout";
  for (const char* name : {"stanford-bunny.obj", "suzanne.obj", "teapot.obj"}) {
    TriangleMesh mesh = readMesh(folder / name);
    const MeshReport before = inspect(mesh);
    EXPECT_FALSE(before.isFit()) << name;
    const double scale = 0.08 / (before.box_max - before.box_min).maxCoeff();
    for (Vec3& v : mesh.vertices) v *= scale;
    const RepairedMesh repaired = repair(mesh, {.fill_holes = 80});
    EXPECT_TRUE(inspect(repaired.mesh).isFit()) << name << "\n" << changesOf(repaired);
    EXPECT_NO_THROW(requireClosed(repaired.mesh)) << name;
  }
}

// Total: whatever the damage, it comes back, and a second repair finds nothing left that it can do.
TEST(MeshRepair, SurvivesRandomDamageAndIsDoneAfterOnePass) {
  std::mt19937 random(7);
  int undone = 0;
  for (int run = 0; run < 300; ++run) {
    TriangleMesh mesh = random() % 2 ? icosphere(0.02, 1) : cylinder(0.02, 0.03, 8, 2);
    for (int damage = 0; damage < 6; ++damage) {
      auto& t = mesh.triangles[random() % mesh.triangles.size()];
      const auto any = static_cast<std::int32_t>(random() % mesh.vertices.size());
      switch (random() % 5) {
        case 0:
          t[random() % 3] = any;
          break;
        case 1:
          std::swap(t[0], t[1]);
          break;
        case 2:
          mesh.triangles.push_back(std::array<std::int32_t, 3>(t));
          break;
        case 3:
          mesh.vertices[static_cast<std::size_t>(any)] = mesh.vertices[static_cast<std::size_t>(t[0])];
          break;
        default:
          mesh.triangles.pop_back();
      }
    }
    inspect(mesh);
    const RepairedMesh once = repair(mesh, {.fill_holes = 10});
    for (const auto& t : once.mesh.triangles) {
      for (const std::int32_t v : t) ASSERT_TRUE(v >= 0 && v < static_cast<std::int32_t>(once.mesh.vertices.size()));
    }
    const MeshReport report = inspect(once.mesh);
    EXPECT_EQ(report.unused_vertices, 0);
    undone += !repair(once.mesh, {.fill_holes = 10}).changes.empty();
  }
  EXPECT_LT(undone, 100) << "one repair may lay another fault bare, but mostly doesn't";
}

}  // namespace
}  // namespace pincer::contact
