#include "contact/mesh/mesh_report.h"

#include <fmt/format.h>

#include <algorithm>
#include <numeric>
#include <tuple>

#include "contact/mesh/half_edges.h"
#include "contact/mesh/union_find.h"

namespace pincer::contact {

namespace {

using Triangle = std::array<std::int32_t, 3>;

const Vec3& vertex(const TriangleMesh& mesh, std::int32_t i) { return mesh.vertices[static_cast<std::size_t>(i)]; }

Vec3 areaVector(const TriangleMesh& mesh, const Triangle& t) {
  const Vec3& p0 = vertex(mesh, t[0]);
  return 0.5 * (vertex(mesh, t[1]) - p0).cross(vertex(mesh, t[2]) - p0);
}

// What the topology of a mesh amounts to; `first` stand for one example each, -1 where there is none.
struct Topology {
  int edges = 0, boundary = 0, branching = 0, creases = 0, components = 0, touching_vertices = 0;
  std::array<std::int32_t, 2> first_boundary = {-1, -1};
  std::array<std::int32_t, 2> first_branching = {-1, -1};
  std::int32_t first_touching = -1;
};

std::vector<bool> usedVertices(const TriangleMesh& mesh) {
  std::vector<bool> used(mesh.vertices.size());
  for (const Triangle& t : mesh.triangles) {
    for (const std::int32_t v : t) used[static_cast<std::size_t>(v)] = true;
  }
  return used;
}

// For each vertex the first used one at exactly its place.
std::vector<std::int32_t> firstAtSamePlace(const TriangleMesh& mesh, const std::vector<bool>& used) {
  std::vector<std::int32_t> order;
  for (std::size_t i = 0; i < used.size(); ++i) {
    if (used[i]) order.push_back(static_cast<std::int32_t>(i));
  }
  const auto key = [&](std::int32_t i) {
    const Vec3& p = vertex(mesh, i);
    return std::make_tuple(p.x(), p.y(), p.z());
  };
  std::sort(order.begin(), order.end(), [&](auto a, auto b) { return std::make_pair(key(a), a) < std::make_pair(key(b), b); });
  std::vector<std::int32_t> first(used.size());
  std::iota(first.begin(), first.end(), 0);
  for (std::size_t i = 1; i < order.size(); ++i) {
    if (key(order[i]) == key(order[i - 1])) first[static_cast<std::size_t>(order[i])] = first[static_cast<std::size_t>(order[i - 1])];
  }
  return first;
}

bool isCrease(const TriangleMesh& mesh, std::span<const HalfEdge> edge, double crease_angle) {
  const Vec3 a = areaVector(mesh, mesh.triangles[static_cast<std::size_t>(edge[0].triangle)]);
  const Vec3 b = areaVector(mesh, mesh.triangles[static_cast<std::size_t>(edge[1].triangle)]);
  return std::atan2(a.cross(b).norm(), a.dot(b)) > crease_angle;
}

// Corners 3 t + i that meet across an edge belong to one fan around their vertex.
void joinFans(std::span<const HalfEdge> edge, UnionFind& fans) {
  for (std::size_t k = 1; k < edge.size(); ++k) {
    const HalfEdge &a = edge[0], &b = edge[k];
    const std::int32_t a_from = 3 * a.triangle + a.side, a_to = 3 * a.triangle + (a.side + 1) % 3;
    const std::int32_t b_from = 3 * b.triangle + b.side, b_to = 3 * b.triangle + (b.side + 1) % 3;
    const bool same_way = a.forward == b.forward;
    fans.join(a_from, same_way ? b_from : b_to);
    fans.join(a_to, same_way ? b_to : b_from);
  }
}

void countTouchingVertices(const std::vector<Triangle>& triangles, UnionFind& fans, std::size_t vertices, Topology& topology) {
  std::vector<std::int32_t> fan_of(vertices, -1);
  std::vector<bool> touching(vertices);
  for (std::size_t c = 0; c < 3 * triangles.size(); ++c) {
    const auto v = static_cast<std::size_t>(triangles[c / 3][c % 3]);
    const std::int32_t fan = fans.find(static_cast<std::int32_t>(c));
    if (fan_of[v] < 0) fan_of[v] = fan;
    if (fan_of[v] != fan) touching[v] = true;
  }
  for (std::size_t v = vertices; v-- > 0;) {
    if (!touching[v]) continue;
    ++topology.touching_vertices;
    topology.first_touching = static_cast<std::int32_t>(v);
  }
}

Topology examine(const TriangleMesh& mesh, double crease_angle) {
  Topology topology;
  const std::vector<HalfEdge> half_edges = sortedHalfEdges(mesh.triangles);
  UnionFind pieces(mesh.triangles.size()), fans(3 * mesh.triangles.size());
  for (std::size_t i = 0; i < half_edges.size();) {
    const auto edge = edgeAt(half_edges, i);
    ++topology.edges;
    if (isBoundary(edge) && topology.boundary++ == 0) topology.first_boundary = {edge[0].low, edge[0].high};
    if (!isBoundary(edge) && !isRegular(edge) && topology.branching++ == 0) topology.first_branching = {edge[0].low, edge[0].high};
    if (isRegular(edge)) topology.creases += isCrease(mesh, edge, crease_angle);
    joinFans(edge, fans);
    for (const HalfEdge& h : edge) pieces.join(edge[0].triangle, h.triangle);
    i += edge.size();
  }
  topology.components = pieces.sets();
  countTouchingVertices(mesh.triangles, fans, mesh.vertices.size(), topology);
  return topology;
}

// Open edges that remain once vertices at the same place are one.
int boundaryAfterMerging(const TriangleMesh& mesh, const std::vector<std::int32_t>& first) {
  std::vector<Triangle> merged = mesh.triangles;
  for (Triangle& t : merged) {
    for (std::int32_t& v : t) v = first[static_cast<std::size_t>(v)];
  }
  const std::vector<HalfEdge> half_edges = sortedHalfEdges(merged);
  int boundary = 0;
  for (std::size_t i = 0; i < half_edges.size();) {
    const auto edge = edgeAt(half_edges, i);
    boundary += isBoundary(edge);
    i += edge.size();
  }
  return boundary;
}

std::string place(const TriangleMesh& mesh, std::int32_t v) {
  const Vec3 p = 1000 * vertex(mesh, v);
  return fmt::format("vertex {} at ({:.4g}, {:.4g}, {:.4g}) mm", v + 1, p.x(), p.y(), p.z());
}

std::string place(const TriangleMesh& mesh, const std::array<std::int32_t, 2>& edge) {
  return fmt::format("from {} to {}", place(mesh, edge[0]), place(mesh, edge[1]));
}

std::string branchingFinding(const TriangleMesh& mesh, const Topology& t) {
  return fmt::format(
      "the surface branches or flips at {} edge(s), the first {}: more than two triangles meet there, or two that face opposite ways. "
      "Make normals consistent and delete inner and duplicate faces in a mesh editor.",
      t.branching, place(mesh, t.first_branching));
}

std::string touchingFinding(const TriangleMesh& mesh, const Topology& t) {
  return fmt::format(
      "the surface touches itself at {} single vertex(es), the first is {}. Split these vertices in a mesh editor, or move the parts "
      "apart.",
      t.touching_vertices, place(mesh, t.first_touching));
}

std::string boundaryFinding(const TriangleMesh& mesh, const Topology& t, int after_merging) {
  std::string text =
      fmt::format("the mesh is open: {} edge(s) have only one triangle, the first {}. ", t.boundary, place(mesh, t.first_boundary));
  if (after_merging == 0) {
    return text + "All of them are seams between duplicate vertices: merge vertices by distance in a mesh editor.";
  }
  if (after_merging < t.boundary) {
    text += fmt::format("{} of them are seams between duplicate vertices: merge vertices by distance, then fill the ",
                        t.boundary - after_merging);
    return text + "remaining holes in a mesh editor.";
  }
  return text + "Fill the holes in a mesh editor: a body's mass needs a closed surface.";
}

std::string invertedFinding(double volume) {
  return fmt::format("the triangles face inwards (signed volume {:.4g} cm^3). Flip the normals in a mesh editor.", 1e6 * volume);
}

double signedVolume(const TriangleMesh& mesh) {
  const Vec3 origin = vertex(mesh, mesh.triangles[0][0]);  // near the mesh, so that a mesh far from B's origin loses no digits
  double volume = 0;
  for (const Triangle& t : mesh.triangles) volume += areaVector(mesh, t).dot(vertex(mesh, t[0]) - origin) / 3;
  return volume;
}

void measure(const TriangleMesh& mesh, const std::vector<bool>& used, MeshReport& report) {
  report.box_min = report.box_max = vertex(mesh, mesh.triangles[0][0]);
  for (std::size_t i = 0; i < used.size(); ++i) {
    if (!used[i]) continue;
    report.box_min = report.box_min.cwiseMin(mesh.vertices[i]);
    report.box_max = report.box_max.cwiseMax(mesh.vertices[i]);
  }
  for (const Triangle& t : mesh.triangles) report.area += areaVector(mesh, t).norm();
  report.volume = signedVolume(mesh);
}

void addFindings(const TriangleMesh& mesh, const Topology& topology, const std::vector<std::int32_t>& first, MeshReport& report) {
  auto& findings = report.findings;
  if (topology.boundary > 0) findings.push_back(boundaryFinding(mesh, topology, boundaryAfterMerging(mesh, first)));
  if (topology.branching > 0) findings.push_back(branchingFinding(mesh, topology));
  if (topology.touching_vertices > 0) findings.push_back(touchingFinding(mesh, topology));
  if (report.inverted) findings.push_back(invertedFinding(report.volume));
  if (report.components > 1) {
    findings.push_back(
        fmt::format("the mesh has {} separate pieces; all of them move as one body. Delete what isn't meant.", report.components));
  }
  if (report.unused_vertices > 0) {
    findings.push_back(fmt::format("{} vertices are in no triangle; they are ignored.", report.unused_vertices));
  }
  const double size = (report.box_max - report.box_min).maxCoeff();
  if (size < 0.005 || size > 0.5) {
    findings.push_back(fmt::format("the mesh is {:.4g} mm long; hands hold 5 to 500 mm. Is the unit right (--units)?", 1000 * size));
  }
}

}  // namespace

MeshReport inspect(const TriangleMesh& mesh, double crease_angle) {
  MeshReport report;
  report.vertices = static_cast<int>(mesh.vertices.size());
  report.triangles = static_cast<int>(mesh.triangles.size());
  if (mesh.triangles.empty()) {
    report.findings.emplace_back("the mesh has no triangle; there is nothing to touch.");
    return report;
  }
  const std::vector<bool> used = usedVertices(mesh);
  report.unused_vertices = static_cast<int>(std::count(used.begin(), used.end(), false));
  const std::vector<std::int32_t> first = firstAtSamePlace(mesh, used);
  for (std::size_t i = 0; i < first.size(); ++i) report.duplicate_vertices += first[i] != static_cast<std::int32_t>(i);
  measure(mesh, used, report);
  const Topology topology = examine(mesh, crease_angle);
  report.edges = topology.edges;
  report.boundary_edges = topology.boundary;
  report.nonmanifold_edges = topology.branching;
  report.nonmanifold_vertices = topology.touching_vertices;
  report.crease_edges = topology.creases;
  report.components = topology.components;
  report.closed = topology.boundary == 0 && topology.branching == 0;
  report.inverted = report.closed && report.volume < 0;
  addFindings(mesh, topology, first, report);
  return report;
}

void requireManifold(const TriangleMesh& mesh) {
  if (mesh.triangles.empty()) throw InputError(mesh.source + ": the mesh has no triangle; there is nothing to touch.");
  const Topology topology = examine(mesh, M_PI);
  if (topology.branching > 0) throw InputError(mesh.source + ": " + branchingFinding(mesh, topology));
  if (topology.touching_vertices > 0) throw InputError(mesh.source + ": " + touchingFinding(mesh, topology));
}

void requireClosed(const TriangleMesh& mesh) {
  requireManifold(mesh);
  const Topology topology = examine(mesh, M_PI);
  if (topology.boundary > 0) {
    const int after_merging = boundaryAfterMerging(mesh, firstAtSamePlace(mesh, usedVertices(mesh)));
    throw InputError(mesh.source + ": " + boundaryFinding(mesh, topology, after_merging));
  }
  const double volume = signedVolume(mesh);
  if (volume < 0) throw InputError(mesh.source + ": " + invertedFinding(volume));
}

}  // namespace pincer::contact
