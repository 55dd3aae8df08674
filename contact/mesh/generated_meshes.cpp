#include "pincer/contact/generated_meshes.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <map>
#include <utility>

#include "pincer/contact/functions/invariants.h"

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

// Vertices closer than 1e-6 of the size are one.
class GridWelder {
 public:
  GridWelder(std::string name, double size) : build_(std::move(name)), size_(size) {}
  std::int32_t vertex(const Vec3& p) {
    const Vec3 key = p / size_ * 1e6;
    const auto [it, is_new] = known_.try_emplace({std::lround(key.x()), std::lround(key.y()), std::lround(key.z())}, 0);
    if (is_new) it->second = build_.vertex(p);
    return it->second;
  }
  void quad(std::int32_t a, std::int32_t b, std::int32_t c, std::int32_t d, bool flipped) {
    flipped ? build_.quad(a, d, c, b) : build_.quad(a, b, c, d);
  }
  TriangleMesh mesh() { return build_.mesh(); }

 private:
  Builder build_;
  double size_;
  std::map<std::array<long, 3>, std::int32_t> known_;
};

TriangleMesh subdividedOnUnitSphere(const TriangleMesh& coarse) {
  TriangleMesh fine;
  fine.source = coarse.source;
  fine.vertices = coarse.vertices;
  std::map<std::pair<std::int32_t, std::int32_t>, std::int32_t> middles;
  const auto middle = [&](std::int32_t a, std::int32_t b) {
    const auto [it, is_new] = middles.try_emplace(std::minmax(a, b), static_cast<std::int32_t>(fine.vertices.size()));
    if (is_new) {
      fine.vertices.push_back(
          (fine.vertices[static_cast<std::size_t>(a)] + fine.vertices[static_cast<std::size_t>(b)]).normalized());
    }
    return it->second;
  };
  for (const auto& [a, b, c] : coarse.triangles) {
    const std::int32_t ab = middle(a, b), bc = middle(b, c), ca = middle(c, a);
    fine.triangles.insert(fine.triangles.end(), {{a, ab, ca}, {ab, b, bc}, {ca, bc, c}, {ab, bc, ca}});
  }
  return fine;
}

TriangleMesh icosahedron() {
  const double t = (1 + std::sqrt(5.0)) / 2;
  TriangleMesh mesh;
  mesh.vertices = {{-1, t, 0},  {1, t, 0},  {-1, -t, 0}, {1, -t, 0}, {0, -1, t},  {0, 1, t},
                   {0, -1, -t}, {0, 1, -t}, {t, 0, -1},  {t, 0, 1},  {-t, 0, -1}, {-t, 0, 1}};
  mesh.triangles = {{0, 11, 5},  {0, 5, 1},  {0, 1, 7},  {0, 7, 10}, {0, 10, 11}, {1, 5, 9}, {5, 11, 4},
                    {11, 10, 2}, {10, 7, 6}, {7, 1, 8},  {3, 9, 4},  {3, 4, 2},   {3, 2, 6}, {3, 6, 8},
                    {3, 8, 9},   {4, 9, 5},  {2, 4, 11}, {6, 2, 10}, {8, 6, 7},   {9, 8, 1}};
  for (Vec3& v : mesh.vertices) v.normalize();
  return mesh;
}

// Each triangle cut into n^2 equal ones; vertices on its sides are shared with the neighbour's,
// computed once from the side's lower end.
class FlatSubdivision {
 public:
  FlatSubdivision(const TriangleMesh& coarse, int n) : coarse_(coarse), n_(n) { fine_.vertices = coarse.vertices; }

  TriangleMesh run() {
    for (std::size_t t = 0; t < coarse_.triangles.size(); ++t) divide(coarse_.triangles[t]);
    return std::move(fine_);
  }

 private:
  using Triangle = std::array<std::int32_t, 3>;

  void divide(const Triangle& t) {
    std::vector<std::int32_t> row = {t[0]};
    for (int i = 1; i <= n_; ++i) {  // row i is i steps away from corner 0
      std::vector<std::int32_t> next = {onSide(t[0], t[1], i)};
      for (int k = 1; k < i; ++k) next.push_back(i < n_ ? inside(t, i, k) : onSide(t[1], t[2], k));
      next.push_back(onSide(t[0], t[2], i));
      for (std::size_t k = 0; k < row.size(); ++k) {
        fine_.triangles.push_back({row[k], next[k], next[k + 1]});
        if (k + 1 < row.size()) fine_.triangles.push_back({row[k], next[k + 1], row[k + 1]});
      }
      row = std::move(next);
    }
  }
  std::int32_t onSide(std::int32_t a, std::int32_t b, int k) {
    if (a > b) return onSide(b, a, n_ - k);
    if (k == 0 || k == n_) return k == 0 ? a : b;
    const auto [it, is_new] = first_on_side_.try_emplace({a, b}, static_cast<std::int32_t>(fine_.vertices.size()));
    for (int i = 1; is_new && i < n_; ++i) add((corner(a) * (n_ - i) + corner(b) * i) / n_);
    return it->second + k - 1;
  }
  std::int32_t inside(const Triangle& t, int i, int k) {
    return add((corner(t[0]) * (n_ - i) + corner(t[1]) * (i - k) + corner(t[2]) * k) / n_);
  }
  std::int32_t add(const Vec3& p) {
    fine_.vertices.push_back(p);
    return static_cast<std::int32_t>(fine_.vertices.size()) - 1;
  }
  const Vec3& corner(std::int32_t v) const { return coarse_.vertices[static_cast<std::size_t>(v)]; }

