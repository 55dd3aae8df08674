#include "pincer/contact/mesh/mesh_pieces.h"

#include <cmath>

#include "pincer/contact/functions/invariants.h"

namespace pincer::contact {

namespace {

const Vec3& cornerOf(const TriangleMesh& mesh, std::size_t t, std::size_t i) {
  return mesh.vertices[static_cast<std::size_t>(mesh.triangles[t][i])];
}

// Volumes are taken from the piece's own first corner, so that one far from B's origin loses no digits.
void measure(const TriangleMesh& mesh, const MeshTopology& topology, std::vector<MeshPiece>& pieces) {
  for (std::size_t t = 0; t < mesh.triangles.size(); ++t) {
    if (topology.piece_of[t] < 0) continue;
    MeshPiece& piece = pieces[static_cast<std::size_t>(topology.piece_of[t])];
    if (piece.triangles++ == 0) {
      piece.first_triangle = static_cast<std::int32_t>(t);
      piece.box_min = piece.box_max = cornerOf(mesh, t, 0);
    }
    for (std::size_t i = 0; i < 3; ++i) {
      piece.box_min = piece.box_min.cwiseMin(cornerOf(mesh, t, i));
      piece.box_max = piece.box_max.cwiseMax(cornerOf(mesh, t, i));
    }
    const Vec3 area = areaVector(mesh, mesh.triangles[t]);
    piece.area += area.norm();
    piece.volume +=
        area.dot(cornerOf(mesh, t, 0) - cornerOf(mesh, static_cast<std::size_t>(piece.first_triangle), 0)) / 3;
  }
}

double solidAngle(const Vec3& a, const Vec3& b, const Vec3& c) {
  const double la = a.norm(), lb = b.norm(), lc = c.norm();
  return 2 * math::atan2(a.dot(b.cross(c)), la * lb * lc + a.dot(b) * lc + b.dot(c) * la + c.dot(a) * lb);
}

bool boxHolds(const MeshPiece& outer, const MeshPiece& inner) {
  return (outer.box_min.array() <= inner.box_min.array()).all() &&
         (inner.box_max.array() <= outer.box_max.array()).all();
}

class Nesting {
 public:
  Nesting(const TriangleMesh& mesh, const MeshTopology& topology, MeshPieces& pieces) : mesh_(mesh), pieces_(pieces) {
    for (std::size_t i = 0; i < pieces.list.size(); ++i) {
      if (pieces.list[i].closed) closed_.push_back(i);
    }
    if (closed_.size() > 1) groupTriangles(topology);
  }

  void find() {
    for (const std::size_t inner : closed_) {
      if (closed_.size() > kMostPieces || work_ > kMostAngles) return giveUp();
      bool within = false;
      for (const std::size_t outer : closed_) {
        if (outer != inner && boxHolds(pieces_.list[outer], pieces_.list[inner]) && isInside(inner, outer))
          within = !within;
      }
      pieces_.list[inner].within = within;
    }
  }

 private:
  static constexpr std::size_t kMostPieces = 2000, kMostAngles = 40'000'000;  // each some seconds of work

  void groupTriangles(const MeshTopology& topology) {
    triangles_.resize(pieces_.list.size());
    for (std::size_t t = 0; t < topology.piece_of.size(); ++t) {
      if (topology.piece_of[t] >= 0) triangles_[static_cast<std::size_t>(topology.piece_of[t])].push_back(t);
    }
  }

  bool isInside(std::size_t inner, std::size_t outer) {
    const Vec3& p = cornerOf(mesh_, static_cast<std::size_t>(pieces_.list[inner].first_triangle), 0);
    double sum = 0;
    for (const std::size_t t : triangles_[outer]) {
      sum += solidAngle(cornerOf(mesh_, t, 0) - p, cornerOf(mesh_, t, 1) - p, cornerOf(mesh_, t, 2) - p);
    }
    work_ += triangles_[outer].size();
    return std::abs(sum) > 2 * M_PI;
  }

  void giveUp() {
    pieces_.nesting_known = false;
    for (MeshPiece& piece : pieces_.list) piece.within = false;
  }

  const TriangleMesh& mesh_;
  MeshPieces& pieces_;
  std::vector<std::size_t> closed_;
  std::vector<std::vector<std::size_t>> triangles_;
  std::size_t work_ = 0;
};

}  // namespace

// A card of 85 x 54 x 0.8 mm has 0.008, a sheet of paper 3e-4.
bool MeshPiece::hasNoThickness() const {
  constexpr double kThinnest = 1e-4;  // mean thickness over the root of the area
  return closed && 2 * std::abs(volume) <= kThinnest * area * std::sqrt(area);
}

MeshPieces findPieces(const TriangleMesh& mesh, const std::vector<HalfEdge>& half_edges, const MeshTopology& topology) {
  PINCER_ASSERT(topology.piece_of.size() == mesh.triangles.size());
  MeshPieces pieces;
  pieces.list.resize(static_cast<std::size_t>(topology.pieces));
  measure(mesh, topology, pieces.list);
  forEachEdge(half_edges, [&](auto edge) {
    if (isRegular(edge)) return;
    pieces.list[static_cast<std::size_t>(topology.piece_of[static_cast<std::size_t>(edge[0].triangle)])].closed = false;
  });
  Nesting(mesh, topology, pieces).find();
  return pieces;
}

}  // namespace pincer::contact
