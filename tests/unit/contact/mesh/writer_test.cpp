#include <gtest/gtest.h>

#include <algorithm>
#include <filesystem>

#include "pincer/contact/generated_meshes.h"
#include "pincer/contact/mesh/mesh_writer.h"
#include "pincer/contact/mesh_reader.h"
#include "pincer/tests/support/temporary_directory.h"

namespace pincer::contact {
namespace {

struct Written {
  const char* name;
  MeshFormat format;
  bool ascii;
};
constexpr std::array kAll = {Written{"OBJ", MeshFormat::obj, true},         Written{"ascii STL", MeshFormat::stl, true},
                             Written{"binary STL", MeshFormat::stl, false}, Written{"ascii PLY", MeshFormat::ply, true},
                             Written{"binary PLY", MeshFormat::ply, false}, Written{"OFF", MeshFormat::off, true}};

TriangleMesh throughFile(const TriangleMesh& mesh, const Written& form, Degenerate degenerate = Degenerate::reject) {
  const std::string bytes = formatMesh(mesh, form.format, {.ascii = form.ascii});
  EXPECT_EQ(formatOfBytes(bytes), form.format) << form.name;
  return parseMesh(bytes, form.format, mesh.source, {.degenerate = degenerate});
}

Vec3 inFloats(const Vec3& p) { return p.cast<float>().cast<double>(); }

// Every corner of every triangle is where it was, to the last bit (of a float in binary STL).
void expectSameCorners(const TriangleMesh& back, const TriangleMesh& mesh, const Written& form) {
  const bool floats = form.format == MeshFormat::stl && !form.ascii;
  ASSERT_EQ(back.triangles.size(), mesh.triangles.size()) << form.name;
  std::size_t different = 0;
  for (std::size_t t = 0; t < mesh.triangles.size(); ++t) {
    for (std::size_t i = 0; i < 3; ++i) {
      const Vec3& p = mesh.vertices[static_cast<std::size_t>(mesh.triangles[t][i])];
      if (back.vertices[static_cast<std::size_t>(back.triangles[t][i])] != (floats ? inFloats(p) : p)) ++different;
    }
  }
  EXPECT_EQ(different, 0u) << form.name;
}

void expectSame(const TriangleMesh& back, const TriangleMesh& mesh, const Written& form) {
  expectSameCorners(back, mesh, form);
  if (form.format == MeshFormat::stl) return;
  EXPECT_TRUE(back.vertices == mesh.vertices) << form.name;
  EXPECT_TRUE(back.triangles == mesh.triangles) << form.name;
}

TriangleMesh withRadialNormals(TriangleMesh mesh) {
  for (const Vec3& p : mesh.vertices) mesh.normals.push_back(p.normalized());
  mesh.triangle_normals = mesh.triangles;
  return mesh;
}

TEST(MeshWriter, WritesWhatTheReaderReadsBackToTheLastBit) {
  for (const Written& form : kAll) {
    for (const TriangleMesh& mesh : {icosphere(0.02, 2), cylinder(0.01, 0.03, 24, 3), torus(0.03, 0.012, 12, 8)}) {
      expectSame(throughFile(mesh, form), mesh, form);
    }
  }
}

TEST(MeshWriter, KeepsVertexNormalsWhereTheFormatHasThem) {
  const TriangleMesh mesh = withRadialNormals(icosphere(0.02, 2));
  for (const Written& form : kAll) {
    const TriangleMesh back = throughFile(mesh, form);
    expectSame(back, mesh, form);
    const bool keeps = form.format != MeshFormat::stl;
    EXPECT_EQ(back.normals == mesh.normals, keeps) << form.name;
    EXPECT_EQ(back.triangle_normals == mesh.triangle_normals, keeps) << form.name;
    const auto losses = lossesOf(mesh, form.format, {.ascii = form.ascii});
    EXPECT_EQ(std::count(losses.begin(), losses.end(), "normals"), keeps ? 0 : 1) << form.name;
  }
}

TEST(MeshWriter, SaysWhichFeaturesAFormatCannotHold) {
  TriangleMesh mesh = box({0.01, 0.02, 0.03});
  mesh.smoothing_groups.assign(mesh.triangles.size(), 0);
  mesh.smoothing_groups[5] = 7;
  for (std::size_t t = 0; t < mesh.triangles.size(); ++t) {  // several normals at each vertex
    const auto& [a, b, c] = mesh.triangles[t];
    const auto at = [&](std::int32_t i) { return mesh.vertices[static_cast<std::size_t>(i)]; };
    mesh.normals.push_back((at(b) - at(a)).cross(at(c) - at(a)).normalized());
    mesh.triangle_normals.push_back(
        {static_cast<std::int32_t>(t), static_cast<std::int32_t>(t), static_cast<std::int32_t>(t)});
  }
  const TriangleMesh back = throughFile(mesh, kAll[0]);
  EXPECT_TRUE(lossesOf(mesh, MeshFormat::obj).empty());
  EXPECT_EQ(back.smoothing_groups, mesh.smoothing_groups);
  EXPECT_EQ(back.normals, mesh.normals);
  EXPECT_EQ(back.triangle_normals, mesh.triangle_normals);
  for (const MeshFormat format : {MeshFormat::ply, MeshFormat::off}) {
    EXPECT_EQ(lossesOf(mesh, format), (std::vector<std::string>{"smoothing groups", "normals"}));
    EXPECT_TRUE(parseMesh(formatMesh(mesh, format), format, "box").normals.empty()) << "none rather than a wrong one";
  }
}

TEST(MeshWriter, WritesInTheUnitAskedFor) {
  const TriangleMesh mesh = icosphere(0.02, 1);
  for (const Written& form : kAll) {
    const WriteOptions millimetres{.metres_per_unit = 0.001, .ascii = form.ascii};
    const TriangleMesh back =
        parseMesh(formatMesh(mesh, form.format, millimetres), form.format, "ball", {.metres_per_unit = 0.001});
    const TriangleMesh same = throughFile(mesh, form);
    // two roundings each of doubles (floats in binary STL) of at most 0.02
    for (std::size_t i = 0; i < back.vertices.size(); ++i) {
      EXPECT_LE((back.vertices[i] - same.vertices[i]).norm(),
                form.ascii || form.format != MeshFormat::stl ? 1e-17 : 5e-9)
          << form.name;
    }
  }
  EXPECT_THROW(formatMesh(mesh, MeshFormat::obj, {.metres_per_unit = 0}), InputError);
}

TEST(MeshWriter, WritesFilesByTheirName) {
  const tests::TemporaryDirectory folder;
  const TriangleMesh mesh = icosphere(0.02, 1);
  for (const char* name : {"a.obj", "a.stl", "a.ply", "a.off"}) {
    writeMesh(folder / name, mesh);
    EXPECT_EQ(readMesh(folder / name).triangles.size(), mesh.triangles.size()) << name;
  }
  EXPECT_THROW(writeMesh(folder / "a.txt", mesh), InputError);
  EXPECT_THROW(writeMesh(folder / "none/a.obj", mesh), InputError);
}

// Meshes as the world makes them, with duplicate and unused vertices, through every format.
TEST(MeshWriter, BringsRealMeshesThroughEveryFormat) {
  const auto folder = std::filesystem::path(PINCER_SOURCE_DIR).parent_path() / "shared" / "data" / "meshes";
  if (!std::filesystem::exists(folder)) GTEST_SKIP() << "the shared meshes aren't beside this checkout";
  for (const char* name : {"fandisk", "rocker-arm", "spot", "stanford-bunny", "suzanne", "teapot"}) {
    const TriangleMesh mesh = readMesh(folder / (std::string(name) + ".obj"), {.degenerate = Degenerate::keep});
    for (const Written& form : kAll) expectSame(throughFile(mesh, form, Degenerate::keep), mesh, form);
  }
}

}  // namespace
}  // namespace pincer::contact
