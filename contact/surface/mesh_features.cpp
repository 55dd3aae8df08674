#include "pincer/contact/surface/mesh_features.h"

#include <algorithm>
#include <cmath>
#include <numeric>

#include "pincer/contact/functions/invariants.h"

namespace pincer::contact {
namespace {

Vec3 crossOf(const TriangleMesh& mesh, const std::array<std::int32_t, 3>& t) {
  const auto at = [&](std::size_t i) -> const Vec3& { return mesh.vertices[static_cast<std::size_t>(t[i])]; };
  return (at(1) - at(0)).cross(at(2) - at(0));
}

std::vector<Aabb> boxesOf(const TriangleMesh& mesh, const std::vector<std::int32_t>& triangles) {
  std::vector<Aabb> boxes;
  boxes.reserve(triangles.size());
  for (const std::int32_t number : triangles) {
    const auto& t = mesh.triangles[static_cast<std::size_t>(number)];
    const auto at = [&](std::size_t i) -> const Vec3& { return mesh.vertices[static_cast<std::size_t>(t[i])]; };
    boxes.push_back({at(0).cwiseMin(at(1)).cwiseMin(at(2)), at(0).cwiseMax(at(1)).cwiseMax(at(2))});
  }
  return boxes;
}

std::vector<std::int32_t> allOf(const TriangleMesh& mesh) {
  std::vector<std::int32_t> all(mesh.triangles.size());
  std::iota(all.begin(), all.end(), 0);
  return all;
}

constexpr double kFlat = 1e-6;  // sine of the angle across or along an edge that counts as none

// The convex edges and borders that end in a vertex.
class SharpEdges {
 public:
  void add(const Vec3& outwards) {
    const Vec3 e = outwards.normalized();
    if (count_ == 0) first_ = e;
    bends_ = bends_ || (count_ > 0 && (first_ + e).squaredNorm() > kFlat * kFlat);
    ++count_;
  }
  // One straight edge that goes on through the vertex makes none.
  bool makeCorner() const { return count_ == 1 || bends_; }

