#include "contact/surface/surface_net.h"

#include <limits>

#include "contact/surface/edge_cubic.h"

namespace pincer::contact {

namespace {

Vec3& firstHandle(Patch& p, std::size_t edge) { return edge == 0 ? p.b210 : edge == 1 ? p.b021 : p.b102; }
Vec3& secondHandle(Patch& p, std::size_t edge) { return edge == 0 ? p.b120 : edge == 1 ? p.b012 : p.b201; }

std::size_t next(std::size_t i) { return (i + 1) % 3; }

// The ends of edge i of triangle t, as seen along it.
std::array<EdgeEnd, 2> edgeEnds(const TriangleMesh& mesh, const CornerNormals& corners, std::size_t t, std::size_t i,
                                const Neighbour& other) {
  const auto position = [&](std::size_t corner) { return mesh.vertices[static_cast<std::size_t>(mesh.triangles[t][corner])]; };
  const Vec3 &left0 = corners.normals[t][i], &left1 = corners.normals[t][next(i)];
  if (other.triangle < 0) return {EdgeEnd{position(i), left0, left0}, EdgeEnd{position(next(i)), left1, left1}};
  const auto& opposite = corners.normals[static_cast<std::size_t>(other.triangle)];
  const auto j = static_cast<std::size_t>(other.edge);
  return {EdgeEnd{position(i), left0, opposite[next(j)]}, EdgeEnd{position(next(i)), left1, opposite[j]}};
}

void setCorners(const TriangleMesh& mesh, const CornerNormals& corners, std::size_t t, Patch& patch) {
  const auto& v = mesh.triangles[t];
  patch.b300 = mesh.vertices[static_cast<std::size_t>(v[0])];
  patch.b030 = mesh.vertices[static_cast<std::size_t>(v[1])];
  patch.b003 = mesh.vertices[static_cast<std::size_t>(v[2])];
  patch.n200 = corners.normals[t][0];
  patch.n020 = corners.normals[t][1];
  patch.n002 = corners.normals[t][2];
  patch.n110 = middleNormal(patch.b300, patch.b030, patch.n200, patch.n020);
  patch.n011 = middleNormal(patch.b030, patch.b003, patch.n020, patch.n002);
  patch.n101 = middleNormal(patch.b003, patch.b300, patch.n002, patch.n200);
}

// Each edge is computed once, on its first side, and copied to the other: the two sides share it to the last bit.
void setEdge(const TriangleMesh& mesh, const CornerNormals& corners, std::size_t t, std::size_t i, std::vector<SurfaceCell>& cells) {
  SurfaceCell& cell = cells[t];
  const Neighbour other = cell.neighbours[i];
  if (other.triangle >= 0 && other.triangle < static_cast<std::int32_t>(t)) return;
  const auto [from, to] = edgeEnds(mesh, corners, t, i, other);
  const auto [first, second] = edgeHandles(from, to);
  firstHandle(cell.patch, i) = first;
  secondHandle(cell.patch, i) = second;
  cell.sharp[i] = other.triangle < 0 || from.left != from.right || to.left != to.right;
  if (other.triangle < 0) return;
  SurfaceCell& opposite = cells[static_cast<std::size_t>(other.triangle)];
  const auto j = static_cast<std::size_t>(other.edge);
  firstHandle(opposite.patch, j) = second;
  secondHandle(opposite.patch, j) = first;
  opposite.sharp[j] = cell.sharp[i];
}

// Vlachos et al.: the centre lies as far beyond the handles' mean as that lies beyond the flat triangle's, halved.
void setCentre(Patch& p) {
  const Vec3 handles = (p.b210 + p.b120 + p.b021 + p.b012 + p.b102 + p.b201) / 6;
  p.b111 = handles + (handles - (p.b300 + p.b030 + p.b003) / 3) / 2;
}

}  // namespace

SurfaceNet::SurfaceNet(const TriangleMesh& mesh, double crease_angle, bool use_file_normals) : cells_(mesh.triangles.size()) {
  const Neighbours neighbours = findNeighbours(mesh);
  const CornerNormals corners = findCornerNormals(mesh, neighbours, crease_angle, use_file_normals);
  first_corner_.assign(mesh.vertices.size() + 1, 0);
  for (std::size_t t = 0; t < cells_.size(); ++t) {
    cells_[t].neighbours = neighbours[t];
    cells_[t].vertices = mesh.triangles[t];
    setCorners(mesh, corners, t, cells_[t].patch);
    for (const std::int32_t v : mesh.triangles[t]) ++first_corner_[static_cast<std::size_t>(v) + 1];
  }
  for (std::size_t t = 0; t < cells_.size(); ++t) {
    for (std::size_t i = 0; i < 3; ++i) setEdge(mesh, corners, t, i, cells_);
  }
  for (SurfaceCell& cell : cells_) setCentre(cell.patch);

  for (std::size_t v = 1; v < first_corner_.size(); ++v) first_corner_[v] += first_corner_[v - 1];
  corners_.resize(3 * cells_.size());
  std::vector<std::size_t> end(first_corner_.begin(), first_corner_.end() - 1);
  for (std::size_t t = 0; t < cells_.size(); ++t) {
    for (std::int32_t i = 0; i < 3; ++i) {
      const auto v = static_cast<std::size_t>(mesh.triangles[t][static_cast<std::size_t>(i)]);
      corners_[end[v]++] = {static_cast<std::int32_t>(t), i};
    }
  }
}

std::span<const CellCorner> SurfaceNet::cornersAt(std::int32_t vertex) const {
  const auto v = static_cast<std::size_t>(vertex);
  return std::span(corners_).subspan(first_corner_[v], first_corner_[v + 1] - first_corner_[v]);
}

std::vector<std::int32_t> findFoldedTriangles(const SurfaceNet& net) {
  constexpr int kGrid = 6;
  const auto folds = [](const Patch& patch) {
    for (int i = 0; i <= kGrid; ++i) {
      for (int j = 0; i + j <= kGrid; ++j) {
        const PatchPoint x = evaluate(patch, static_cast<double>(i) / kGrid, static_cast<double>(j) / kGrid);
        if (!(x.Su.cross(x.Sv).dot(x.N) > 0)) return true;
      }
    }
    return false;
  };
  std::vector<std::int32_t> folded;
  for (std::size_t t = 0; t < net.cells().size(); ++t) {
    if (folds(net.cells()[t].patch)) folded.push_back(static_cast<std::int32_t>(t));
  }
  return folded;
}

double findTightestConcaveRadius(const SurfaceNet& net) {
  double sharpest = 0;
  for (const SurfaceCell& cell : net.cells()) {
    for (int i = 0; i < 3; ++i) {
      const auto p = edgeCurve(cell.patch, i);
      const auto n = edgeNormals(cell.patch, i);
      const Vec3 d = p[3] - p[0];
      sharpest = std::max(sharpest, -(n[2] - n[0]).dot(d) / d.squaredNorm());
    }
  }
  return sharpest > 0 ? 1 / sharpest : std::numeric_limits<double>::infinity();
}

}  // namespace pincer::contact
