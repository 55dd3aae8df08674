// Named parts of OBJ files, as several programs write them.
#include <fmt/format.h>
#include <gtest/gtest.h>

#include "pincer/contact/mesh/convex_pieces.h"
#include "pincer/contact/mesh/mesh_groups.h"
#include "pincer/contact/mesh_report.h"
#include "pincer/tests/support/error_of.h"

namespace pincer::contact {
namespace {

std::vector<MeshGroup> groupsOf(const std::string& text) { return parseMeshGroups(text, MeshFormat::obj, "a.obj"); }

std::string verticesOfCube(double x) {
  std::string text;
  for (int k = 0; k < 8; ++k) text += fmt::format("v {} {} {}\n", x + (k & 1), (k >> 1) & 1, k >> 2);
  return text;
}

// Quads of a cube whose vertices begin behind `before`; `sides`: so many of its six.
std::string facesOfCube(int before, std::size_t sides = 6) {
  constexpr std::array<std::array<int, 4>, 6> kSides = {
      {{1, 3, 4, 2}, {5, 6, 8, 7}, {1, 2, 6, 5}, {3, 7, 8, 4}, {1, 5, 7, 3}, {2, 4, 8, 6}}};
  std::string text;
  for (std::size_t i = 0; i < sides; ++i) {
    const auto& [a, b, c, d] = kSides[i];
    text += fmt::format("f {} {} {} {}\n", a + before, b + before, c + before, d + before);
  }
  return text;
}

std::string cube(int number) { return verticesOfCube(2 * number) + facesOfCube(8 * number); }

std::string namesOf(const std::vector<MeshGroup>& groups) {
  std::string names;
  for (const MeshGroup& group : groups) names += fmt::format("{}:{} ", group.name, group.mesh.triangles.size());
  return names;
}

// Blender: each object's vertices before its faces; with "Material Groups" a group per object and material.
TEST(MeshGroups, ObjectsArePartsWhateverTheirGroups) {
  const std::vector<MeshGroup> groups =
      groupsOf("# Blender 3.6.5\nmtllib a.mtl\no Cup\n" + verticesOfCube(0) + "s 0\ng Cup_Cube_Red\nusemtl Red\n" +
               facesOfCube(0, 2) + "g Cup_Cube_Blue\nusemtl Blue\nf 1 2 6 5\nf 3 7 8 4\nf 1 5 7 3\nf 2 4 8 6\n" +
               "o Handle.001\n" + cube(1) + "o Empty\n");
  ASSERT_EQ(namesOf(groups), "Cup:12 Handle.001:12 ");
  EXPECT_EQ(groups[1].mesh.vertices.size(), 8u);
  EXPECT_EQ(groups[1].mesh.vertices[0], Vec3(2, 0, 0));
  EXPECT_NO_THROW(requireClosed(groups[1].mesh));
}

// Maya: all vertices of an object in "g default", which has no faces; several names in a line.
TEST(MeshGroups, GroupsArePartsWhereThereAreNoObjects) {
  const std::string text = "g default\n" + verticesOfCube(0) + "s off\ng pCube1 left side\n" + facesOfCube(0) +
                           "g default\n" + verticesOfCube(2) + "g pCube2\n" + facesOfCube(8);
  EXPECT_EQ(namesOf(groupsOf(text)), "pCube1 left side:12 pCube2:12 ");
}

TEST(MeshGroups, ANameThatComesAgainGoesOnWithItsPart) {
  const std::string text =
      verticesOfCube(0) + "g a\n" + facesOfCube(0, 3) + "g b\nf 3 7 8 4\ng a\nf 1 5 7 3\nf 2 4 8 6\n";
  EXPECT_EQ(namesOf(groupsOf(text)), "a:10 b:2 ");
}

TEST(MeshGroups, FacesBeforeTheFirstNameAreThePartDefault) {
  EXPECT_EQ(namesOf(groupsOf(cube(0) + "o b\n" + cube(1))), "default:12 b:12 ");
}

// Parts that share vertices, as one object cut by faces, get each their own.
TEST(MeshGroups, SharedVerticesAreEachPartsOwn) {
  const std::vector<MeshGroup> groups =
      groupsOf(verticesOfCube(0) + "g low\nf 1 3 4 2\ng high\nf 5 6 8 7\nf 1 2 6 5\n");
  ASSERT_EQ(groups.size(), 2u);
  EXPECT_EQ(groups[0].mesh.vertices.size(), 4u);
  EXPECT_EQ(groups[1].mesh.vertices.size(), 6u);
}

TEST(MeshGroups, NormalsAndSmoothingGroupsGoWithTheirTriangles) {
  const std::vector<MeshGroup> groups = groupsOf(
      "v 0 0 0\nv 1 0 0\nv 0 1 0\nv 0 0 1\nvn 0 0 1\nvn 1 0 0\ns 3\no a\nf 1//1 2//1 3//1\no b\ns 7\nf 2//2 3//2 4//2\n"
      "f 1 2 3\n");
  ASSERT_EQ(groups.size(), 2u);
  const TriangleMesh& b = groups[1].mesh;
  ASSERT_EQ(b.normals.size(), 1u);
  EXPECT_EQ(b.normals[0], Vec3(1, 0, 0));
  EXPECT_EQ(b.triangle_normals[0], (std::array<std::int32_t, 3>{0, 0, 0}));
  EXPECT_EQ(b.triangle_normals[1], (std::array<std::int32_t, 3>{-1, -1, -1}));
  EXPECT_EQ(b.smoothing_groups, (std::vector<std::int32_t>{7, 7}));
  EXPECT_EQ(groups[0].mesh.smoothing_groups, (std::vector<std::int32_t>{3}));
}

TEST(MeshGroups, SayWhatIsWrongWithThem) {
  EXPECT_EQ(
      tests::errorOf([] { groupsOf(cube(0)); }),
      "a.obj: none of its faces stands under a name (\"o\" or \"g\"), so it has no parts. Export each solid as an "
      "object of its own.");
  EXPECT_EQ(tests::errorOf([] { groupsOf("o a\n" + verticesOfCube(0) + "g\n" + facesOfCube(0, 1) + "f 1 2 9\n"); }),
            "a.obj:12: face 2 uses vertex 9, but the file has 8 (from 1). The file is cut off or was joined by hand; "
            "export it again.");
  const std::string off = "OFF\n3 1 0\n0 0 0\n1 0 0\n0 1 0\n3 0 1 2\n";
  EXPECT_EQ(tests::errorOf([&] { parseMeshGroups(off, MeshFormat::off, "a.off"); }),
            "a.off: OFF files give their parts no names; only OBJ does. Export it as OBJ.");
  std::string many = "v 0 0 0\nv 1 0 0\nv 0 1 0\n";
  for (int i = 0; i <= 10000; ++i) many += fmt::format("o {}\nf 1 2 3\n", i);
  EXPECT_EQ(tests::errorOf([&] { groupsOf(many); }), "a.obj: it has more than 10000 named parts. Join some of them.");
}

// An open box has the hull of a closed one. A dent of a tenth of the size is not filled in silently; one of 0.5 % is.
TEST(MeshGroups, HullsAreOfConvexPartsOnly) {
  EXPECT_EQ(hullsOfGroups(groupsOf(verticesOfCube(0) + "o tray\n" + facesOfCube(0, 5)))[0]->faces().size(), 6u);
  const auto notched = [](double depth) {
    return groupsOf("o ok\n" + cube(0) + fmt::format("v 3 0.5 {}\n", 1 - depth) + "o notched\n" + verticesOfCube(2.5) +
                    "f 10 12 13 11\nf 14 15 17 16\nf 10 11 15 14\nf 9 17 16\n");
  };
  EXPECT_EQ(hullsOfGroups(notched(0.005)).size(), 2u);
  EXPECT_EQ(
      tests::errorOf([&] { hullsOfGroups(notched(0.1)); }),
      "a.obj, part \"notched\" isn't convex: its vertex at (3, 0.5, 0.9) m lies 100 mm inside its hull. Cut it into "
      "convex parts, or make it a shape of its own: {\"type\": \"mesh\", \"part\": ..}.");
}

}  // namespace
}  // namespace pincer::contact
