#include <fmt/format.h>

#include <cmath>

#include "pincer/contact/mesh/half_edges.h"
#include "pincer/contact/mesh_report.h"

namespace pincer::contact {

namespace {

constexpr double kUnitLength = 1e-3;  // by which a normal of a file with few digits misses the length 1

[[noreturn]] void fail(const TriangleMesh& mesh, const std::string& message) {
  throw InputError(fmt::format("{}: {}", mesh.source.empty() ? "mesh" : mesh.source, message));
}

std::string textOf(const Vec3& v) { return fmt::format("({:g}, {:g}, {:g})", v.x(), v.y(), v.z()); }

void requireFiniteVertices(const TriangleMesh& mesh) {
  for (std::size_t i = 0; i < mesh.vertices.size(); ++i) {
    if (mesh.vertices[i].allFinite()) continue;
    fail(mesh,
         fmt::format("vertices[{}] = {} m must be finite. Correct what computes it.", i, textOf(mesh.vertices[i])));
  }
}

void requireVertexIndices(const TriangleMesh& mesh) {
  const auto count = static_cast<std::int64_t>(mesh.vertices.size());
  for (std::size_t t = 0; t < mesh.triangles.size(); ++t) {
    const auto& triangle = mesh.triangles[t];
    for (const std::int32_t v : triangle) {
      if (v >= 0 && v < count) continue;
      fail(mesh,
           fmt::format("triangles[{}] uses vertex {}, out of range 0 .. {}. Correct the index.", t, v, count - 1));
    }
    if (!namesAVertexTwice(triangle)) continue;
    fail(mesh,
         fmt::format(
             "triangles[{}] = ({}, {}, {}) names a vertex twice and has no area. Leave it out, or repair() the mesh.",
             t, triangle[0], triangle[1], triangle[2]));
  }
}

void requireLength(const TriangleMesh& mesh, const char* name, std::size_t length) {
  if (length == 0 || length == mesh.triangles.size()) return;
  fail(mesh, fmt::format("{} has {} entries, triangles has {}. Give one for each triangle, or none.", name, length,
                         mesh.triangles.size()));
}

void requireNormals(const TriangleMesh& mesh) {
  const auto count = static_cast<std::int64_t>(mesh.normals.size());
  for (std::size_t t = 0; t < mesh.triangle_normals.size(); ++t) {
    for (const std::int32_t n : mesh.triangle_normals[t]) {
      if (n >= -1 && n < count) continue;
      fail(mesh,
           fmt::format("triangle_normals[{}] uses normal {}, out of range 0 .. {} (or -1: none). Correct the index.", t,
                       n, count - 1));
    }
  }
  for (std::size_t i = 0; i < mesh.normals.size(); ++i) {
    if (std::abs(mesh.normals[i].norm() - 1) <= kUnitLength) continue;  // false where it isn't finite
    fail(mesh, fmt::format("normals[{}] = {} must have the length 1. Normalise it.", i, textOf(mesh.normals[i])));
  }
}

}  // namespace

void requireWellFormed(const TriangleMesh& mesh) {
  requireFiniteVertices(mesh);
  requireVertexIndices(mesh);
  requireLength(mesh, "triangle_normals", mesh.triangle_normals.size());
  requireLength(mesh, "smoothing_groups", mesh.smoothing_groups.size());
  requireNormals(mesh);
}

}  // namespace pincer::contact
