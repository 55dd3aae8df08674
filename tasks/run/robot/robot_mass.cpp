#include "pincer/tasks/run/robot/robot_mass.h"

#include <fmt/format.h>

#include <cmath>
#include <numbers>

#include "pincer/contact/error.h"
#include "pincer/contact/io/printable.h"
#include "pincer/contact/polytope.h"

namespace pincer::tasks {
namespace {

using engine::MassProperties;

// Integrals over a body of tetrahedra or triangles: of 1, of x, of x x^T about a point.
struct Moments {
  double size = 0;
  Vec3 first = Vec3::Zero();
  Mat3 second = Mat3::Zero();
};

struct Triangle {
  Vec3 a, b, c;
  Vec3 middle() const { return (a + b + c) / 3; }
  double area() const { return 0.5 * (b - a).cross(c - a).norm(); }
  double volumeFrom(const Vec3& apex) const { return (a - apex).dot((b - apex).cross(c - apex)) / 6; }
};

std::vector<Triangle> trianglesOf(const contact::TriangleMesh& mesh) {
  std::vector<Triangle> all;
  all.reserve(mesh.triangles.size());
  const auto at = [&](std::int32_t i) { return mesh.vertices[static_cast<std::size_t>(i)]; };
  for (const auto& t : mesh.triangles) all.push_back({at(t[0]), at(t[1]), at(t[2])});
  return all;
}

std::vector<Triangle> hullTriangles(const contact::TriangleMesh& mesh) {
  const auto hull = contact::Polytope::hullOf(mesh.vertices, mesh.source);
  std::vector<Triangle> all;
  for (const auto& face : hull->faces()) {
    const auto corners = hull->cornersOf(face);
    const auto at = [&](std::size_t i) { return hull->vertices()[static_cast<std::size_t>(corners[i])]; };
    for (std::size_t i = 2; i < corners.size(); ++i) all.push_back({at(0), at(i - 1), at(i)});
  }
  return all;
}

// Of the triangles' area, each weighed by its area.
Vec3 middleOf(const std::vector<Triangle>& triangles) {
  double area = 0;
  Vec3 sum = Vec3::Zero();
  for (const Triangle& t : triangles) {
    area += t.area();
    sum += t.area() * t.middle();
  }
  return area > 0 ? Vec3(sum / area) : Vec3::Zero();
}

// int x x^T over the simplex of these corners is size/(n (n + 1)) (sum x_k x_k^T + s s^T), s the sum of all n of them.
Mat3 simplexSecond(double size, std::initializer_list<Vec3> corners) {
  const double n = static_cast<double>(corners.size());
  Vec3 sum = Vec3::Zero();
  Mat3 products = Mat3::Zero();
  for (const Vec3& x : corners) {
    sum += x;
    products += x * x.transpose();
  }
  return size / (n * (n + 1)) * (products + sum * sum.transpose());
}

Moments shellMoments(const std::vector<Triangle>& triangles, const Vec3& about) {
  Moments m;
  for (const Triangle& t : triangles) {
    const double area = t.area();
    m.size += area;
    m.first += area * (t.middle() - about);
    m.second += simplexSecond(area, {t.a - about, t.b - about, t.c - about});
  }
  return m;
}

Moments solidMoments(const std::vector<Triangle>& triangles, const Vec3& about, bool all_positive) {
  Moments m;
  for (const Triangle& t : triangles) {
    const double signed_volume = t.volumeFrom(about), volume = all_positive ? std::abs(signed_volume) : signed_volume;
    m.size += volume;
    m.first += volume * 0.25 * (t.a + t.b + t.c - 3 * about);
    m.second += simplexSecond(volume, {Vec3::Zero(), t.a - about, t.b - about, t.c - about});
  }
  return m;
}

std::vector<Triangle> massTriangles(const RobotMesh& mesh) {
  const bool is_hull = mesh.inertia == MeshInertia::kConvex || mesh.triangles.triangles.empty();
  return is_hull ? hullTriangles(mesh.triangles) : trianglesOf(mesh.triangles);
}

Moments momentsOf(const RobotMesh& mesh, const std::vector<Triangle>& triangles, const Vec3& about) {
  if (mesh.inertia == MeshInertia::kShell) return shellMoments(triangles, about);
  return solidMoments(triangles, about, mesh.inertia == MeshInertia::kLegacy);
}

Mat3 inertiaOf(const Mat3& second) { return second.trace() * Mat3::Identity() - second; }

struct MeshSolid {
  double size;  // volume [m^3], of a shell area [m^2]
  Vec3 centre;
  Mat3 second_per_size;
};

// First the centre of mass, seen from the middle of the faces, then volume and inertia, seen from there: with
// tetrahedra that all count as positive the result depends on where they are seen from, and this is how MuJoCo does it.
MeshSolid solidOf(const RobotMesh& mesh) {
  const std::vector<Triangle> triangles = massTriangles(mesh);
  const Vec3 middle = middleOf(triangles);
  const Moments from_middle = momentsOf(mesh, triangles, middle);
  const Vec3 centre = middle + from_middle.first / from_middle.size;
  const Moments from_centre = momentsOf(mesh, triangles, centre);
  return {from_centre.size, centre, from_centre.second / from_centre.size};
}

// Solids of revolution and boxes about their own centre: the diagonal of int x x^T / volume.
Vec3 secondPerVolume(const RobotGeom& g) {
  const double r = g.half[0], l = g.half[1];
  switch (g.shape) {
    case RobotShape::kSphere:
      return Vec3::Constant(r * r / 5);
    case RobotShape::kEllipsoid:
      return g.half.cwiseAbs2() / 5;
    case RobotShape::kBox:
      return g.half.cwiseAbs2() / 3;
    case RobotShape::kCylinder:
      return {r * r / 4, r * r / 4, l * l / 3};
    case RobotShape::kCapsule: {
      // A cylinder of 2 l and two half balls, each with its centre of mass 3 r/8 beyond the cylinder's end.
      const double cylinder = 2 * l, ball = 4 * r / 3, whole = cylinder + ball;
      const double across = (cylinder * r * r / 4 + ball * r * r / 5) / whole;
      const double along = (cylinder * l * l / 3 + ball * (r * r / 5 + l * l + 0.75 * r * l)) / whole;
      return {across, across, along};
    }
    default:
      return Vec3::Zero();
  }
}

}  // namespace

double geomVolume(const RobotGeom& geom, const std::vector<RobotMesh>& meshes) {
  constexpr double kPi = std::numbers::pi;
  const double r = geom.half[0], l = geom.half[1];
  switch (geom.shape) {
    case RobotShape::kPlane:
      return 0;
    case RobotShape::kSphere:
      return 4 * kPi / 3 * r * r * r;
    case RobotShape::kCapsule:
      return kPi * r * r * (2 * l + 4 * r / 3);
    case RobotShape::kCylinder:
      return 2 * kPi * r * r * l;
    case RobotShape::kEllipsoid:
      return 4 * kPi / 3 * geom.half.prod();
    case RobotShape::kBox:
      return 8 * geom.half.prod();
    case RobotShape::kMesh:
      break;
  }
  return solidOf(meshes[static_cast<std::size_t>(geom.mesh)]).size;
}

MassProperties geomMass(const RobotGeom& geom, const std::vector<RobotMesh>& meshes) {
  if (geom.mass == 0) return {};
  if (geom.shape != RobotShape::kMesh) {
    return engine::movedBy(geom.X_BG,
                           {geom.mass, Vec3::Zero(), inertiaOf(geom.mass * Mat3(secondPerVolume(geom).asDiagonal()))});
  }
  const RobotMesh& mesh = meshes[static_cast<std::size_t>(geom.mesh)];
  const MeshSolid solid = solidOf(mesh);
  if (!(solid.size > 0)) {
    throw InputError(
        fmt::format("{}: the mesh \"{}\" has no volume, so its mass can't be spread over it. Give the body an "
                    "<inertial>, the geom mass=\"0\", "
                    "or the mesh inertia=\"shell\".",
                    geom.place, printable(mesh.name)));
  }
  return engine::movedBy(geom.X_BG, {geom.mass, solid.centre, inertiaOf(geom.mass * solid.second_per_size)});
}

}  // namespace pincer::tasks
