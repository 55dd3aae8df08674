#include <gtest/gtest.h>

#include <cstring>
#include <limits>
#include <sstream>

#include "pincer/contact/mesh_reader.h"

namespace pincer::contact {
namespace {

TriangleMesh read(const std::string& text, double scale = 1) {
  return parseMesh(text, MeshFormat::obj, "part.obj", {.metres_per_unit = scale});
}

std::string errorOf(const std::string& text) {
  try {
    read(text);
  } catch (const InputError& error) {
    return error.what();
  }
  return "(no error)";
}

const std::string kTriangle = "v 0 0 0\nv 1 0 0\nv 0 1 0\n";  // lines 1 to 3

TEST(ObjReader, ScalesCoordinatesToMetres) {
  const TriangleMesh mesh = read("v 0 0 0\nv 10 0 0\nv 0 20 5\nf 1 2 3\n", metresPerUnit("mm"));
  EXPECT_EQ(mesh.vertices[1], Vec3(0.01, 0, 0));
  EXPECT_EQ(mesh.vertices[2], Vec3(0.02 * 0, 0.02, 0.005));
}

TEST(ObjReader, KnowsFourUnits) {
  EXPECT_EQ(metresPerUnit("m"), 1);
  EXPECT_EQ(metresPerUnit("cm"), 0.01);
  EXPECT_EQ(metresPerUnit("mm"), 0.001);
  EXPECT_EQ(metresPerUnit("in"), 0.0254);
  EXPECT_THROW(metresPerUnit("furlong"), InputError);
  EXPECT_THROW(metresPerUnit(""), InputError);
}

TEST(ObjReader, ReadsEveryFormOfACorner) {
  const std::string head = kTriangle + "vt 0 0\nvt 1 0\nvt 0 1\nvn 0 0 2\nvn 0 0 1\nvn 0 1 1\n";
  for (const char* face : {"f 1 2 3\n", "f 1/1 2/2 3/3\n", "f 1//1 2//2 3//3\n", "f 1/1/1 2/2/2 3/3/3\n",
                           "f -3 -2 -1\n", "f -3/-3/-3 -2/-2/-2 -1/-1/-1\n", "f +1 +2 +3\n"}) {
    const TriangleMesh mesh = read(head + face);
    ASSERT_EQ(mesh.triangles.size(), 1u) << face;
    EXPECT_EQ(mesh.triangles[0], (std::array<std::int32_t, 3>{0, 1, 2})) << face;
    const bool has_normals =
        std::string(face).find("//") != std::string::npos || std::count(face, face + std::strlen(face), '/') == 6;
    EXPECT_EQ(mesh.triangle_normals.size(), has_normals ? 1u : 0u) << face;
  }
  EXPECT_EQ(read(head + "f 1//1 2//2 3//3\n").normals[0], Vec3(0, 0, 1)) << "normals are of unit length";
}

TEST(ObjReader, AcceptsTheRestOfTheFormat) {
  const TriangleMesh mesh = read(
      "\xEF\xBB\xBF# comment\r\nmtllib a.mtl\r\no part\r\ng side\r\ns 1\r\nusemtl red\r\n"
      "v 0 0 0 1\r\nv 1 0 0 0.5 0.5 0.5\r\n\tv  0   1 0\t# trailing\r\nvt 0.5\r\nl 1 2\r\np 1\r\nf 1 2 \\\r\n 3");
  EXPECT_EQ(mesh.triangles.size(), 1u);
  EXPECT_EQ(mesh.vertices.size(), 3u);
}

TEST(ObjReader, KeepsSmoothingGroupsOfTriangles) {
  const std::string head = kTriangle + "v 1 1 0\n";
  EXPECT_EQ(read(head + "f 1 2 3\ns 2\nf 2 4 3\ns off\nf 1 2 4 3\n").smoothing_groups,
            (std::vector<std::int32_t>{0, 2, 0, 0}));
  EXPECT_TRUE(read(head + "s off\nf 1 2 3\ns 0\nf 2 4 3\n").smoothing_groups.empty())
      << "programs write it for want of groups";
  EXPECT_TRUE(read(head + "f 1 2 3\ns 1\n").smoothing_groups.empty()) << "no face is in it";
}

TEST(ObjReader, LetsAFaceUseAVertexThatFollows) { EXPECT_EQ(read("f 1 2 3\n" + kTriangle).triangles.size(), 1u); }

TEST(ObjReader, KeepsCornersWithoutNormalApart) {
  const TriangleMesh mesh = read(kTriangle + "v 0 0 1\nvn 0 0 1\nf 1//1 2//1 3//1\nf 1 2 4\n");
  ASSERT_EQ(mesh.triangle_normals.size(), 2u);
  EXPECT_EQ(mesh.triangle_normals[0], (std::array<std::int32_t, 3>{0, 0, 0}));
  EXPECT_EQ(mesh.triangle_normals[1], (std::array<std::int32_t, 3>{-1, -1, -1}));
}

double areaOf(const TriangleMesh& mesh) {  // with sign, along z
  double area = 0;
  for (const auto& [a, b, c] : mesh.triangles) {
    const auto at = [&](std::int32_t i) { return mesh.vertices[static_cast<std::size_t>(i)]; };
    const double part = 0.5 * (at(b) - at(a)).cross(at(c) - at(a)).z();
    EXPECT_GT(part, 0) << "a piece is turned over or empty";
    area += part;
  }
  return area;
}

// Any triangulation of a simple polygon has n - 2 pieces, all turned the same way, that fill it exactly.
TEST(ObjReader, FillsPolygons) {
  struct Case {
    const char* name;
    std::vector<Vec2> corners;
    double area;
  };
  const std::vector<Case> cases = {
      {"square", {{0, 0}, {1, 0}, {1, 1}, {0, 1}}, 1},
      {"L", {{0, 0}, {2, 0}, {2, 1}, {1, 1}, {1, 2}, {0, 2}}, 3},
      {"arrow head", {{0, 0}, {2, -1}, {1, 0}, {2, 1}}, 1},
      {"corner on an edge", {{0, 0}, {0.5, 0}, {1, 0}, {1, 1}, {0, 1}}, 1},
      {"comb", {{0, 0}, {5, 0}, {5, 2}, {4, 2}, {4, 1}, {3, 1}, {3, 2}, {2, 2}, {2, 1}, {1, 1}, {1, 2}, {0, 2}}, 8},
  };
  for (const Case& c : cases) {
    for (std::size_t first = 0; first < c.corners.size(); ++first) {  // whichever corner the file begins with
      std::ostringstream text;
      for (const Vec2& p : c.corners) text << "v " << p.x() << ' ' << p.y() << " 0\n";
      text << 'f';
      for (std::size_t i = 0; i < c.corners.size(); ++i) text << ' ' << (first + i) % c.corners.size() + 1;
      const TriangleMesh mesh = read(text.str() + "\n");
      EXPECT_EQ(mesh.triangles.size(), c.corners.size() - 2) << c.name;
      EXPECT_NEAR(areaOf(mesh), c.area, 1e-14) << c.name;  // sums of a dozen numbers of about 1
    }
  }
}

TEST(ObjReader, NamesEveryDefectWithItsLine) {
  struct Case {
    std::string text;
    std::vector<const char*> expected;  // parts of the message
  };
  const std::vector<Case> cases = {
      {"", {"part.obj", "empty"}},
      {"# nothing\n", {"part.obj", "0 vertices", "no face"}},
      {"\xFF\xFEv", {"part.obj", "UTF-16"}},
      {"v 0 0 1\xC3\xA9\n", {":1:", "z = \"1??\"", "ASCII"}},
      {std::string(70000, 'v'), {":1:", "longer than 65536 bytes"}},
      {kTriangle + "s\nf 1 2 3\n", {":4:", "smoothing group"}},
      {kTriangle + "s -1\nf 1 2 3\n", {":4:", "smoothing group -1", "range"}},
      {kTriangle + "s smooth\nf 1 2 3\n", {":4:", "\"smooth\""}},
      {kTriangle, {"3 vertices", "no face"}},
      {"v 0 0 nan\n", {"part.obj:1:", "z = \"nan\"", "finite"}},
      {"v inf 0 0\n", {":1:", "x = \"inf\"", "finite"}},
      {"v 0 1e999 0\n", {":1:", "y = \"1e999\"", "range"}},
      {"v 0 0,5 0\n", {":1:", "y = \"0,5\"", "not a number"}},
      {"v 0 0 0x10\n", {":1:", "z = \"0x10\"", "not a number"}},
      {"v 0 --1 0\n", {"not a number"}},
      {"v 0 0\n", {":1:", "vertex 1 has 2 numbers"}},
      {"v 0 0 0 0 0\n", {":1:", "vertex 1 has 5 numbers"}},
      {"v 0 0 0 0.5\n", {":1:", "weight 0.5"}},
      {"v 0 0 5000\n", {":1:", "5e+03 m", "unit"}},
      {kTriangle + "vn 0 0\nf 1 2 3\n", {":4:", "normal 1 has 2"}},
      {kTriangle + "vn 0 0 0\nf 1 2 3\n", {":4:", "normal 1 is zero"}},
      {kTriangle + "vt\nf 1 2 3\n", {":4:", "texture"}},
      {kTriangle + "f 1 2\n", {":4:", "face 1 has 2 corners"}},
      {kTriangle + "f\n", {":4:", "face 1 has 0 corners"}},
      {kTriangle + "f 1 2 4\n", {":4:", "face 1 uses vertex 4", "the file has 3", "cut off"}},
      {kTriangle + "f 1 2 3\nf 0 1 2\n", {":5:", "vertex 0", "begin at 1"}},
      {kTriangle + "f -4 -2 -1\n", {":4:", "vertex -4", "only 3 before it"}},
      {kTriangle + "f 1 2 3.5\n", {":4:", "\"3.5\"", "whole number"}},
      {kTriangle + "f 1 2 99999999999\n", {":4:", "99999999999", "out of range"}},
      {kTriangle + "f 1 2 3/\n", {":4:", "\"3/\"", "slash"}},
      {kTriangle + "f 1 2 3//\n", {":4:", "\"3//\"", "slash"}},
      {kTriangle + "f 1 2 /3\n", {":4:", "whole number"}},
      {kTriangle + "vt 0 0\nvn 0 0 1\nf 1/1/1/1 2 3\n", {":6:", "more than three parts"}},
      {kTriangle + "vn 0 0 1\nf 1//1 2//1 3\n", {":5:", "\"3\"", "unlike"}},
      {kTriangle + "f 1//1 2//1 3//1\n", {":4:", "normal 1", "the file has 0"}},
      {kTriangle + "f 1/7 2/7 3/7\n", {":4:", "texture coordinate 7", "the file has 0"}},
      {kTriangle + "f 1 2 2\n", {":4:", "face 1 uses vertex 2 at (1, 0, 0) m twice"}},
      {kTriangle + "v 2 0 0\nf 1 2 3\nf 1 2 4\n", {":6:", "face 2 has zero area", "1, 2 and 4", "Delete"}},
      {kTriangle + "v 0 0 0\nf 1 2 4\n", {":5:", "zero area"}},
      {"v 0 0 0\nv 1 1 0\nv 1 0 0\nv 0 1 0\nf 1 2 3 4\n", {":5:", "4 corners", "crosses itself"}},
      {kTriangle + "curv 0 1 1 2\nf 1 2 3\n", {":4:", "free-form"}},
      {"solid part\nfacet normal 0 0 1\n", {":1:", "\"solid\"", "not a keyword", "OBJ"}},
      {std::string("\x7f\x45LF\0\1\2", 7), {":1:", "a NUL byte", "export it again"}},
      {kTriangle + "f 1 2 3\nf 1 2", {":5:", "2 corners", "ends in the middle of this line"}},
      {kTriangle + "f 1 \\\n 2 \\\n x\n", {":4:", "\"x\""}},
  };
  for (const Case& c : cases) {
    const std::string error = errorOf(c.text);
    for (const char* part : c.expected)
      EXPECT_NE(error.find(part), std::string::npos) << c.text << "\n-> " << error << "\nlacks " << part;
  }
}

TEST(ObjReader, RefusesAbsurdPolygons) {
  std::string text = kTriangle + "f";
  for (int i = 0; i < 2000; ++i) text += " 1";
  EXPECT_NE(errorOf(text + "\n").find("2000 corners"), std::string::npos);
}

TEST(ObjReader, RefusesMoreTrianglesThanAFingerNeeds) {
  std::string text = kTriangle;
  for (int i = 0; i < 2'000'001; ++i) text += "f 1 2 3\n";
  EXPECT_NE(errorOf(text).find("2000000 triangles"), std::string::npos);
}

TEST(ObjReader, ChecksTheScale) {
  for (const double scale : {0.0, -1.0, std::nan(""), std::numeric_limits<double>::infinity()})
    EXPECT_THROW(read(kTriangle + "f 1 2 3\n", scale), InputError);
}

}  // namespace
}  // namespace pincer::contact
