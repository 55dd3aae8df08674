#include "pincer/tasks/lab/experiments/shaded_objects.h"

#include <algorithm>
#include <array>
#include <cmath>

#include "pincer/contact/generated_meshes.h"

namespace pincer::tasks {
namespace {

constexpr int kSphereParts = 6;     // of an icosahedron's sides: 720 triangles, 10 degrees each
constexpr int kRoundSegments = 48;  // of the cylinder's round part
constexpr int kRows = 4;            // along it
constexpr double kOnFace = 1e-9;    // of the size: a corner lies on a flat face [-]

// Normals of the corners of one triangle, which lies on one face.
template <class Normals>
void giveNormals(contact::TriangleMesh& mesh, const Normals& normals) {
  for (const auto& triangle : mesh.triangles) {
    std::array<Vec3, 3> corners;
    for (std::size_t i = 0; i < 3; ++i) corners[i] = mesh.vertices[static_cast<std::size_t>(triangle[i])];
    const auto first = static_cast<std::int32_t>(mesh.normals.size());
    for (const Vec3& n : normals(corners)) mesh.normals.push_back(n);
    mesh.triangle_normals.push_back({first, first + 1, first + 2});
  }
}

bool areAt(const std::array<Vec3, 3>& corners, int axis, double at, double size) {
  return std::all_of(corners.begin(), corners.end(),
                     [&](const Vec3& p) { return std::abs(p[axis] - at) < kOnFace * size; });
}

std::shared_ptr<const contact::SmoothMesh> built(contact::TriangleMesh mesh, contact::SurfaceVariant variant) {
  contact::SurfaceOptions options;
  options.variant = variant;
  return contact::SmoothMesh::build(std::move(mesh), options);
}

}  // namespace

std::shared_ptr<const contact::SmoothMesh> shadedSphere(double radius, contact::SurfaceVariant variant) {
  contact::TriangleMesh mesh = contact::geodesicSphere(radius, kSphereParts);
  giveNormals(mesh, [](const std::array<Vec3, 3>& corners) {
    return std::array<Vec3, 3>{corners[0].normalized(), corners[1].normalized(), corners[2].normalized()};
  });
  return built(std::move(mesh), variant);
}

std::shared_ptr<const contact::SmoothMesh> shadedCylinder(double radius, double half_length, double flat_distance,
                                                          contact::SurfaceVariant variant) {
  contact::TriangleMesh mesh = contact::cylinderWithFlat(radius, half_length, flat_distance, kRoundSegments, kRows);
  giveNormals(mesh, [&](const std::array<Vec3, 3>& corners) -> std::array<Vec3, 3> {
    const auto flat = [](const Vec3& n) { return std::array<Vec3, 3>{n, n, n}; };
    if (areAt(corners, 2, half_length, half_length)) return flat(Vec3::UnitZ());
    if (areAt(corners, 2, -half_length, half_length)) return flat(-Vec3::UnitZ());
    if (areAt(corners, 0, flat_distance, radius)) return flat(Vec3::UnitX());
    std::array<Vec3, 3> radial;
    for (std::size_t i = 0; i < 3; ++i) radial[i] = Vec3(corners[i].x(), corners[i].y(), 0).normalized();
    return radial;
  });
  return built(std::move(mesh), variant);
}

}  // namespace pincer::tasks
