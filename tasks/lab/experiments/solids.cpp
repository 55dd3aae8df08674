#include "pincer/tasks/lab/experiments/solids.h"

#include <fmt/format.h>

#include <cmath>
#include <numbers>

#include "pincer/contact/error.h"
#include "pincer/contact/generated_meshes.h"
#include "pincer/contact/mesh/lathe.h"
#include "pincer/contact/mesh/round_edges.h"

namespace pincer::tasks {
namespace {

std::vector<Vec2> prismProfile(double radius, double half) {
  return {{0, -half}, {radius, -half}, {radius, half}, {0, half}};
}
std::vector<Vec2> pyramidProfile(double radius, double half) { return {{0, -half}, {radius, -half}, {0, half}}; }

std::vector<Vec2> ballProfile(double radius, int sides) {
  std::vector<Vec2> profile;
  const int steps = sides / 2;
  for (int k = 0; k <= steps; ++k) {
    const double a = std::numbers::pi * k / steps;
    profile.emplace_back(k == 0 || k == steps ? 0 : radius * math::sin(a), -radius * math::cos(a));
  }
  return profile;
}

// About z, a corner on +x.
contact::TriangleMesh uprightSolid(const std::string& name, const SolidSizes& s, int sides) {
  const double half = 0.5 * s.length;
  if (name == "cone") return contact::lathe(pyramidProfile(s.radius, half), sides);
  if (name == "cylinder") return contact::lathe(prismProfile(s.radius, half), sides);
  if (name == "cube") return contact::lathe(prismProfile(s.radius, s.radius / std::numbers::sqrt2), 4);
  if (name == "sphere") return contact::lathe(ballProfile(s.radius, sides), sides);
  if (name == "tetrahedron") return contact::lathe(pyramidProfile(s.radius, half), 3);
  if (name == "octagon") return contact::lathe(prismProfile(s.radius, half), 8);
  if (name == "triangle") return contact::lathe(prismProfile(s.radius, half), 3);
  throw InputError(
      fmt::format("shape-identification: there is no solid \"{}\". Take cone, cylinder, cube, sphere, tetrahedron, "
                  "octagon or triangle.",
                  name));
}

// z to the right, +x up; a face up by half of what lies between two corners.
Quat lyingPose(const std::string& name, bool points_left) {
  Mat3 R;
  R << Vec3::UnitZ(), -Vec3::UnitY(), Vec3::UnitX();
  const double pi = std::numbers::pi;
  const double turn = name == "cube" ? pi / 4 : name == "octagon" ? pi / 8 : 0;
  return quatFromRotationVector((points_left ? pi : 0) * Vec3::UnitZ()) * Quat(R) *
         quatFromRotationVector(turn * Vec3::UnitZ());
}

}  // namespace

bool isPointed(const std::string& name) { return name == "cone" || name == "tetrahedron"; }

std::shared_ptr<const contact::SmoothMesh> makeSolid(const std::string& name, bool shaded, const SolidSizes& sizes,
                                                     bool points_left) {
  contact::TriangleMesh mesh = contact::transformed(uprightSolid(name, sizes, shaded ? sizes.sides : sizes.facet_sides),
                                                    {lyingPose(name, points_left), Vec3::Zero()});
  mesh.source = name;
  contact::SurfaceOptions options;
  if (!shaded) {
    options.variant = contact::SurfaceVariant::facet;
    return contact::SmoothMesh::build(mesh, options);
  }
  contact::RoundOptions rounding;
  rounding.radius = sizes.edge_radius;
  return contact::SmoothMesh::build(contact::roundEdges(mesh, rounding).mesh, options);
}

}  // namespace pincer::tasks
