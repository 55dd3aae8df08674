#include "contact/surface/surface_net.h"

#include <bit>
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

// Vlachos et al.: the centre lies as far beyond the handles' mean as that lies beyond the flat triangle's, halved.
void setCentre(Patch& p) {
  const Vec3 handles = (p.b210 + p.b120 + p.b021 + p.b012 + p.b102 + p.b201) / 6;
  p.b111 = handles + (handles - (p.b300 + p.b030 + p.b003) / 3) / 2;
}

// FNV-1a over what the patches depend on.
class Fingerprint {
 public:
  void add(std::uint64_t word) { hash_ = (hash_ ^ word) * 0x100000001b3ull; }
  void add(const Vec3& v) {
    for (int k = 0; k < 3; ++k) add(std::bit_cast<std::uint64_t>(v[k]));
  }
  std::uint64_t value() const { return hash_ ^ hash_ >> 32; }

 private:
  std::uint64_t hash_ = 0xcbf29ce484222325ull;
};

std::uint64_t fingerprintOf(const TriangleMesh& mesh, const CornerNormals& corners) {
  Fingerprint fingerprint;
  for (const Vec3& v : mesh.vertices) fingerprint.add(v);
  for (const auto& triangle : mesh.triangles) {
    for (const std::int32_t v : triangle) fingerprint.add(static_cast<std::uint64_t>(v));
  }
  for (const auto& normals : corners.normals) {
    for (const Vec3& n : normals) fingerprint.add(n);
  }
  return fingerprint.value();
}

}  // namespace

SurfaceNet::SurfaceNet(TriangleMesh mesh, double crease_angle, bool use_file_normals)
    : mesh_(std::move(mesh)),
      neighbours_(findNeighbours(mesh_)),
      corner_normals_(findCornerNormals(mesh_, neighbours_, crease_angle, use_file_normals)),
      fingerprint_(fingerprintOf(mesh_, corner_normals_)) {
  first_corner_.assign(mesh_.vertices.size() + 1, 0);
  for (const auto& triangle : mesh_.triangles) {
    for (const std::int32_t v : triangle) ++first_corner_[static_cast<std::size_t>(v) + 1];
  }
  for (std::size_t v = 1; v < first_corner_.size(); ++v) first_corner_[v] += first_corner_[v - 1];
  corners_.resize(3 * mesh_.triangles.size());
  std::vector<std::size_t> end(first_corner_.begin(), first_corner_.end() - 1);
  for (std::size_t t = 0; t < mesh_.triangles.size(); ++t) {
    for (std::int32_t i = 0; i < 3; ++i) {
      const auto v = static_cast<std::size_t>(mesh_.triangles[t][static_cast<std::size_t>(i)]);
      corners_[end[v]++] = {static_cast<std::int32_t>(t), i};
    }
  }
}

// Each edge is computed as its first triangle sees it: the two sides share it to the last bit.
SurfaceCell SurfaceNet::build(std::int32_t triangle) const {
  const auto t = static_cast<std::size_t>(triangle);
  SurfaceCell cell{{}, neighbours_[t], mesh_.triangles[t], {}};
  setCorners(mesh_, corner_normals_, t, cell.patch);
  for (std::size_t i = 0; i < 3; ++i) {
    const Neighbour other = cell.neighbours[i];
    const bool is_first = other.triangle < 0 || triangle < other.triangle;
    const auto [from, to] = is_first ? edgeEnds(mesh_, corner_normals_, t, i, other)
                                     : edgeEnds(mesh_, corner_normals_, static_cast<std::size_t>(other.triangle),
                                                static_cast<std::size_t>(other.edge), {triangle, static_cast<std::int8_t>(i)});
    const auto [first, second] = edgeHandles(from, to);
    firstHandle(cell.patch, i) = is_first ? first : second;
    secondHandle(cell.patch, i) = is_first ? second : first;
    cell.sharp[i] = other.triangle < 0 || from.left != from.right || to.left != to.right;
  }
  setCentre(cell.patch);
  return cell;
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
  for (std::int32_t t = 0; t < net.size(); ++t) {
    if (folds(net.build(t).patch)) folded.push_back(t);
  }
  return folded;
}

double findTightestConcaveRadius(const SurfaceNet& net) {
  double sharpest = 0;
  for (std::int32_t t = 0; t < net.size(); ++t) {
    const Patch patch = net.build(t).patch;
    for (int i = 0; i < 3; ++i) {
      const auto p = edgeCurve(patch, i);
      const auto n = edgeNormals(patch, i);
      const Vec3 d = p[3] - p[0];
      sharpest = std::max(sharpest, -(n[2] - n[0]).dot(d) / d.squaredNorm());
    }
  }
  return sharpest > 0 ? 1 / sharpest : std::numeric_limits<double>::infinity();
}

}  // namespace pincer::contact
