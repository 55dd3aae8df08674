#include "pincer/contact/mesh_report.h"

#include <algorithm>

#include "pincer/contact/mesh/connectivity.h"
#include "pincer/contact/mesh/mesh_findings.h"
#include "pincer/contact/mesh/polygon.h"

namespace pincer::contact {

namespace {

// The finding about an empty mesh, with its remedy.
constexpr const char* kNoTriangle = "the mesh has no triangle; there is nothing to touch. Export it again.";

using Triangle = std::array<std::int32_t, 3>;

const Vec3& vertex(const TriangleMesh& mesh, std::int32_t i) { return mesh.vertices[static_cast<std::size_t>(i)]; }

const Vec3* fileNormal(const TriangleMesh& mesh, const std::vector<bool>& opposing, std::int32_t triangle, int i) {
  if (mesh.triangle_normals.empty()) return nullptr;
  return usableFileNormal(mesh, static_cast<std::size_t>(triangle), static_cast<std::size_t>(i), opposing);
}

bool inOneGroup(const TriangleMesh& mesh, const HalfEdge& h, const HalfEdge& k) {
  const std::int32_t group = mesh.smoothing_groups[static_cast<std::size_t>(h.triangle)];
  return group != 0 && group == mesh.smoothing_groups[static_cast<std::size_t>(k.triangle)];
}

// As findCornerNormals (connectivity.h) decides it, for meshes that may branch elsewhere.
bool isCrease(const TriangleMesh& mesh, const std::vector<bool>& opposing, std::span<const HalfEdge> edge,
              double crease_angle) {
  const HalfEdge &h = edge[0], &k = edge[1];
  const auto normalAt = [&](std::int32_t triangle, int i) { return fileNormal(mesh, opposing, triangle, i); };
  const Vec3 *a0 = normalAt(h.triangle, h.side), *a1 = normalAt(h.triangle, h.side + 1);
  const Vec3 *b0 = normalAt(k.triangle, k.side + 1), *b1 = normalAt(k.triangle, k.side);
  if (a0 && a1 && b0 && b1) return angleBetween(*a0, *b0) > kSameNormal || angleBetween(*a1, *b1) > kSameNormal;
  const auto area = [&](const HalfEdge& e) {
    return areaVector(mesh, mesh.triangles[static_cast<std::size_t>(e.triangle)]);
  };
  const double angle = angleBetween(area(h), area(k));
  return mesh.smoothing_groups.empty() ? angle > crease_angle : angle > kSameNormal && !inOneGroup(mesh, h, k);
}

void countCreases(const TriangleMesh& mesh, const std::vector<HalfEdge>& half_edges, double crease_angle,
                  MeshReport& report) {
  std::vector<bool> creased(mesh.vertices.size());
  const std::vector<bool> opposing = findOpposingCorners(mesh);
  forEachEdge(half_edges, [&](auto edge) {
    if (!isRegular(edge) || !isCrease(mesh, opposing, edge, crease_angle)) return;
    ++report.crease_edges;
    creased[static_cast<std::size_t>(edge[0].low)] = creased[static_cast<std::size_t>(edge[0].high)] = true;
  });
  report.creased_vertices = static_cast<int>(std::count(creased.begin(), creased.end(), true));
}

// Height over the longest side, relative to that.
double slenderness(const TriangleMesh& mesh, const Triangle& t) {
  const Vec3 &a = vertex(mesh, t[0]), &b = vertex(mesh, t[1]), &c = vertex(mesh, t[2]);
  const double longest2 = std::max({(b - a).squaredNorm(), (c - b).squaredNorm(), (a - c).squaredNorm()});
  return 2 * areaVector(mesh, t).norm() / longest2;
}

struct TriangleQuality {
  Occurrences<std::int32_t> zero_area, needle, duplicate;
};

Occurrences<std::int32_t> findDuplicates(const TriangleMesh& mesh, const std::vector<HalfEdge>& half_edges) {
  std::vector<std::int32_t> duplicates;
  for (const auto& equal : equalTriangles(mesh, half_edges))
    duplicates.insert(duplicates.end(), equal.begin() + 1, equal.end());
  std::sort(duplicates.begin(), duplicates.end());
  Occurrences<std::int32_t> found;
  for (const std::int32_t t : duplicates) found.add(t);
  return found;
}

TriangleQuality judgeTriangles(const TriangleMesh& mesh, const std::vector<HalfEdge>& half_edges) {
  constexpr double kNeedle = 1e-3;  // slenderness [-]: below it is reported
  TriangleQuality quality;
  for (std::size_t i = 0; i < mesh.triangles.size(); ++i) {
    const Triangle& t = mesh.triangles[i];
    if (namesAVertexTwice(t) || hasZeroArea(vertex(mesh, t[0]), vertex(mesh, t[1]), vertex(mesh, t[2]))) {
      quality.zero_area.add(static_cast<std::int32_t>(i));
    } else if (slenderness(mesh, t) < kNeedle) {
      quality.needle.add(static_cast<std::int32_t>(i));
    }
  }
  quality.duplicate = findDuplicates(mesh, half_edges);
  return quality;
}

void measure(const TriangleMesh& mesh, const std::vector<bool>& used, MeshReport& report) {
  report.box_min = report.box_max = vertex(mesh, mesh.triangles[0][0]);
  for (std::size_t i = 0; i < used.size(); ++i) {
    if (!used[i]) continue;
    report.box_min = report.box_min.cwiseMin(mesh.vertices[i]);
    report.box_max = report.box_max.cwiseMax(mesh.vertices[i]);
  }
  // near the mesh, so that a mesh far from B's origin loses no digits
  const Vec3 origin = vertex(mesh, mesh.triangles[0][0]);
  for (const Triangle& t : mesh.triangles) {
    const Vec3 area = areaVector(mesh, t);
    report.area += area.norm();
    report.volume += area.dot(vertex(mesh, t[0]) - origin) / 3;
  }
}

void describe(const MeshTopology& topology, MeshReport& report) {
  report.edges = topology.edges;
  report.boundary_edges = topology.boundary.count;
  report.boundary_loops = topology.loops;
  report.nonmanifold_edges = topology.branching.count + topology.reversed.count;
  report.reversed_edges = topology.reversed.count;
  report.nonmanifold_vertices = topology.touching.count;
  report.components = topology.pieces;
  report.closed = topology.edges > 0 && report.boundary_edges == 0 && report.nonmanifold_edges == 0;
  report.inverted = report.closed && report.volume < 0;
}

std::string sentence(const TriangleMesh& mesh, const MeshFinding& finding) { return mesh.source + ": " + finding.text; }

void throwIf(const TriangleMesh& mesh, const MaybeFinding& finding) {
  if (finding) throw InputError(sentence(mesh, *finding));
}

void requireManifold(const TriangleMesh& mesh, const MeshTopology& topology) {
  throwIf(mesh, branchingFinding(mesh, topology));
  throwIf(mesh, reversedFinding(mesh, topology));
  throwIf(mesh, touchingFinding(mesh, topology));
}

void requireTriangles(const TriangleMesh& mesh) {
  if (mesh.triangles.empty()) throw InputError(mesh.source + ": " + kNoTriangle);
}

}  // namespace

bool MeshReport::isFit() const {
  return std::none_of(findings.begin(), findings.end(), [](const MeshFinding& finding) { return finding.unfit; });
}

MeshReport inspect(const TriangleMesh& mesh, const InspectOptions& options) {
  MeshReport report;
  report.vertices = static_cast<int>(mesh.vertices.size());
  report.triangles = static_cast<int>(mesh.triangles.size());
  if (mesh.triangles.empty()) {
    report.findings.push_back({"no-triangles", true, 1, kNoTriangle});
    return report;
  }
  const std::vector<bool> used = usedVertices(mesh);
  measure(mesh, used, report);
  const std::vector<HalfEdge> half_edges = sortedHalfEdges(mesh.triangles);
  const MeshTopology topology = findTopology(mesh, half_edges);
  const MeshPieces pieces = findPieces(mesh, half_edges, topology);
  const TriangleQuality quality = judgeTriangles(mesh, half_edges);
  const std::vector<std::int32_t> first = firstAtSamePlace(mesh, used);
  describe(topology, report);
  countCreases(mesh, half_edges, options.crease_angle, report);
  report.file_normals = !mesh.triangle_normals.empty();
  report.smoothing_groups = !mesh.smoothing_groups.empty();
  report.zero_area_triangles = quality.zero_area.count;
  report.needle_triangles = quality.needle.count;
  report.duplicate_triangles = quality.duplicate.count;
  report.unused_vertices = static_cast<int>(std::count(used.begin(), used.end(), false));
  for (std::size_t i = 0; i < first.size(); ++i) report.duplicate_vertices += first[i] != static_cast<std::int32_t>(i);

  const double size = (report.box_max - report.box_min).maxCoeff();
  for (const MaybeFinding& finding :
       {boundaryFinding(mesh, topology), branchingFinding(mesh, topology), reversedFinding(mesh, topology),
        touchingFinding(mesh, topology), flippedPieceFinding(mesh, pieces), flatPieceFinding(mesh, pieces),
        zeroAreaFinding(mesh, quality.zero_area), duplicateTriangleFinding(mesh, quality.duplicate),
        sizeFinding(size, options.metres_per_unit), needleFinding(mesh, quality.needle),
        opposingNormalFinding(mesh, findOpposingNormals(mesh)), duplicateVertexFinding(mesh, first),
        unusedVertexFinding(mesh, used), severalPiecesFinding(mesh, pieces), nestedPieceFinding(mesh, pieces)}) {
    if (finding) report.findings.push_back(*finding);
  }
  return report;
}

void requireManifold(const TriangleMesh& mesh) {
  requireTriangles(mesh);
  requireManifold(mesh, findTopology(mesh, sortedHalfEdges(mesh.triangles)));
}

void requireClosed(const TriangleMesh& mesh) {
  requireTriangles(mesh);
  const std::vector<HalfEdge> half_edges = sortedHalfEdges(mesh.triangles);
  const MeshTopology topology = findTopology(mesh, half_edges);
  requireManifold(mesh, topology);
  throwIf(mesh, boundaryFinding(mesh, topology));
  throwIf(mesh, flippedPieceFinding(mesh, findPieces(mesh, half_edges, topology)));
}

}  // namespace pincer::contact
