// vertex_normals: the shading normals at each vertex of a mesh, and which vertices a decimation may move
// (decimation.h).
#pragma once
#include <algorithm>
#include <vector>

#include "pincer/contact/mesh/connectivity.h"
#include "pincer/contact/mesh/half_edges.h"
#include "pincer/contact/triangle_mesh.h"

namespace pincer::contact {

// One normal per side of a vertex's creases. A vertex in `kept` stays (by indices; empty: none does).
class VertexNormals {
 public:
  VertexNormals(const TriangleMesh& mesh, const CornerNormals& corners, const std::vector<bool>& kept)
      : at_(mesh.vertices.size()), on_crease(mesh.vertices.size()), stays(kept) {
    stays.resize(mesh.vertices.size());
    for (std::size_t t = 0; t < mesh.triangles.size(); ++t) {
      for (std::size_t i = 0; i < 3; ++i) add(mesh.triangles[t][i], corners.normals[t][i]);
    }
    findCreases(mesh, corners);
  }

  // The one that belongs to a facet.
  const Vec3& nearest(std::size_t vertex, const Vec3& facet) const {
    const std::vector<Vec3>& normals = at_[vertex];
    return *std::max_element(normals.begin(), normals.end(),
                             [&](const Vec3& a, const Vec3& b) { return a.dot(facet) < b.dot(facet); });
  }

 private:
  void add(std::int32_t vertex, const Vec3& n) {
    std::vector<Vec3>& normals = at_[static_cast<std::size_t>(vertex)];
    if (std::find(normals.begin(), normals.end(), n) == normals.end()) normals.push_back(n);
  }

  // A vertex with two creases that go straight on, to 40 degrees, is inside a crease; any other with creases stays.
  void findCreases(const TriangleMesh& mesh, const CornerNormals& corners) {
    constexpr double kStraight = 0.468;  // |a + b|^2 of unit directions that miss opposite ones by 40 degrees
    std::vector<int> creases(at_.size(), 0);
    std::vector<Vec3> sum(at_.size(), Vec3::Zero());
    forEachEdge(sortedHalfEdges(mesh.triangles), [&](auto edge) {
      if (!corners.sharp[static_cast<std::size_t>(edge[0].triangle)][static_cast<std::size_t>(edge[0].side)]) return;
      const auto low = static_cast<std::size_t>(edge[0].low), high = static_cast<std::size_t>(edge[0].high);
      const Vec3 way = (mesh.vertices[high] - mesh.vertices[low]).normalized();
      ++creases[low];
      ++creases[high];
      sum[low] += way;
      sum[high] -= way;
    });
    for (std::size_t v = 0; v < creases.size(); ++v) {
      on_crease[v] = creases[v] > 0;
      stays[v] = stays[v] || (on_crease[v] && (creases[v] != 2 || sum[v].squaredNorm() > kStraight));
    }
  }

  std::vector<std::vector<Vec3>> at_;

 public:
  std::vector<bool> on_crease, stays;
};

}  // namespace pincer::contact