  const TriangleMesh& coarse_;
  int n_;
  TriangleMesh fine_;
  std::map<std::pair<std::int32_t, std::int32_t>, std::int32_t> first_on_side_;
};

// A prism over the polygon of `angles` on the circle; its last side closes the polygon.
TriangleMesh prism(const std::string& name, double radius, double half_length, const std::vector<double>& angles,
                   int rows) {
  PINCER_DEMAND(radius > 0 && half_length > 0 && angles.size() >= 3 && rows >= 1,
                "cylinders: positive lengths, 3 sides and 1 row at least");
  Builder build(name);
  const auto n = static_cast<int>(angles.size());
  std::vector<std::int32_t> id;
  for (int k = 0; k <= rows; ++k) {
    const double z = -half_length + 2 * half_length * k / rows;
    for (const double a : angles) id.push_back(build.vertex({radius * math::cos(a), radius * math::sin(a), z}));
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
  PINCER_DEMAND(radius > 0 && level >= 0, "icosphere: a positive radius, cut 0 times or more");
  TriangleMesh mesh = icosahedron();
  mesh.source = "icosphere";
  for (int i = 0; i < level; ++i) mesh = subdividedOnUnitSphere(mesh);
  for (Vec3& v : mesh.vertices) v *= radius;
  return mesh;
}

TriangleMesh geodesicSphere(double radius, int n) {
  PINCER_DEMAND(radius > 0 && n >= 1, "geodesicSphere: a positive radius, sides cut into 1 part or more");
  const TriangleMesh coarse = icosahedron();
  TriangleMesh mesh = FlatSubdivision(coarse, n).run();
  mesh.source = "geodesic sphere";
  for (Vec3& v : mesh.vertices) v = radius * v.normalized();
  return mesh;
}

TriangleMesh cylinderWithFlat(double radius, double half_length, double flat_distance, int segments, int rows) {
  PINCER_DEMAND(0 < flat_distance && flat_distance < radius,
                "cylinderWithFlat: the flat lies between the axis and the round wall");
  const double first = math::acos(flat_distance / radius);
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
  PINCER_DEMAND(0 < minor && minor < major, "torus: the tube is thinner than its way round");
  PINCER_DEMAND(major_segments >= 3 && minor_segments >= 3, "torus: 3 segments at least either way");
  Builder build("torus");
  for (int i = 0; i < major_segments; ++i) {
    for (int j = 0; j < minor_segments; ++j) {
      const double a = 2 * M_PI * i / major_segments, b = 2 * M_PI * j / minor_segments;
      const double rho = major + minor * math::cos(b);
      build.vertex({rho * math::cos(a), rho * math::sin(a), minor * math::sin(b)});
    }
  }
  const auto at = [&](int i, int j) { return i % major_segments * minor_segments + j % minor_segments; };
  for (int i = 0; i < major_segments; ++i) {
    for (int j = 0; j < minor_segments; ++j) build.quad(at(i, j), at(i + 1, j), at(i + 1, j + 1), at(i, j + 1));
  }
  return build.mesh();
}

TriangleMesh roundedCube(double half, double rounding, int segments) {
  PINCER_DEMAND(0 < rounding && rounding < half && segments >= 1,
                "roundedCube: a rounding below half the edge, in 1 segment or more");
  GridWelder weld("rounded cube", half);
  const double core = half - rounding;
  std::vector<double> grid;  // on a cube's face, so that the roundings get equal angles
  for (int i = 0; i <= segments; ++i)
    grid.push_back(-core - rounding * math::tan(M_PI / 4 * (1 - static_cast<double>(i) / segments)));
  for (int i = 0; i <= segments; ++i) grid.push_back(core + rounding * math::tan(M_PI / 4 * i / segments));
  const auto vertexUnder = [&](const Vec3& p) {
    const Vec3 c = p.cwiseMax(-core).cwiseMin(core);
    return weld.vertex(c + rounding * (p - c).normalized());
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
          weld.quad(at(i, j), at(i + 1, j), at(i + 1, j + 1), at(i, j + 1), side < 0);
        }
      }
    }
  }
  return weld.mesh();
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

