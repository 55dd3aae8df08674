#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <map>
#include <numeric>

#include "pincer/contact/io/counted.h"
#include "pincer/contact/mesh/mesh_findings.h"
#include "pincer/contact/mesh/mesh_topology.h"
#include "pincer/contact/mesh/polygon.h"
#include "pincer/contact/mesh/repair_steps.h"

namespace pincer::contact {

namespace {

// Vertices where the surface ends, and those of triangles without area: only there can welding close anything.
std::vector<bool> weldCandidates(const TriangleMesh& mesh) {
  std::vector<bool> candidate(mesh.vertices.size());
  forEachEdge(sortedHalfEdges(mesh.triangles), [&](auto edge) {
    if (isBoundary(edge))
      candidate[static_cast<std::size_t>(edge[0].low)] = candidate[static_cast<std::size_t>(edge[0].high)] = true;
  });
  for (const auto& t : mesh.triangles) {
    const auto p = [&](std::size_t i) -> const Vec3& { return mesh.vertices[static_cast<std::size_t>(t[i])]; };
    if (!hasZeroArea(p(0), p(1), p(2))) continue;
    for (const std::int32_t v : t) candidate[static_cast<std::size_t>(v)] = true;
  }
  return candidate;
}

// For each vertex the earlier one that it becomes: the nearest within `distance` among those that stay.
std::vector<std::int32_t> nearestEarlier(const TriangleMesh& mesh, const std::vector<bool>& candidate,
                                         double distance) {
  using Cell = std::array<std::int64_t, 3>;
  const auto cellOf = [&](const Vec3& p, const Cell& step) {
    Cell cell{};
    for (int k = 0; k < 3; ++k) {
      const auto i = static_cast<std::size_t>(k);
      constexpr double kFarthest = 9e15;  // doubles beyond have no fraction left
      cell[i] = static_cast<std::int64_t>(std::clamp(std::floor(p[k] / distance), -kFarthest, kFarthest)) + step[i];
    }
    return cell;
  };
  std::map<Cell, std::vector<std::int32_t>> staying;
  std::vector<std::int32_t> target(mesh.vertices.size());
  std::iota(target.begin(), target.end(), 0);
  for (std::size_t v = 0; v < target.size(); ++v) {
    if (!candidate[v]) continue;
    double nearest = distance;
    for (std::int64_t code = 0; code < 27; ++code) {
      const auto cell = staying.find(cellOf(mesh.vertices[v], {code % 3 - 1, code / 3 % 3 - 1, code / 9 - 1}));
      if (cell == staying.end()) continue;
      for (const std::int32_t other : cell->second) {
        const double apart = (mesh.vertices[static_cast<std::size_t>(other)] - mesh.vertices[v]).norm();
        const bool nearer =
            apart < nearest || (apart == nearest && (target[v] == static_cast<std::int32_t>(v) || other < target[v]));
        if (!nearer) continue;
        nearest = apart;
        target[v] = other;
      }
    }
    if (target[v] == static_cast<std::int32_t>(v)) staying[cellOf(mesh.vertices[v], {0, 0, 0})].push_back(target[v]);
  }
  return target;
}

// Triangles in the order of their direction around an edge: half-edges that run backwards begin a wedge of the solid,
// the next ones forwards end it. Each such pair stays together.
void joinWedges(const TriangleMesh& mesh, std::span<const HalfEdge> edge, UnionFind& fans) {
  const Vec3& p = mesh.vertices[static_cast<std::size_t>(edge[0].low)];
  const Mat3 R = frameFromNormal((mesh.vertices[static_cast<std::size_t>(edge[0].high)] - p).normalized());
  struct Blade {
    double angle;
    HalfEdge half_edge;
  };
  std::vector<Blade> blades;
  for (const HalfEdge& h : edge) {
    const std::int32_t top =
        mesh.triangles[static_cast<std::size_t>(h.triangle)][static_cast<std::size_t>((h.side + 2) % 3)];
    const Vec3 o = mesh.vertices[static_cast<std::size_t>(top)] - p;
    blades.push_back({math::atan2(R.col(1).dot(o), R.col(0).dot(o)), h});
  }
  std::stable_sort(blades.begin(), blades.end(), [](const Blade& a, const Blade& b) { return a.angle < b.angle; });
  for (std::size_t k = 0; k < blades.size(); ++k) {
    const std::array<HalfEdge, 2> pair = {blades[k].half_edge, blades[(k + 1) % blades.size()].half_edge};
    if (!pair[0].forward && pair[1].forward) joinFans(pair, fans);
  }
}

}  // namespace

MaybeChange weldVertices(TriangleMesh& mesh, double distance) {
  const std::vector<bool> candidate = weldCandidates(mesh);
  const std::vector<std::int32_t> target =
      distance > 0 ? nearestEarlier(mesh, candidate, distance) : firstAtSamePlace(mesh, candidate);
  Occurrences<std::int32_t> welded;
  for (std::size_t v = 0; v < target.size(); ++v) {
    if (target[v] != static_cast<std::int32_t>(v)) welded.add(static_cast<std::int32_t>(v));
  }
  if (welded.count == 0) return {};
  for (auto& t : mesh.triangles) {
    for (std::int32_t& v : t) v = target[static_cast<std::size_t>(v)];
  }
  const std::string near = distance > 0 ? fmt::format("within {:.4g} mm", 1e3 * distance) : "at the same place";
  return MeshChange{"welded-vertices", welded.count,
                    fmt::format("welded {} onto earlier ones {}; the first is {}", counted(welded.count, "vertex"),
                                near, vertexPlace(mesh, welded.first))};
}

MaybeChange cutApart(TriangleMesh& mesh) {
  UnionFind fans(3 * mesh.triangles.size());
  forEachEdge(sortedHalfEdges(mesh.triangles),
              [&](auto edge) { isBranching(edge) ? joinWedges(mesh, edge, fans) : joinFans(edge, fans); });
  std::vector<std::int32_t> fan_of(mesh.vertices.size(), -1);
  std::map<std::int32_t, std::int32_t> copy_for;  // fan -> new vertex
  Occurrences<std::int32_t> split;
  for (std::size_t c = 0; c < 3 * mesh.triangles.size(); ++c) {
    std::int32_t& v = mesh.triangles[c / 3][c % 3];
    const std::int32_t fan = fans.find(static_cast<std::int32_t>(c));
    std::int32_t& first = fan_of[static_cast<std::size_t>(v)];
    if (first < 0) first = fan;
    if (first == fan) continue;
    const auto [it, is_new] = copy_for.try_emplace(fan, static_cast<std::int32_t>(mesh.vertices.size()));
    if (is_new) {
      split.add(v);
      mesh.vertices.push_back(Vec3(mesh.vertices[static_cast<std::size_t>(v)]));
    }
    v = it->second;
  }
  if (split.count == 0) return {};
  return MeshChange{
      "split-vertices", split.count,
      fmt::format(
          "cut the surface apart where it branched or touched itself, with {} new vertices; the first doubles {}",
          split.count, vertexPlace(mesh, split.first))};
}

MaybeChange dropUnusedVertices(TriangleMesh& mesh) {
  const std::vector<bool> used = usedVertices(mesh);
  const auto unused = static_cast<int>(std::count(used.begin(), used.end(), false));
  if (unused == 0) return {};
  std::vector<std::int32_t> place(used.size(), -1);
  std::vector<Vec3> kept;
  for (std::size_t v = 0; v < used.size(); ++v) {
    if (!used[v]) continue;
    place[v] = static_cast<std::int32_t>(kept.size());
    kept.push_back(mesh.vertices[v]);
  }
  mesh.vertices = std::move(kept);
  for (auto& t : mesh.triangles) {
    for (std::int32_t& v : t) v = place[static_cast<std::size_t>(v)];
  }
  return MeshChange{"dropped-vertices", unused,
                    fmt::format("dropped {} that no triangle uses", counted(unused, "vertex"))};
}

}  // namespace pincer::contact
