#include "tests/support/mesh_generators.h"

#include <fmt/format.h>
#include <fmt/ostream.h>

#include <algorithm>
#include <cmath>
#include <map>
#include <utility>

namespace pincer::contact {

namespace {

class Builder {
 public:
  explicit Builder(std::string name) { mesh_.source = std::move(name); }
  std::int32_t vertex(const Vec3& p) {
    mesh_.vertices.push_back(p);
    return static_cast<std::int32_t>(mesh_.vertices.size()) - 1;
  }
  void triangle(std::int32_t a, std::int32_t b, std::int32_t c) { mesh_.triangles.push_back({a, b, c}); }
  void quad(std::int32_t a, std::int32_t b, std::int32_t c, std::int32_t d) {
    triangle(a, b, c);
    triangle(a, c, d);
  }
  TriangleMesh mesh() { return std::move(mesh_); }

 private:
  TriangleMesh mesh_;
};

TriangleMesh subdividedOnUnitSphere(const TriangleMesh& coarse) {
  TriangleMesh fine;
  fine.source = coarse.source;
  fine.vertices = coarse.vertices;
  std::map<std::pair<std::int32_t, std::int32_t>, std::int32_t> middles;
  const auto middle = [&](std::int32_t a, std::int32_t b) {
    const auto [it, is_new] = middles.try_emplace(std::minmax(a, b), static_cast<std::int32_t>(fine.vertices.size()));
    if (is_new) {
      fine.vertices.push_back((fine.vertices[static_cast<std::size_t>(a)] + fine.vertices[static_cast<std::size_t>(b)]).normalized());
    }
    return it->second;
  };
  for (const auto& [a, b, c] : coarse.triangles) {
    const std::int32_t ab = middle(a, b), bc = middle(b, c), ca = middle(c, a);
    fine.triangles.insert(fine.triangles.end(), {{a, ab, ca}, {ab, b, bc}, {ca, bc, c}, {ab, bc, ca}});
  }
  return fine;
}

// A prism over the polygon of `angles` on the circle; its last side closes the polygon.
TriangleMesh prism(const std::string& name, double radius, double half_length, const std::vector<double>& angles, int rows) {
  Builder build(name);
  const auto n = static_cast<int>(angles.size());
  std::vector<std::int32_t> id;
  for (int k = 0; k <= rows; ++k) {
    const double z = -half_length + 2 * half_length * k / rows;
    for (const double a : angles) id.push_back(build.vertex({radius * std::cos(a), radius * std::sin(a), z}));
  }
  const auto at = [&](int k, int i) { return id[static_cast<std::size_t>(k * n + i % n)]; };
  for (int k = 0; k < rows; ++k) {
    for (int i = 0; i < n; ++i) build.quad(at(k, i), at(k, i + 1), at(k + 1, i + 1), at(k + 1, i));
  }
  const std::int32_t bottom = build.vertex({0, 0, -half_length}), top = build.vertex({0, 0, half_length});
  for (int i = 0; i < n; ++i) {
    build.triangle(bottom, at(0, i + 1), at(0, i));
    build.triangle(top, at(rows, i), at(rows, i + 1));
  }
  return build.mesh();
}

}  // namespace

TriangleMesh icosphere(double radius, int level) {
  const double t = (1 + std::sqrt(5.0)) / 2;
  TriangleMesh mesh;
  mesh.source = "icosphere";
  mesh.vertices = {{-1, t, 0},  {1, t, 0},  {-1, -t, 0}, {1, -t, 0}, {0, -1, t},  {0, 1, t},
                   {0, -1, -t}, {0, 1, -t}, {t, 0, -1},  {t, 0, 1},  {-t, 0, -1}, {-t, 0, 1}};
  mesh.triangles = {{0, 11, 5}, {0, 5, 1}, {0, 1, 7}, {0, 7, 10}, {0, 10, 11}, {1, 5, 9}, {5, 11, 4}, {11, 10, 2}, {10, 7, 6}, {7, 1, 8},
                    {3, 9, 4},  {3, 4, 2}, {3, 2, 6}, {3, 6, 8},  {3, 8, 9},   {4, 9, 5}, {2, 4, 11}, {6, 2, 10},  {8, 6, 7},  {9, 8, 1}};
  for (Vec3& v : mesh.vertices) v.normalize();
  for (int i = 0; i < level; ++i) mesh = subdividedOnUnitSphere(mesh);
  for (Vec3& v : mesh.vertices) v *= radius;
  return mesh;
}

TriangleMesh cylinderWithFlat(double radius, double half_length, double flat_distance, int segments, int rows) {
  const double first = std::acos(flat_distance / radius);
  std::vector<double> angles;
  for (int i = 0; i <= segments; ++i) angles.push_back(first + (2 * M_PI - 2 * first) * i / segments);
  return prism("cylinder with flat", radius, half_length, angles, rows);
}

TriangleMesh cylinder(double radius, double half_length, int segments, int rows) {
  std::vector<double> angles;
  for (int i = 0; i < segments; ++i) angles.push_back(2 * M_PI * i / segments);
  return prism("cylinder", radius, half_length, angles, rows);
}

TriangleMesh torus(double major, double minor, int major_segments, int minor_segments) {
  Builder build("torus");
  for (int i = 0; i < major_segments; ++i) {
    for (int j = 0; j < minor_segments; ++j) {
      const double a = 2 * M_PI * i / major_segments, b = 2 * M_PI * j / minor_segments;
      const double rho = major + minor * std::cos(b);
      build.vertex({rho * std::cos(a), rho * std::sin(a), minor * std::sin(b)});
    }
  }
  const auto at = [&](int i, int j) { return i % major_segments * minor_segments + j % minor_segments; };
  for (int i = 0; i < major_segments; ++i) {
    for (int j = 0; j < minor_segments; ++j) build.quad(at(i, j), at(i + 1, j), at(i + 1, j + 1), at(i, j + 1));
  }
  return build.mesh();
}

TriangleMesh roundedCube(double half, double rounding, int segments) {
  Builder build("rounded cube");
  const double core = half - rounding;
  std::vector<double> grid;  // on a cube's face, so that the roundings get equal angles
  for (int i = 0; i <= segments; ++i) grid.push_back(-core - rounding * std::tan(M_PI / 4 * (1 - static_cast<double>(i) / segments)));
  for (int i = 0; i <= segments; ++i) grid.push_back(core + rounding * std::tan(M_PI / 4 * i / segments));
  std::map<std::array<long, 3>, std::int32_t> known;
  const auto vertexUnder = [&](const Vec3& p) {
    const Vec3 c = p.cwiseMax(-core).cwiseMin(core);
    const Vec3 x = c + rounding * (p - c).normalized();
    const Vec3 key = x / half * 1e6;
    const auto [it, is_new] = known.try_emplace({std::lround(key.x()), std::lround(key.y()), std::lround(key.z())}, 0);
    if (is_new) it->second = build.vertex(x);
    return it->second;
  };
  for (int axis = 0; axis < 3; ++axis) {
    for (const double side : {-1.0, 1.0}) {
      const auto at = [&](std::size_t i, std::size_t j) {
        Vec3 p;
        p[axis] = side * half;
        p[(axis + 1) % 3] = grid[i];
        p[(axis + 2) % 3] = grid[j];
        return vertexUnder(p);
      };
      for (std::size_t i = 0; i + 1 < grid.size(); ++i) {
        for (std::size_t j = 0; j + 1 < grid.size(); ++j) {
          const std::int32_t a = at(i, j), b = at(i + 1, j), c = at(i + 1, j + 1), d = at(i, j + 1);
          side > 0 ? build.quad(a, b, c, d) : build.quad(a, d, c, b);
        }
      }
    }
  }
  return build.mesh();
}

TriangleMesh box(const Vec3& half) {
  Builder build("box");
  for (int i = 0; i < 8; ++i) build.vertex(half.cwiseProduct(Vec3(i & 1 ? 1 : -1, i & 2 ? 1 : -1, i & 4 ? 1 : -1)));
  build.quad(0, 2, 3, 1);
  build.quad(4, 5, 7, 6);
  build.quad(0, 1, 5, 4);
  build.quad(2, 6, 7, 3);
  build.quad(0, 4, 6, 2);
  build.quad(1, 3, 7, 5);
  return build.mesh();
}

void writeObj(std::ostream& out, const TriangleMesh& mesh, double unit) {
  for (const Vec3& v : mesh.vertices) fmt::print(out, "v {:.17g} {:.17g} {:.17g}\n", v.x() / unit, v.y() / unit, v.z() / unit);
  for (const Vec3& n : mesh.normals) fmt::print(out, "vn {:.17g} {:.17g} {:.17g}\n", n.x(), n.y(), n.z());
  for (std::size_t t = 0; t < mesh.triangles.size(); ++t) {
    fmt::print(out, "f");
    for (std::size_t i = 0; i < 3; ++i) {
      const bool has_normal = !mesh.triangle_normals.empty() && mesh.triangle_normals[t][i] >= 0;
      fmt::print(out, " {}", mesh.triangles[t][i] + 1);
      if (has_normal) fmt::print(out, "//{}", mesh.triangle_normals[t][i] + 1);
    }
    fmt::print(out, "\n");
  }
}

}  // namespace pincer::contact