 private:
  Vec3 first_ = Vec3::Zero();
  int count_ = 0;
  bool bends_ = false;
};

// Nearest point of a triangle to the origin, and which corners it lies between: bit i for corner i.
struct OnTriangle {
  Vec3 p;
  int corners;
};

OnTriangle nearestOfTriangle(const Vec3& a, const Vec3& b, const Vec3& c) {
  const Vec3 ab = b - a, ac = c - a, bc = c - b;
  const double a1 = -ab.dot(a), a2 = -ac.dot(a);
  if (a1 <= 0 && a2 <= 0) return {a, 1};
  const double b1 = -ab.dot(b), b2 = -ac.dot(b);
  if (b1 >= 0 && b2 <= b1) return {b, 2};
  const double on_ab = a1 * b2 - b1 * a2;
  if (on_ab <= 0 && a1 >= 0 && b1 <= 0) return {a + a1 / (a1 - b1) * ab, 3};
  const double c1 = -ab.dot(c), c2 = -ac.dot(c);
  if (c2 >= 0 && c1 <= c2) return {c, 4};
  const double on_ac = c1 * a2 - a1 * c2;
  if (on_ac <= 0 && a2 >= 0 && c2 <= 0) return {a + a2 / (a2 - c2) * ac, 5};
  const double on_bc = b1 * c2 - c1 * b2;
  if (on_bc <= 0 && b2 - b1 >= 0 && c1 - c2 >= 0) return {b + (b2 - b1) / ((b2 - b1) + (c1 - c2)) * bc, 6};
  const Vec3 n = ab.cross(ac);
  return {a.dot(n) / n.squaredNorm() * n, 7};
}

}  // namespace

MeshFeatures::MeshFeatures(const TriangleMesh& mesh, const Neighbours& neighbours)
    : mesh_(&mesh),
      owned_(mesh.triangles.size(), 0),
      opposite_(mesh.triangles.size()),
      tree_(boxesOf(mesh, allOf(mesh))),
      owner_numbers_(findOwners(neighbours)),
      owners_(boxesOf(mesh, owner_numbers_)) {
  setTrianglesAtVertices();
}

// At least one: what has no convex edge and no border has no volume.
std::vector<std::int32_t> MeshFeatures::findOwners(const Neighbours& neighbours) {
  setOwners(neighbours);
  std::vector<std::int32_t> owners;
  for (std::size_t t = 0; t < owned_.size(); ++t) {
    if (owned_[t] != 0) owners.push_back(static_cast<std::int32_t>(t));
  }
  if (owners.empty()) owners.push_back(0);
  return owners;
}

void MeshFeatures::setOwners(const Neighbours& neighbours) {
  std::vector<SharpEdges> sharp(mesh_->vertices.size());
  for (std::size_t t = 0; t < owned_.size(); ++t) {
    const auto& corners = mesh_->triangles[t];
    const Vec3 n = crossOf(*mesh_, corners);
    for (std::size_t i = 0; i < 3; ++i) {
      const Neighbour& other = neighbours[t][i];
      const bool is_border = other.triangle < 0;
      opposite_[t][i] = is_border ? -1 : cornersOf(other.triangle)[(static_cast<std::size_t>(other.edge) + 2) % 3];
      if (!is_border && other.triangle < static_cast<std::int32_t>(t)) continue;  // has been seen from there
      const Vec3 &from = vertex(corners[i]), &to = vertex(corners[(i + 1) % 3]);
      if (!is_border) {
        const Vec3 across = vertex(opposite_[t][i]) - from;
        if (!(n.dot(across) < -kFlat * n.norm() * across.norm())) continue;
        owned_[t] |= static_cast<std::uint8_t>(8u << i);
      }
      sharp[static_cast<std::size_t>(corners[i])].add(to - from);
      sharp[static_cast<std::size_t>(corners[(i + 1) % 3])].add(from - to);
    }
  }
  for (std::size_t t = 0; t < owned_.size(); ++t) {
    for (std::size_t i = 0; i < 3; ++i) {
      SharpEdges& edges = sharp[static_cast<std::size_t>(mesh_->triangles[t][i])];
      if (edges.makeCorner()) owned_[t] |= static_cast<std::uint8_t>(1u << i);
      edges = {};
    }
  }
}

void MeshFeatures::setTrianglesAtVertices() {
  first_at_vertex_.assign(mesh_->vertices.size() + 1, 0);
  for (const auto& corners : mesh_->triangles) {
    for (const std::int32_t v : corners) ++first_at_vertex_[static_cast<std::size_t>(v) + 1];
  }
  std::partial_sum(first_at_vertex_.begin(), first_at_vertex_.end(), first_at_vertex_.begin());
  triangles_at_vertex_.resize(3 * mesh_->triangles.size());
  std::vector<std::int32_t> end(first_at_vertex_.begin(), first_at_vertex_.end() - 1);
  for (std::size_t t = 0; t < mesh_->triangles.size(); ++t) {
    for (const std::int32_t v : mesh_->triangles[t]) {
      triangles_at_vertex_[static_cast<std::size_t>(end[static_cast<std::size_t>(v)]++)] = static_cast<std::int32_t>(t);
    }
  }
}

std::size_t MeshFeatures::memoryBytes() const {
  return owned_.capacity() + opposite_.capacity() * sizeof(opposite_[0]) + tree_.memoryBytes() + owners_.memoryBytes() +
         (first_at_vertex_.capacity() + triangles_at_vertex_.capacity() + owner_numbers_.capacity()) *
             sizeof(std::int32_t);
}

std::span<const std::int32_t> MeshFeatures::trianglesAt(std::int32_t v) const {
  const auto begin = static_cast<std::size_t>(first_at_vertex_[static_cast<std::size_t>(v)]);
  return std::span(triangles_at_vertex_)
      .subspan(begin, static_cast<std::size_t>(first_at_vertex_[static_cast<std::size_t>(v) + 1]) - begin);
}

MeshFeatures::Triangle MeshFeatures::triangle(std::int32_t t) const {
  PINCER_ASSERT(isIndex(t, mesh_->triangles.size()));
  const auto at = static_cast<std::size_t>(t);
  const auto& v = cornersOf(t);
  Triangle triangle{{vertex(v[0]), vertex(v[1]), vertex(v[2])}, crossOf(*mesh_, v).normalized(), v, owned_[at], {}};
  for (std::size_t i = 0; i < 3; ++i) {
    if (triangle.ownsEdge(static_cast<int>(i))) triangle.beyond[i] = vertex(opposite_[at][i]);
  }
  return triangle;
}

bool MeshFeatures::Triangle::isUnder(const Vec3& q, double slack) const {
  for (int i = 0; i < 3; ++i) {
    const Vec3 edge = corner(i + 1) - corner(i);
    const double inside = n.cross(edge).dot(q - corner(i));  // times the edge's length
    if (inside < 0 && inside * inside > slack * slack * edge.squaredNorm()) return false;
  }
  return true;
}

Vec3 MeshFeatures::normalAround(std::int32_t v) const {
  Vec3 sum = Vec3::Zero();
  for (const std::int32_t t : trianglesAt(v)) {
    const auto& corners = cornersOf(t);
    const std::size_t i = corners[0] == v ? 0 : corners[1] == v ? 1 : 2;
    const Vec3 e = vertex(corners[(i + 1) % 3]) - vertex(v), f = vertex(corners[(i + 2) % 3]) - vertex(v);
    sum += angleBetween(e, f) * e.cross(f).normalized();
  }
  return sum;
}

Vec3 MeshFeatures::normalAcross(std::int32_t t, int edge) const {
  const auto i = static_cast<std::size_t>(edge);
  const Vec3 n = crossOf(*mesh_, cornersOf(t)).normalized();
  const std::int32_t beyond = opposite_[static_cast<std::size_t>(t)][i];
  if (beyond < 0) return n;
  const Vec3 &from = vertex(cornersOf(t)[i]), &to = vertex(cornersOf(t)[(i + 1) % 3]);
  return n + (from - to).cross(vertex(beyond) - to).normalized();
}

MeshFeatures::Nearest MeshFeatures::nearest(const Vec3& q, double bound) const {
  PINCER_ASSERT(!(bound < 0));
  constexpr double kOnSurface = 1e-20;  // [m^2]
  double bound2 = bound * bound;
  std::int32_t best = -1;
  OnTriangle on{Vec3::Zero(), 0};
  tree_.visitNear(q, bound2, [&](std::int32_t place) {
    const std::int32_t t = tree_.order()[static_cast<std::size_t>(place)];
    const auto& v = cornersOf(t);
    const OnTriangle s = nearestOfTriangle(vertex(v[0]) - q, vertex(v[1]) - q, vertex(v[2]) - q);
    const double distance2 = s.p.squaredNorm();
    if (!(distance2 < bound2 || (best >= 0 && distance2 == bound2 && t < best))) return;
    bound2 = distance2;
    best = t;
    on = s;
  });
  if (best < 0) return {};
  const auto& v = cornersOf(best);
  const Vec3 n = on.corners == 7   ? crossOf(*mesh_, v)
                 : on.corners == 3 ? normalAcross(best, 0)
                 : on.corners == 6 ? normalAcross(best, 1)
                 : on.corners == 5 ? normalAcross(best, 2)
                                   : normalAround(v[on.corners == 1   ? 0
                                                    : on.corners == 2 ? 1
                                                                      : 2]);
  const double side = n.dot(on.p) > 0 ? -1 : 1;  // on.p is the surface's point seen from q
  const double distance = std::sqrt(bound2);
  return {q + on.p, bound2 > kOnSurface ? Vec3(-side / distance * on.p) : Vec3(n.normalized()), side * distance, true};
}

bool MeshFeatures::liesAbove(std::int32_t v, const Vec3& n, double slack) const {
  PINCER_ASSERT(isUnitIfFinite(n));
  const Vec3& p = vertex(v);
  for (const std::int32_t t : trianglesAt(v)) {
    for (const std::int32_t other : cornersOf(t)) {
      const Vec3 e = vertex(other) - p;
      const double rise = n.dot(e);
      if (rise < 0 && rise * rise > slack * slack * e.squaredNorm()) return false;
    }
  }
  return true;
}

}  // namespace pincer::contact
