// The readers at the edges of what they take: strips with neighbours in their
// element, many equal places, sizes at a limit.
#include <fmt/format.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <bit>
#include <cmath>
#include <cstring>
#include <set>

#include "pincer/contact/mesh_reader.h"
#include "pincer/tests/support/error_of.h"
#include "pincer/tests/support/random_numbers.h"

namespace pincer::contact {
namespace {

using tests::errorOf;
using Triangles = std::vector<std::array<std::int32_t, 3>>;

TriangleMesh readPart(const std::string& bytes, MeshFormat format, const ReadOptions& options = {}) {
  return parseMesh(bytes, format, "part", options);
}

void expectSaid(const std::string& bytes, MeshFormat format, const std::string& part, const ReadOptions& options = {}) {
  const std::string error = errorOf([&] { readPart(bytes, format, options); });
  EXPECT_NE(error.find(part), std::string::npos) << "-> " << error << "\nlacks " << part;
}

template <typename T>
std::string rawOf(T value) {
  std::string raw(sizeof(T), '\0');
  std::memcpy(raw.data(), &value, sizeof(T));
  return raw;
}

// PLY
// ---------------------------------------------------------------------------------------------------------------------

const std::string kSix = "0 0 0 0 0 1\n1 0 0 0 0 1\n0 1 0 0 0 1\n1 1 0 0 0 1\n0 2 0 0 0 1\n1 2 0 0 0 1\n";

std::string stripHeader(const std::string& element, const std::string& z_normal = "nz") {
  return "ply\nformat ascii 1.0\nelement vertex 6\nproperty float x\nproperty float y\nproperty float z\nproperty "
         "float nx\n"
         "property float ny\nproperty float " +
         z_normal + "\nelement tristrips " + element + "end_header\n" + kSix;
}

TEST(PlyStrips, CarryTheNormalsOfTheirVertices) {
  const TriangleMesh mesh =
      readPart(stripHeader("1\nproperty list int int vertex_indices\n") + "4 0 1 2 3\n", MeshFormat::ply);
  EXPECT_EQ(mesh.triangles, (Triangles{{0, 1, 2}, {2, 1, 3}}));
  EXPECT_EQ(mesh.triangle_normals, mesh.triangles);
  expectSaid(stripHeader("1\nproperty list int int vertex_indices\n", "quality") + "4 0 1 2 3\n", MeshFormat::ply,
             "some of nx, ny and nz");
  std::string no_ny = stripHeader("1\nproperty list int int vertex_indices\n") + "4 0 1 2 3\n";
  no_ny.replace(no_ny.find("float ny"), 8, "float qy");
  expectSaid(no_ny, MeshFormat::ply, "some of nx, ny and nz");
}

TEST(PlyStrips, StandAmongOtherPropertiesAndBesideOtherStrips) {
  const std::string head =
      stripHeader("2\nproperty int colour\nproperty list uchar int vertex_indices\nproperty list char short more\n");
  const TriangleMesh mesh = readPart(head + "7 4 0 1 2 3 2 8 9\n7 3 5 4 3 0\n", MeshFormat::ply);
  EXPECT_EQ(mesh.triangles, (Triangles{{0, 1, 2}, {2, 1, 3}, {5, 4, 3}}));
  expectSaid(head + "7 4 0 1 2 3 2 8 9\n7 3 5 4 3 -1\n", MeshFormat::ply, ":22: list \"more\" has the count -1");
  expectSaid(head + "7 4 0 1 2 3 0\n7 3 5 4 3 0 0\n", MeshFormat::ply,
             "the line has 7 values, but a \"tristrips\" has only 6 here");
}

TEST(PlyStrips, OfTooFewVerticesMakeNoTriangle) {
  const std::string head = stripHeader("1\nproperty list int int vertex_indices\n");
  for (const char* strip : {"0\n", "1 0\n", "2 0 1\n", "3 0 1 1\n", "3 1 0 1\n", "3 1 1 0\n", "5 0 1 -1 2 3\n"})
    expectSaid(head + strip, MeshFormat::ply, "no face");
  expectSaid(head + "-1\n", MeshFormat::ply, ":19: list \"vertex_indices\" has the count -1");
  expectSaid(head + "4 0 1 2 6\n", MeshFormat::ply, ":19: face 1 uses vertex 6");
}

// A grid as one strip per row, joined by vertices that are named twice: the triangles of
// the grid, each edge inside once each way.
TEST(PlyStrips, OfAGridAreTheGrid) {
  constexpr int kWide = 7, kHigh = 5;
  std::string text = fmt::format(
      "ply\nformat ascii 1.0\nelement vertex {}\nproperty float x\nproperty float y\nproperty float z\n"
      "element tristrips 1\nproperty list int int vertex_indices\nend_header\n",
      kWide * kHigh);
  for (int y = 0; y < kHigh; ++y) {
    for (int x = 0; x < kWide; ++x) text += fmt::format("{} {} 0\n", x, y);
  }
  std::vector<int> strip;
  for (int y = 0; y + 1 < kHigh; ++y) {
    if (y > 0) strip.insert(strip.end(), {strip.back(), (y + 1) * kWide});
    for (int x = 0; x < kWide; ++x) strip.insert(strip.end(), {(y + 1) * kWide + x, y * kWide + x});
  }
  text += fmt::format("{} {}\n", strip.size(), fmt::join(strip, " "));
  const TriangleMesh mesh = readPart(text, MeshFormat::ply);
  EXPECT_EQ(mesh.triangles.size(), 2u * (kWide - 1) * (kHigh - 1));
  std::set<std::pair<int, int>> ways;
  double area = 0;
  for (const auto& t : mesh.triangles) {
    const auto at = [&](std::size_t i) { return mesh.vertices[static_cast<std::size_t>(t[i])]; };
    area += 0.5 * (at(1) - at(0)).cross(at(2) - at(0)).z();
    for (std::size_t i = 0; i < 3; ++i)
      EXPECT_TRUE(ways.insert({t[i], t[(i + 1) % 3]}).second) << "an edge twice the same way";
  }
  EXPECT_EQ(area, (kWide - 1) * (kHigh - 1)) << "all face one side";
}

TEST(PlyBinary, RefusesAListThatIsLongerThanTheFile) {
  const std::string head =
      "ply\nformat binary_little_endian 1.0\nelement thing 1\nproperty list uint double w\nelement vertex 0\nproperty "
      "float x\n"
      "property float y\nproperty float z\nend_header\n";
  for (const std::uint32_t items : {3u, 0x20000000u, 0xffffffffu})
    expectSaid(head + rawOf(items) + std::string(16, '\0'), MeshFormat::ply, "the file ends within \"w\"");
  expectSaid(head + rawOf(2u) + std::string(16, '\0'), MeshFormat::ply, "no face");
}

TEST(PlyAscii, RefusesAListThatIsLongerThanItsLine) {
  const std::string head =
      "ply\nformat ascii 1.0\nelement thing 1\nproperty list uint double w\nproperty int n\nelement vertex 0\nproperty "
      "float x\n"
      "property float y\nproperty float z\nend_header\n";
  expectSaid(head + "3 1 1 1\n", MeshFormat::ply, ":11: the line has 4 values, which aren't enough for \"n\"");
  expectSaid(head + "4 1 1 1\n", MeshFormat::ply, ":11: the line has 4 values, which aren't enough for \"w\"");
  expectSaid(head + "3 1 1 1 7\n", MeshFormat::ply, "no face");
}

// STL
// ---------------------------------------------------------------------------------------------------------------------

std::string binaryOf(const std::vector<std::array<Vec3, 3>>& facets) {
  std::string bytes(80, ' ');
  bytes += rawOf(static_cast<std::uint32_t>(facets.size()));
  for (const auto& facet : facets) {
    bytes += std::string(12, '\0');
    for (const Vec3& p : facet) {
      for (int i = 0; i < 3; ++i) bytes += rawOf(static_cast<float>(p[i]));
    }
    bytes += std::string(2, '\0');
  }
  return bytes;
}

std::string textOf(const std::vector<std::array<Vec3, 3>>& facets) {
  std::string text = "solid x\n";
  for (const auto& facet : facets) {
    text += "facet normal 0 0 1\nouter loop\n";
    for (const Vec3& p : facet) text += fmt::format("vertex {} {} {}\n", p.x(), p.y(), p.z());
    text += "endloop\nendfacet\n";
  }
  return text + "endsolid x\n";
}

// Places that differ in the last bit are two, equal ones are one, however many
// there are, numbered as they first appear.
TEST(StlReader, NumbersThousandsOfPlacesAsTheyFirstAppear) {
  tests::RandomNumbers random(3);
  std::vector<Vec3> pool;
  for (int i = 0; i < 1000; ++i) {
    const auto x = static_cast<float>(random.below(100'000) * 1e-5 + 1);
    pool.push_back(Vec3(x, static_cast<float>(random.below(1000)), 1));
    pool.push_back(Vec3(std::nextafterf(x, 9), pool.back().y(), 1));
  }
  std::vector<std::array<Vec3, 3>> facets;
  std::vector<Vec3> expected;
  Triangles triangles;
  for (int i = 0; i < 1500; ++i) {
    const auto any = [&] { return pool[static_cast<std::size_t>(random.below(static_cast<int>(pool.size())))]; };
    facets.push_back({any(), any(), any()});
    std::array<std::int32_t, 3> numbers{};
    for (std::size_t k = 0; k < 3; ++k) {
      const auto known = std::find(expected.begin(), expected.end(), facets.back()[k]);
      numbers[k] = static_cast<std::int32_t>(known - expected.begin());
      if (known == expected.end()) expected.push_back(facets.back()[k]);
    }
    triangles.push_back(numbers);
  }
  for (const std::string& bytes : {binaryOf(facets), textOf(facets)}) {
    const TriangleMesh mesh = readPart(bytes, MeshFormat::stl, {.degenerate = Degenerate::keep});
    EXPECT_EQ(mesh.vertices, expected);
    EXPECT_EQ(mesh.triangles, triangles);
  }
}

TEST(StlReader, TellsTextFromBytes) {
  const std::vector<std::array<Vec3, 3>> facets = {{Vec3(0, 0, 0), Vec3(1, 0, 0), Vec3(0, 1, 0)}};
  const std::string text = textOf(facets);
  for (const std::string before : {"\xEF\xBB\xBF", " \t\r\n", "\xEF\xBB\xBF\n"})
    EXPECT_EQ(readPart(before + text, MeshFormat::stl).triangles.size(), 1u) << before.size();
  std::string upper = text;
  std::transform(upper.begin(), upper.end(), upper.begin(), [](unsigned char c) { return std::toupper(c); });
  EXPECT_EQ(readPart(upper, MeshFormat::stl).triangles.size(), 1u);
  std::string zero = text;
  zero[60] = '\0';
  expectSaid(zero, MeshFormat::stl, "the header announces");
  zero = text + std::string(100, ' ');
  zero[170] = '\0';
  expectSaid(zero, MeshFormat::stl, "NUL byte");
  expectSaid("solidus\n", MeshFormat::stl, "solid should begin");
}

TEST(StlReader, NamesByteAndCornerOfWhatIsNoNumber) {
  std::string bytes =
      binaryOf({{Vec3(0, 0, 0), Vec3(1, 0, 0), Vec3(0, 1, 0)}, {Vec3(0, 0, 0), Vec3(1, 0, 0), Vec3(0, 0, 1)}});
  const float nan = std::numeric_limits<float>::quiet_NaN();
  for (std::size_t facet = 0; facet < 2; ++facet) {
    for (std::size_t corner = 0; corner < 3; ++corner) {
      for (std::size_t i = 0; i < 3; ++i) {
        const std::size_t at = 84 + 50 * facet + 12 + 12 * corner + 4 * i;
        expectSaid(std::string(bytes).replace(at, 4, rawOf(nan)), MeshFormat::stl,
                   fmt::format("byte {}: {} of a corner of triangle {} = nan", at, "xyz"[i], facet + 1));
      }
    }
  }
}

// Any format
// ---------------------------------------------------------------------------------------------------------------------

TEST(MeshReader, TakesAThousandMetresAndNotMore) {
  const auto at = [](const std::string& x) { return "v 0 0 0\nv " + x + " 0 0\nv 0 1 0\nf 1 2 3\n"; };
  EXPECT_EQ(readPart(at("1000"), MeshFormat::obj).vertices[1].x(), 1000);
  expectSaid(at("-1000.001"), MeshFormat::obj,
             ":2: vertex 2 lies 1e+03 m from the origin along an axis; the limit is 1000 m");
  EXPECT_EQ(readPart(at("1e6"), MeshFormat::obj, {.metres_per_unit = 1e-3}).vertices[1].x(), 1000);
  expectSaid(at("1e301"), MeshFormat::obj, "limit is 1000 m", {.metres_per_unit = 1e300});
}

TEST(MeshReader, TakesAPolygonOfAThousandCornersAndNotMore) {
  const auto ring = [](int corners) {
    std::string text, face = "f";
    for (int i = 0; i < corners; ++i) {
      const double angle = 2 * 3.14159265358979 * i / corners;
      text += fmt::format("v {} {} 0\n", std::cos(angle), std::sin(angle));
      face += fmt::format(" {}", i + 1);
    }
    return text + face + "\n";
  };
  EXPECT_EQ(readPart(ring(1000), MeshFormat::obj).triangles.size(), 998u);
  expectSaid(ring(1001), MeshFormat::obj, "face 1 has 1001 corners; the limit is 1000");
}

TEST(MeshReader, MakesNormalsOfLengthOneWhateverTheirSize) {
  const auto with = [](const std::string& n) { return "v 0 0 0\nv 1 0 0\nv 0 1 0\nvn " + n + "\nf 1//1 2//1 3//1\n"; };
  for (const char* n : {"0 0 1e-300", "0 0 1e300", "0 0 1", "0 0 0.5"})
    EXPECT_EQ(readPart(with(n), MeshFormat::obj).normals[0], Vec3::UnitZ()) << n;
  const Vec3 kept = readPart(with("0.6 0 0.8"), MeshFormat::obj).normals[0];
  EXPECT_EQ(kept, Vec3(0.6, 0, 0.8)) << "to the bit: what was written comes back";
  EXPECT_NEAR(readPart(with("1e200 -1e200 0"), MeshFormat::obj).normals[0].norm(), 1, 1e-15) << "its square overflows";
  expectSaid(with("0 0 0"), MeshFormat::obj, ":4: normal 1 is zero");
}

TEST(MeshReader, LeavesNothingOfAPolygonThatIsLeftOut) {
  std::vector<std::string> told;
  const ReadOptions options{.degenerate = Degenerate::reject,
                            .left_out = [&](const std::string& what) { told.push_back(what); }};
  const TriangleMesh mesh = readPart(
      "v 0 0 0\nv 1 0 0\nv 1 1 0\nv 0 1 0\nv 0.5 0.5 0\nvn 0 0 1\ns 1\nf 1//1 2//1 3//1\ns 2\nf 1//1 5//1 3//1\nf 1//1 "
      "2//1 9//1 4//1\ns "
      "3\n"
      "f 1//1 3//1 4//1\n",
      MeshFormat::obj, options);
  EXPECT_EQ(mesh.triangles, (Triangles{{0, 1, 2}, {0, 2, 3}}));
  EXPECT_EQ(mesh.triangle_normals, (Triangles{{0, 0, 0}, {0, 0, 0}}));
  EXPECT_EQ(mesh.smoothing_groups, (std::vector<std::int32_t>{1, 3}));
  ASSERT_EQ(told.size(), 2u);
  EXPECT_NE(told[0].find("zero area"), std::string::npos) << told[0];
  EXPECT_NE(told[1].find("uses vertex 9"), std::string::npos) << told[1];
}

TEST(MeshReader, NamesAVertexThatAPolygonHasTwice) {
  const std::string v = "v 0 0 0\nv 1 0 0\nv 1 1 0\nv 0 1 0\n";
  expectSaid(v + "f 1 2 1\n", MeshFormat::obj, "uses vertex 1 at (0, 0, 0) m twice");
  expectSaid(v + "f 2 2 1\n", MeshFormat::obj, "uses vertex 2 at (1, 0, 0) m twice");
  expectSaid(v + "f 1 3 3\n", MeshFormat::obj, "uses vertex 3 at (1, 1, 0) m twice");
  expectSaid(v + "f 1 2 3 2\n", MeshFormat::obj, "uses vertex 2 at (1, 0, 0) m twice");
  expectSaid(v + "f 1 3 2 4\n", MeshFormat::obj, "face 1 with 4 corners has no area or crosses itself");
}

TEST(MeshReader, NormalsAndGroupsThatSayNothingAreLeftOut) {
  const TriangleMesh mesh = readPart("v 0 0 0\nv 1 0 0\nv 0 1 0\nvn 0 0 1\ns off\nf 1 2 3\n", MeshFormat::obj);
  EXPECT_TRUE(mesh.normals.empty());
  EXPECT_TRUE(mesh.triangle_normals.empty());
  EXPECT_TRUE(mesh.smoothing_groups.empty());
  const TriangleMesh some =
      readPart("v 0 0 0\nv 1 0 0\nv 0 1 0\nv 0 0 1\nvn 0 0 1\nf 1 2 3\nf 1//1 3//1 4//1\n", MeshFormat::obj);
  EXPECT_EQ(some.triangle_normals, (Triangles{{-1, -1, -1}, {0, 0, 0}}));
}

}  // namespace
}  // namespace pincer::contact
