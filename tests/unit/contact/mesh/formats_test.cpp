#include <fmt/format.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <bit>
#include <cstring>
#include <fstream>
#include <limits>

#include "pincer/contact/mesh_reader.h"
#include "pincer/tests/support/temporary_directory.h"

namespace pincer::contact {
namespace {

TriangleMesh read(const std::string& bytes, MeshFormat format, const ReadOptions& options = {}) {
  return parseMesh(bytes, format, "part", options);
}

std::string errorOf(const std::string& bytes, MeshFormat format) {
  try {
    read(bytes, format);
  } catch (const InputError& error) {
    return error.what();
  }
  return "(no error)";
}

struct Defect {
  std::string bytes;
  std::vector<std::string> expected;  // parts of the message
};

void expectMessages(MeshFormat format, const std::vector<Defect>& defects) {
  for (const Defect& defect : defects) {
    const std::string error = errorOf(defect.bytes, format);
    EXPECT_TRUE(error.starts_with("part:")) << defect.bytes;
    for (const std::string& part : defect.expected)
      EXPECT_NE(error.find(part), std::string::npos) << defect.bytes << "\n-> " << error << "\nlacks " << part;
  }
}

template <typename T>
std::string bytesOf(T value, std::endian order = std::endian::little) {
  std::string raw(sizeof(T), '\0');
  std::memcpy(raw.data(), &value, sizeof(T));
  if (order != std::endian::native) std::reverse(raw.begin(), raw.end());
  return raw;
}

// A tetrahedron with its right angle at the origin, in whole numbers that every type of every format holds exactly.
const std::vector<Vec3> kVertices = {{0, 0, 0}, {1, 0, 0}, {0, 2, 0}, {0, 0, 3}};
const std::vector<std::array<std::int32_t, 3>> kTriangles = {{0, 2, 1}, {0, 1, 3}, {0, 3, 2}, {1, 2, 3}};

void expectTetrahedron(const TriangleMesh& mesh, const char* what) {
  EXPECT_EQ(mesh.vertices, kVertices) << what;
  EXPECT_EQ(mesh.triangles, kTriangles) << what;
}

// As STL meets them: vertices numbered as they first appear.
void expectStlTetrahedron(const TriangleMesh& mesh, const char* what) {
  EXPECT_EQ(mesh.vertices, (std::vector<Vec3>{kVertices[0], kVertices[2], kVertices[1], kVertices[3]})) << what;
  EXPECT_EQ(mesh.triangles, (std::vector<std::array<std::int32_t, 3>>{{0, 1, 2}, {0, 2, 3}, {0, 3, 1}, {2, 1, 3}}))
      << what;
}

// STL
// ---------------------------------------------------------------------------------------------------------------------

// 7 lines
const std::string kFacet =
    "facet normal 0 0 1\nouter loop\nvertex 0 0 0\nvertex 1 0 0\nvertex 0 1 0\nendloop\nendfacet\n";

std::string stlText() {
  std::string text = "solid a tetrahedron\n";
  for (const auto& triangle : kTriangles) {
    text += "  FACET NORMAL nan nan nan\r\n    outer loop\r\n";
    for (const std::int32_t v : triangle) {
      const Vec3& p = kVertices[static_cast<std::size_t>(v)];
      text += fmt::format("      vertex {} {:e} {:+}\r\n", p.x(), p.y(), p.z());
    }
    text += "    endloop\r\n  endfacet\r\n";
  }
  return text + "endsolid";
}

std::string stlBinary(const std::string& header) {
  std::string bytes = header;
  bytes.resize(80, ' ');
  bytes += bytesOf(static_cast<std::uint32_t>(kTriangles.size()));
  for (const auto& triangle : kTriangles) {
    for (int i = 0; i < 3; ++i) bytes += bytesOf(std::numeric_limits<float>::quiet_NaN());
    for (const std::int32_t v : triangle) {
      for (int i = 0; i < 3; ++i) bytes += bytesOf(static_cast<float>(kVertices[static_cast<std::size_t>(v)][i]));
    }
    bytes += bytesOf(std::uint16_t{0x7fff});
  }
  return bytes;
}

std::string withFloatAt(std::string bytes, std::size_t at, float value) { return bytes.replace(at, 4, bytesOf(value)); }

TEST(StlReader, MakesOneVertexOfEqualPositions) {
  expectStlTetrahedron(read(stlBinary("made by hand"), MeshFormat::stl), "binary");
  expectStlTetrahedron(read(stlText(), MeshFormat::stl), "ascii");
}

TEST(StlReader, TakesZeroOfEitherSignForOnePosition) {
  const TriangleMesh mesh = read("solid\n" + kFacet +
                                     "facet normal 0 0 1\nouter loop\nvertex -0 0 0\nvertex 0 1 -0.0\nvertex -1 0 "
                                     "0\nendloop\nendfacet\nendsolid\n",
                                 MeshFormat::stl);
  EXPECT_EQ(mesh.vertices.size(), 4u);
  EXPECT_EQ(mesh.triangles[1], (std::array<std::int32_t, 3>{0, 2, 3}));
}

TEST(StlReader, ReadsABinaryFileWhoseHeaderBeginsWithSolid) {
  expectStlTetrahedron(read(stlBinary("solid part\nfacet normal 0 0 1\n"), MeshFormat::stl), "header in blanks");
  expectStlTetrahedron(read(stlBinary(std::string("solid\0", 6)), MeshFormat::stl), "header with a zero");
}

TEST(StlReader, ReadsSeveralSolidsAsOneMesh) {
  const TriangleMesh mesh = read(
      "solid a\n" + kFacet + "endsolid a\nsolid empty\nendsolid\nsolid b\n" + kFacet + "endsolid b\n", MeshFormat::stl);
  EXPECT_EQ(mesh.triangles.size(), 2u);
  EXPECT_EQ(mesh.vertices.size(), 3u);
}

TEST(StlReader, NamesEveryDefectWithItsPlace) {
  const std::string whole = stlBinary("made by hand"), solid = "solid x\n";
  const auto tooMany = [&] {
    std::string bytes = whole;
    return bytes.replace(80, 4, bytesOf(std::uint32_t{0xffffffff}));
  };
  const std::string flat =
      "facet normal 0 0 1\nouter loop\nvertex 0 0 0\nvertex 1 0 0\nvertex 2 0 0\nendloop\nendfacet\n";
  const std::string twice =
      "facet normal 0 0 1\nouter loop\nvertex 0 0 0\nvertex 1 0 0\nvertex 0 0 0\nendloop\nendfacet\n";
  expectMessages(MeshFormat::stl,
                 {{"", {"empty"}},
                  {"not a mesh", {"10 bytes", "at least 84", "solid"}},
                  {std::string(84, '\0'), {"0 vertices", "no face"}},
                  {whole.substr(0, whole.size() - 1), {"4 triangles", "284 bytes", "has 283", "cut off"}},
                  {whole + "junk", {"284 bytes", "has 288", "follows after the last"}},
                  {tooMany(), {"4294967295 triangles", "cut off"}},
                  {withFloatAt(whole, 84 + 50 + 12 + 4, std::numeric_limits<float>::quiet_NaN()),
                   {"byte 150", "y of a corner of triangle 2", "nan", "finite"}},
                  {withFloatAt(whole, 84 + 12, -std::numeric_limits<float>::infinity()),
                   {"byte 96", "x of a corner of triangle 1", "-inf"}},
                  {withFloatAt(whole, 84 + 12, 2e3F), {"byte 96", "2e+03 m", "unit"}},
                  {solid + "endsolid\n", {"no face"}},
                  {solid + kFacet, {":8:", "no end", "endsolid", "cut off"}},
                  {solid + kFacet.substr(0, 60), {"cut off", "middle of this line"}},
                  {solid + "facet normal 0 0\n", {":2:", "\"facet\" and 3 more", "3 numbers"}},
                  {solid + "facet normal 0 0 1\nouter loop\nvertex 0 0 nan\n", {":4:", "z = \"nan\"", "finite"}},
                  {solid + "facet normal 0 0 1\nouter loop\nvertex 0 1e400 0\n", {":4:", "y = \"1e400\"", "range"}},
                  {solid + "facet normal 0 0 1\nouter loop\nvertex 0 0 0\nvertex 1 0 0\nendloop\n",
                   {":6:", "\"endloop\"", "\"vertex\"", "isn't a triangle"}},
                  {solid + "facet normal 0 0 1\nouter loop\nvertex 0 0 0\nvertex 1 0 0\nvertex 1 1 0\nvertex 0 1 0\n",
                   {":7:", "\"vertex\"", "\"endloop\""}},
                  {solid + flat + "endsolid\n", {":2:", "face 1 has zero area", "(2, 0, 0)", "Delete"}},
                  {solid + twice + "endsolid\n", {":2:", "face 1 uses vertex 1 at (0, 0, 0) m twice"}},
                  {solid + kFacet + "endsolid\njunk\n", {":10:", "\"junk\"", "solid should begin"}},
                  {solid + "facet normal 0 0 1\nouter loop\nvertex 0 0 1\xff\n", {":4:", "ASCII"}}});
}

// PLY
// ---------------------------------------------------------------------------------------------------------------------

const std::string kPlyVertices = "0 0 0\n1 0 0\n0 2 0\n0 0 3\n", kPlyFaces = "3 0 2 1\n3 0 1 3\n3 0 3 2\n3 1 2 3\n";

std::string plyHeader(const std::string& format = "ascii") {  // 10 lines
  return "ply\nformat " + format +
         " 1.0\ncomment by hand \xC3\xA9\nelement vertex 4\nproperty float x\nproperty float y\nproperty float z\n" +
         "element face 4\nproperty list uchar int vertex_indices\nend_header\n";
}

TEST(PlyReader, ReadsAscii) {
  expectTetrahedron(read(plyHeader() + kPlyVertices + kPlyFaces, MeshFormat::ply), "ascii");
}

// Types of all sizes, properties in another order, others between them, elements in another order and unknown ones.
struct Layout {
  const char* coordinate;
  const char* count;
  const char* index;
};

template <typename Coordinate, typename Count, typename Index>
std::string plyBinary(const Layout& types, std::endian order) {
  const auto raw = [&](auto value) { return bytesOf(value, order); };
  std::string bytes = std::string("ply\nformat binary_") + (order == std::endian::little ? "little" : "big") +
                      "_endian 1.0\nobj_info by hand\n";
  bytes += "element edge 2\nproperty int v1\nproperty list ushort double w\n";
  bytes += std::string("element face 4\nproperty uchar red\nproperty list ") + types.count + " " + types.index +
           " vertex_index\nproperty list int8 short tex\n";
  bytes += std::string("element vertex 4\nproperty ") + types.coordinate + " z\nproperty double quality\nproperty " +
           types.coordinate + " x\nproperty " + types.coordinate + " y\nend_header\n";
  for (int i = 0; i < 2; ++i)
    bytes += raw(std::int32_t{-1}) + raw(std::uint16_t{2}) + raw(1.5) + raw(std::numeric_limits<double>::quiet_NaN());
  for (const auto& triangle : kTriangles) {
    bytes += raw(std::uint8_t{255}) + raw(static_cast<Count>(3));
    for (const std::int32_t v : triangle) bytes += raw(static_cast<Index>(v));
    bytes += raw(std::int8_t{1}) + raw(std::int16_t{-7});
  }
  for (const Vec3& p : kVertices) {
    bytes += raw(static_cast<Coordinate>(p.z())) + raw(std::numeric_limits<double>::infinity()) +
             raw(static_cast<Coordinate>(p.x())) + raw(static_cast<Coordinate>(p.y()));
  }
  return bytes;
}

TEST(PlyReader, ReadsBothByteOrdersAndEveryType) {
  for (const std::endian order : {std::endian::little, std::endian::big}) {
    const auto expect = [&](const std::string& bytes, const char* what) {
      expectTetrahedron(read(bytes, MeshFormat::ply), what);
    };
    expect(plyBinary<float, std::uint8_t, std::int32_t>({"float", "uchar", "int"}, order), "float uchar int");
    expect(plyBinary<double, std::int8_t, std::uint32_t>({"float64", "int8", "uint32"}, order), "float64 int8 uint32");
    expect(plyBinary<std::int16_t, std::uint16_t, std::uint8_t>({"short", "ushort", "uchar"}, order),
           "short ushort uchar");
    expect(plyBinary<std::uint32_t, std::int16_t, std::int8_t>({"uint", "int16", "char"}, order), "uint int16 char");
    expect(plyBinary<std::int8_t, std::int32_t, std::uint16_t>({"char", "int32", "uint16"}, order),
           "char int32 uint16");
    expect(plyBinary<std::uint8_t, std::uint32_t, std::int16_t>({"uint8", "uint", "short"}, order), "uint8 uint short");
  }
}

TEST(PlyReader, MakesVertexNormalsCornerNormals) {
  const std::string header =
      "ply\r\nformat ascii 1.0\r\nelement vertex 4\r\nproperty float nx\r\nproperty float x\r\nproperty float "
      "y\r\nproperty float "
      "z\r\nproperty float ny\r\nproperty float nz\r\n"
      "element face 1\r\nproperty list uchar int vertex_indices\r\nend_header\r\n";
  const TriangleMesh mesh =
      read(header + "0 0 0 0 0 2\r\n0 1 0 0 0 1\r\n0 1 1 0 3 4\r\n0 0 1 0 0 1\r\n4 0 1 2 3", MeshFormat::ply);
  ASSERT_EQ(mesh.triangles.size(), 2u);
  EXPECT_EQ(mesh.triangle_normals, mesh.triangles);
  EXPECT_EQ(mesh.normals[0], Vec3(0, 0, 1)) << "of unit length";
  EXPECT_LE((mesh.normals[2] - Vec3(0, 0.6, 0.8)).norm(), 1e-15);
}

TEST(PlyReader, NamesEveryDefectWithItsPlace) {
  const auto header = [](const std::string& from, const std::string& to) {
    std::string text = plyHeader();
    return text.replace(text.find(from), from.size(), to) + kPlyVertices + kPlyFaces;
  };
  const std::string binary = plyBinary<float, std::int8_t, std::int32_t>({"float", "char", "int"}, std::endian::little);
  const std::size_t data = binary.find("end_header\n") + 11, faces = data + 2 * 22, vertices = binary.size() - 4 * 20;
  const auto damaged = [&](std::size_t at, const std::string& bytes) {
    std::string copy = binary;
    return copy.replace(at, bytes.size(), bytes);
  };
  const auto place = [](std::size_t at) { return "byte " + std::to_string(at) + ":"; };
  expectMessages(
      MeshFormat::ply,
      {{"", {"empty"}},
       {"plx\n", {":1:", "must be \"ply\""}},
       {"ply\n", {"no end", "end_header", "cut off"}},
       {header("format ascii 1.0", "format text 1.0"), {":2:", "\"text\"", "binary_little_endian"}},
       {header("format ascii 1.0", "format ascii 2.0"), {":2:", "\"2.0\""}},
       {header("format ascii 1.0\n", ""), {":3:", "format"}},
       {header("element vertex 4", "element vertex -4"), {":4:", "-4", "negative"}},
       {header("element vertex 4", "element vertex 4000000000"),
        {":4:", "4000000000 of \"vertex\"", "bytes that follow", "cut off"}},
       {header("element vertex 4", "element vertex four"), {":4:", "\"four\"", "whole number"}},
       {header("element vertex 4", "element vertex 5"), {":15:", "4 values", "\"vertex\" has only 3"}},
       {header("element vertex 4", "element vertices 4"), {":15:", "vertex 0", "has 0", "cut off"}},
       {header("element face 4", "element vertex 4"), {":8:", "twice"}},
       {header("element face 4", "element polygon 4"), {"4 vertices", "no face"}},
       {header("element face 4\nproperty list uchar int vertex_indices",
               "element tristrips 4\nproperty list uchar int strip"),
        {":8:", "\"tristrips\" has no list"}},
       {header("element face 4", "element face 99"), {":8:", "99 of \"face\""}},
       {header("property float z\n", ""), {":4:", "no property \"z\""}},
       {header("property float y", "property float x"), {":6:", "\"x\"", "twice"}},
       {header("property float z", "property float z\nproperty float nx"), {":4:", "some of nx, ny and nz"}},
       {header("property float z", "property quad z"), {":7:", "\"quad\"", "float64"}},
       {header("property float z", "property float"), {":7:", "type and its name"}},
       {header("list uchar int", "list float int"), {":9:", "\"float\"", "whole numbers"}},
       {header("list uchar int", "list uchar float"), {":8:", "vertex_indices", "whole numbers"}},
       {header("vertex_indices", "corners"), {":8:", "no list \"vertex_indices\""}},
       {header("comment", "remark"), {":3:", "\"remark\"", "keyword"}},
       {header("element face 4", "faces 4"), {":8:", "\"faces\"", "keyword"}},
       {header("end_header", "property float q\nend_header"), {"values"}},
       {plyHeader() + "0 0 nan\n1 0 0\n0 2 0\n0 0 3\n" + kPlyFaces, {":11:", "z = \"nan\"", "finite"}},
       {plyHeader() + "0 0\n1 0 0\n0 2 0\n0 0 3  \n" + kPlyFaces, {":11:", "2 values", "\"z\""}},
       {plyHeader() + "0 0 0 0\n1 0 0\n0 2 0\n0 0 3\n" + kPlyFaces, {":11:", "4 values", "only 3"}},
       {plyHeader() + kPlyVertices + "3 0 2 4\n" + kPlyFaces.substr(8),
        {":15:", "face 0 uses vertex 4", "has 4 (from 0)"}},
       {plyHeader() + kPlyVertices + "3 0 2 -1\n" + kPlyFaces.substr(8), {":15:", "face 0 uses vertex -1"}},
       {plyHeader() + kPlyVertices + "2 0 2\n" + kPlyFaces, {":15:", "face 0 has 2 corners"}},
       {plyHeader() + kPlyVertices + "-1 0 2\n" + kPlyFaces, {":15:", "face 0 has -1 corners"}},
       {plyHeader() + kPlyVertices + "9999 0 2 1\n" + kPlyFaces, {":15:", "9999 corners", "limit is 1000"}},
       {plyHeader() + kPlyVertices + "3 0 2 2\n" + kPlyFaces.substr(8), {":15:", "uses vertex 2 at (0, 2, 0) m twice"}},
       {plyHeader() + kPlyVertices + kPlyFaces.substr(0, 30), {":18:", "cut off"}},
       {plyHeader() + kPlyVertices + kPlyFaces.substr(0, 24) + "\n\n\n\n\n\n",
        {"entry 3 of 4 \"face\" is missing", "cut off"}},
       {plyHeader() + kPlyVertices + kPlyFaces + "3 0 1 2\n", {":19:", "\"3\" follows after the last"}},
       {binary.substr(0, binary.size() - 1), {"within \"y\"", "cut off"}},
       {binary.substr(0, data + 9), {"2 of \"edge\"", "cut off"}},
       {damaged(data + 4, bytesOf(std::uint16_t{3})), {"the file ends", "cut off"}},
       {binary + "\n", {place(binary.size()), "1 bytes follow"}},
       {damaged(vertices + 4 * 20 - 8, bytesOf(std::numeric_limits<float>::infinity())),
        {place(vertices + 72), "x = inf"}},
       {damaged(faces + 1, bytesOf(std::int8_t{-3})), {place(faces + 1), "face 0 has -3 corners"}},
       {damaged(faces + 2, bytesOf(std::int32_t{0x7fffffff})),
        {place(faces + 1), "face 0 uses vertex 2147483647", "out of range"}},
       {damaged(faces + 2, bytesOf(std::int32_t{4})), {place(faces + 1), "face 0 uses vertex 4", "has 4"}},
       {damaged(faces + 14, bytesOf(std::int8_t{-1})), {place(faces + 14), "list \"tex\"", "-1", "negative"}}});
}

// OFF
// ---------------------------------------------------------------------------------------------------------------------

TEST(OffReader, ReadsEveryHeaderThatHasThreeDimensions) {
  const std::string f = "3 0 2 1\n3 0 1 3 7\n3 0 3 2 0.1 0.2 0.3\n3 1 2 3 255 0 0 255 # red\n";
  const auto vertices = [](const std::string& more) {
    return "0 0 0" + more + "\n1 0 0" + more + "\n\n# a comment\n0 2 0" + more + "\n0 0 3" + more + "\n";
  };
  const auto expect = [&](const std::string& text) {
    const TriangleMesh mesh = read(text, MeshFormat::off);
    expectTetrahedron(mesh, text.c_str());
    return mesh;
  };
  expect("OFF\n4 4 6\n" + vertices("") + f);
  expect("OFF 4 4 0\n" + vertices("") + f);
  expect("# by hand\r\nOFF\r\n4 4 6 # counts\r\n" + vertices("") + f);
  expect("COFF\n4 4 6\n" + vertices(" 1 0 0 1") + f);
  expect("COFF\n4 4 6\n" + vertices(" 255 0 0") + f);
  expect("STOFF\n4 4 6\n" + vertices(" 0.5 0.5") + f);
  const TriangleMesh mesh = expect("NOFF\n4 4 6\n" + vertices(" 0 0 2") + f);
  EXPECT_EQ(mesh.triangle_normals, mesh.triangles);
  EXPECT_EQ(mesh.normals[3], Vec3(0, 0, 1));
  EXPECT_EQ(expect("STCNOFF\n4 4 6\n" + vertices(" 0 1 0 1 0 0 1 0.5 0.5") + f).normals[1], Vec3(0, 1, 0));
  EXPECT_TRUE(expect("OFF\n4 4 6\n" + vertices("") + f).triangle_normals.empty());
}

TEST(OffReader, NamesEveryDefectWithItsPlace) {
  const std::string v = "0 0 0\n1 0 0\n0 2 0\n0 0 3\n", f = "3 0 2 1\n3 0 1 3\n3 0 3 2\n3 1 2 3\n",
                    head = "OFF\n4 4 6\n";
  expectMessages(MeshFormat::off,
                 {{"", {"empty"}},
                  {"# nothing\n", {"no header"}},
                  {"OF\n4 4 6\n", {":1:", "\"OF\"", "OFF file"}},
                  {"4OFF\n4 4 6\n", {":1:", "three dimensions"}},
                  {"OFF BINARY\n", {":1:", "binary OFF", "ascii"}},
                  {"OFF\n", {"numbers of vertices", "cut off"}},
                  {"OFF\n4 4\n" + v + f, {":2:", "2 counts", "needs 3"}},
                  {"OFF\n-4 4 6\n" + v + f, {":2:", "number of vertices = -4", "negative"}},
                  {"OFF\n4 1e3 6\n" + v + f, {":2:", "\"1e3\"", "whole number"}},
                  {"OFF\n4000000000 4 6\n" + v + f, {":2:", "4000000000 vertices", "56 bytes", "cut off"}},
                  {"OFF\n4 5000000 6\n" + v + f, {":2:", "5000000 faces", "56 bytes"}},
                  {"OFF\n0 0 0\n", {"0 vertices", "no face"}},
                  {head + v + f.substr(0, 24) + "\n\n\n\n\n\n\n\n", {"face 3 is missing", "announces 4", "cut off"}},
                  {head + "0 0 nan\n1 0 0\n0 2 0\n0 0 3\n" + f, {":3:", "z = \"nan\""}},
                  {head + "0 0 0 1\n1 0 0\n0 2 0\n0 0 3\n" + f, {":3:", "vertex 0 has 4 numbers", "needs 3"}},
                  {"COFF\n4 4 6\n" + v + f, {":3:", "vertex 0 has 3 numbers", "colour"}},
                  {"NOFF\n1 0 0\n0 0 0 0 0 0\n", {":3:", "normal 0 is zero"}},
                  {head + v + "2 0 1\n" + f, {":7:", "face 0 has 2 corners"}},
                  {head + v + "-3 0 1 2\n" + f, {":7:", "face 0 has -3 corners"}},
                  {head + v + "4 0 1 2\n" + f, {":7:", "face 0 has 3 numbers", "4 corners"}},
                  {head + v + "3 0 1 2 9 9\n" + f, {":7:", "face 0 has 5 numbers"}},
                  {head + v + "3 0 1 4\n" + f.substr(8), {":7:", "face 0 uses vertex 4", "has 4 (from 0)"}},
                  {head + v + "3 0 1 -2\n" + f.substr(8), {":7:", "face 0 uses vertex -2"}},
                  {head + v + "3 0 1 1\n" + f.substr(8), {":7:", "vertex 1 at (1, 0, 0) m twice"}},
                  {head + v + f + "3 0 1 2\n", {":11:", "\"3\" follows after the last of the 4 faces"}}});
}

// All formats
// ---------------------------------------------------------------------------------------------------------------------

TEST(MeshReader, TellsFormatsApart) {
  EXPECT_EQ(formatOfName("a/b.OBJ"), MeshFormat::obj);
  EXPECT_EQ(formatOfName("b.obj.stl"), MeshFormat::stl);
  EXPECT_EQ(formatOfName("b.Ply"), MeshFormat::ply);
  EXPECT_EQ(formatOfName("off"), std::nullopt);
  EXPECT_EQ(formatOfBytes("# made by\n\nv 0 0 0\n"), MeshFormat::obj);
  EXPECT_EQ(formatOfBytes("\xEF\xBB\xBFmtllib a"), MeshFormat::obj);
  EXPECT_EQ(formatOfBytes("solid\n"), MeshFormat::stl);
  EXPECT_EQ(formatOfBytes(stlBinary("v 0 0 0\n")), MeshFormat::stl) << "the size decides";
  EXPECT_EQ(formatOfBytes("ply\r\n"), MeshFormat::ply);
  EXPECT_EQ(formatOfBytes("# c\nSTCNOFF 1 1 1"), MeshFormat::off);
  EXPECT_EQ(formatOfBytes("hello"), std::nullopt);
  EXPECT_EQ(formatOfBytes(""), std::nullopt);
  EXPECT_EQ(formatOfBytes("# only a comment"), std::nullopt);
}

class MeshFiles : public testing::Test {
 protected:
  std::string file(const std::string& name, const std::string& bytes) {
    std::ofstream(folder_ / name, std::ios::binary) << bytes;
    return folder_ / name;
  }
  std::string errorOf(const std::string& path) {
    try {
      readMesh(path);
    } catch (const InputError& error) {
      EXPECT_TRUE(std::string(error.what()).starts_with(path)) << error.what();
      return error.what();
    }
    return "(no error)";
  }
  tests::TemporaryDirectory folder_;
};

TEST_F(MeshFiles, AreReadByContentOrName) {
  EXPECT_EQ(readMesh(file("a.ply", plyHeader() + kPlyVertices + kPlyFaces)).triangles.size(), 4u);
  EXPECT_EQ(readMesh(file("a.stl", stlBinary("solid"))).triangles.size(), 4u);
  EXPECT_EQ(readMesh(file("noname", "solid\n" + kFacet + "endsolid\n")).triangles.size(), 1u);
  EXPECT_EQ(readMesh(file("a.dat", "OFF\n3 1 0\n0 0 0\n1 0 0\n0 1 0\n3 0 1 2\n")).source, folder_ / "a.dat");
}

TEST_F(MeshFiles, WithAWrongNameAreTold) {
  const std::string error = errorOf(file("part.obj", stlBinary("x")));
  EXPECT_NE(error.find("STL file, by its name OBJ"), std::string::npos) << error;
  EXPECT_NE(errorOf(file("part.txt", "hello")).find("OBJ, STL, PLY or OFF"), std::string::npos);
  EXPECT_NE(errorOf(file("part.ply", "hello")).find("must be \"ply\""), std::string::npos);
  EXPECT_NE(errorOf(file("part.off", "")).find("empty"), std::string::npos);
}

TEST_F(MeshFiles, ThatCannotBeReadAreNamed) {
  EXPECT_NE(errorOf(folder_ / "none.obj").find("no such file"), std::string::npos);
  EXPECT_NE(errorOf(folder_.path()).find("not a file"), std::string::npos);
  EXPECT_NE(errorOf("/dev/zero").find("not a file"), std::string::npos) << "a device never ends";
}

TEST(MeshReader, ScalesToMetresInEveryFormat) {
  const ReadOptions millimetres{.metres_per_unit = metresPerUnit("mm")};
  EXPECT_EQ(read("v 0 0 0\nv 1 0 0\nv 0 7 0\nf 1 2 3\n", MeshFormat::obj, millimetres).vertices[2].y(), 0.007);
  EXPECT_EQ(read(plyHeader() + kPlyVertices + kPlyFaces, MeshFormat::ply, millimetres).vertices[3].z(), 0.003);
  EXPECT_EQ(read(stlBinary(""), MeshFormat::stl, millimetres).vertices[3].z(), 0.003);
  EXPECT_EQ(read("OFF\n3 1 0\n0 0 0\n1 0 0\n0 7 0\n3 0 1 2\n", MeshFormat::off, millimetres).vertices[2].y(), 0.007);
}

TEST(MeshReader, ChecksTheScale) {
  for (const double scale : {0.0, -1.0, std::nan(""), std::numeric_limits<double>::infinity()})
    EXPECT_THROW(read("v 0 0 0\n", MeshFormat::obj, {.metres_per_unit = scale}), InputError);
}

TEST(MeshReader, KeepsTrianglesWithoutAreaForARepair) {
  const ReadOptions keep{.degenerate = Degenerate::keep};
  using Triangles = std::vector<std::array<std::int32_t, 3>>;
  const std::string head = "v 0 0 0\nv 1 0 0\nv 2 0 0\nv 0 1 0\nv 3 0 0\n";
  EXPECT_EQ(read(head + "f 1 2 3\n", MeshFormat::obj, keep).triangles, (Triangles{{0, 1, 2}})) << "on one line";
  EXPECT_EQ(read(head + "f 1 2 2\n", MeshFormat::obj, keep).triangles, (Triangles{{0, 1, 1}})) << "a vertex twice";
  EXPECT_EQ(read(head + "f 1 2 4 4\n", MeshFormat::obj, keep).triangles, (Triangles{{0, 1, 3}, {3, 3, 0}}))
      << "a triangle written as a quad";
  EXPECT_EQ(read(head + "f 1 2 3 5\n", MeshFormat::obj, keep).triangles, (Triangles{{0, 1, 2}, {0, 2, 4}}))
      << "a polygon on one line";
  EXPECT_THROW(read("v 0 0 0\nv 1 1 0\nv 1 0 0\nv 0 1 0\nf 1 2 3 4\n", MeshFormat::obj, keep), InputError)
      << "crosses itself";
  EXPECT_EQ(read("solid\nfacet normal 0 0 1\nouter loop\nvertex 0 0 0\nvertex 1 0 0\nvertex 0 0 "
                 "0\nendloop\nendfacet\nendsolid\n",
                 MeshFormat::stl, keep)
                .triangles,
            (Triangles{{0, 1, 0}}));
}

// More triangles are refused at the header where there is one, so after no work.
TEST(MeshReader, RefusesMoreTrianglesThanAFingerNeeds) {
  std::string bytes(80, ' ');
  bytes += bytesOf(std::uint32_t{2'000'001});
  bytes.resize(84 + 50 * std::size_t{2'000'001}, '\0');
  EXPECT_NE(errorOf(bytes, MeshFormat::stl).find("2000000 triangles"), std::string::npos);
}

TEST(MeshReader, TellsHowFarItHasCome) {
  std::string text = "v 0 0 0\nv 1 0 0\nv 0 1 0\n";
  while (text.size() < (5u << 20)) text += "f 1 2 3\n";
  std::vector<double> seen;
  read(text, MeshFormat::obj, {.progress = [&](double fraction) { seen.push_back(fraction); }});
  ASSERT_EQ(seen.size(), 6u) << "once a megabyte, and at the end";
  EXPECT_TRUE(std::is_sorted(seen.begin(), seen.end()));
  EXPECT_EQ(seen.back(), 1);
  EXPECT_GT(seen.front(), 0.1);
}

}  // namespace
}  // namespace pincer::contact