TriangleMesh gridBox(const Vec3& half, int cells) {
  PINCER_DEMAND(half.minCoeff() > 0 && cells >= 1, "gridBox: positive half edges, cut into 1 cell or more");
  GridWelder weld("box", half.maxCoeff());
  for (int axis = 0; axis < 3; ++axis) {
    for (const double side : {-1.0, 1.0}) {
      const auto at = [&](int i, int k) {
        Vec3 p;
        p[axis] = side;
        p[(axis + 1) % 3] = 2.0 * i / cells - 1;
        p[(axis + 2) % 3] = 2.0 * k / cells - 1;
        return weld.vertex(half.cwiseProduct(p));
      };
      for (int i = 0; i < cells; ++i) {
        for (int k = 0; k < cells; ++k) weld.quad(at(i, k), at(i + 1, k), at(i + 1, k + 1), at(i, k + 1), side < 0);
      }
    }
  }
  return weld.mesh();
}

TriangleMesh uvSphere(double radius, int rings, int segments) {
  PINCER_DEMAND(radius > 0 && rings >= 2 && segments >= 3,
                "uvSphere: a positive radius, 2 rings and 3 segments at least");
  Builder build("uv sphere");
  for (int k = 1; k < rings; ++k) {
    for (int i = 0; i < segments; ++i) {
      const double a = M_PI * k / rings, b = 2 * M_PI * i / segments;
      build.vertex(radius * Vec3(math::sin(a) * math::cos(b), math::sin(a) * math::sin(b), math::cos(a)));
    }
  }
  const std::int32_t north = build.vertex({0, 0, radius}), south = build.vertex({0, 0, -radius});
  const auto at = [&](int k, int i) { return k * segments + i % segments; };
  for (int i = 0; i < segments; ++i) {
    build.triangle(north, at(0, i), at(0, i + 1));
    for (int k = 0; k + 2 < rings; ++k) build.quad(at(k, i), at(k + 1, i), at(k + 1, i + 1), at(k, i + 1));
    build.triangle(south, at(rings - 2, i + 1), at(rings - 2, i));
  }
  return build.mesh();
}

TriangleMesh ellipsoid(const Vec3& half, int n) {
  TriangleMesh mesh = geodesicSphere(1, n);
  mesh.source = "ellipsoid";
  for (Vec3& v : mesh.vertices) v = half.cwiseProduct(v);
  return mesh;
}

TriangleMesh bumpySphere(double radius, double amplitude, double waves, int n) {
  PINCER_DEMAND(0 <= amplitude && amplitude < 1, "bumpySphere: an amplitude in [0, 1)");
  TriangleMesh mesh = geodesicSphere(1, n);
  mesh.source = "bumpy sphere";
  for (Vec3& d : mesh.vertices) {
    const double f = math::sin(waves * d.x()) * math::sin(waves * d.y() + 1) * math::sin(waves * d.z() + 2);
    d *= radius * (1 + amplitude * f);
  }
  return mesh;
}

TriangleMesh grooveBlock(double half_angle, double depth, double half_width, double half_length) {
  const double opening = depth * math::tan(half_angle);
  const std::array<Vec2, 7> outline = {{{-half_width, -depth},  // (x, z), counter-clockwise seen from -y
                                        {half_width, -depth},
                                        {half_width, depth},
                                        {opening, depth},
                                        {0, 0},
                                        {-opening, depth},
                                        {-half_width, depth}}};
  Builder build("groove");
  for (const double y : {-half_length, half_length}) {
    for (const Vec2& p : outline) build.vertex({p.x(), y, p.y()});
  }
  for (int i = 0; i < 7; ++i) {
    const int k = (i + 1) % 7;
    build.quad(i, 7 + i, 7 + k, k);
  }
  // Triangles of an end by points of the outline; it is hollow at point 4, so no triangle spans the groove.
  constexpr std::array<std::array<int, 3>, 5> kEnd = {{{0, 4, 6}, {4, 5, 6}, {0, 1, 4}, {1, 2, 4}, {2, 3, 4}}};
  for (const auto& [a, b, c] : kEnd) {
    build.triangle(a, b, c);
    build.triangle(7 + a, 7 + c, 7 + b);
  }
  return build.mesh();
}

TriangleMesh noisy(TriangleMesh mesh, double amplitude, std::uint64_t seed) {
  mesh.source = "noisy " + mesh.source;
  for (Vec3& v : mesh.vertices) {
    for (int k = 0; k < 3; ++k) {  // SplitMix64: G. Steele, D. Lea, C. Flood, OOPSLA 2014
      std::uint64_t z = (seed += 0x9e3779b97f4a7c15u);
      z = (z ^ (z >> 30)) * 0xbf58476d1ce4e5b9u;
      z = (z ^ (z >> 27)) * 0x94d049bb133111ebu;
      z ^= z >> 31;
      v[k] += amplitude * (2 * static_cast<double>(z >> 11) * 0x1p-53 - 1);
    }
  }
  return mesh;
}

TriangleMesh transformed(TriangleMesh mesh, const Pose& X, double factor) {
  PINCER_DEMAND(isUnit(X.q), "transformed: the quaternion has length 1; normalise it");
  for (Vec3& v : mesh.vertices) v = X * (factor * v);
  for (Vec3& n : mesh.normals) n = X.q * n;
  return mesh;
}

}  // namespace pincer::contact
