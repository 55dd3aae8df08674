#include <fmt/format.h>

#include <algorithm>
#include <map>
#include <set>

#include "pincer/contact/io/counted.h"
#include "pincer/contact/mesh/mesh_findings.h"
#include "pincer/contact/mesh/mesh_pieces.h"
#include "pincer/contact/mesh/mesh_topology.h"
#include "pincer/contact/mesh/polygon.h"
#include "pincer/contact/mesh/repair_steps.h"

namespace pincer::contact {

namespace {

// distance of a rim's vertices from their plane, relative to the rim's greatest extent
constexpr double kFlatEnough = 0.25;

using Loop = std::vector<std::int32_t>;

// Rims of holes, so directed that a triangle along them faces as its neighbours do. Rims that
// touch themselves or others are left out.
std::vector<Loop> findLoops(const std::vector<HalfEdge>& half_edges) {
  constexpr std::int32_t kSeveral = -1;  // mark of a vertex that several rims share
  std::map<std::int32_t, std::int32_t> next;
  forEachEdge(half_edges, [&](auto edge) {
    if (!isBoundary(edge)) return;
    const auto [it, is_new] = next.try_emplace(toVertex(edge[0]), fromVertex(edge[0]));
    if (!is_new) it->second = kSeveral;
  });
  std::vector<Loop> loops;
  std::set<std::int32_t> seen;
  for (const auto& [start, unused] : next) {
    Loop loop;
    std::int32_t v = start;
    while (v != kSeveral && seen.insert(v).second) {
      loop.push_back(v);
      const auto it = next.find(v);
      v = it == next.end() ? kSeveral : it->second;
    }
    if (v == start && loop.size() >= 3) loops.push_back(loop);
  }
  return loops;
}

bool isFlatEnough(const std::vector<Vec3>& rim) {
  Vec3 middle = Vec3::Zero(), n = Vec3::Zero(), low = rim[0], high = rim[0];
  for (std::size_t i = 0; i < rim.size(); ++i) {
    middle += rim[i] / static_cast<double>(rim.size());
    n += (rim[i] - rim[0]).cross(rim[(i + 1) % rim.size()] - rim[0]);
    low = low.cwiseMin(rim[i]);
    high = high.cwiseMax(rim[i]);
  }
  const double room = kFlatEnough * (high - low).maxCoeff();
  return std::all_of(rim.begin(), rim.end(),
                     [&](const Vec3& p) { return std::abs((p - middle).dot(n.normalized())) <= room; });
}

class HoleFiller {
 public:
  explicit HoleFiller(TriangleMesh& mesh) : mesh_(mesh), half_edges_(sortedHalfEdges(mesh.triangles)) {
    for (const std::int32_t group : mesh.smoothing_groups) last_group_ = std::max(last_group_, group);
    forEachEdge(half_edges_, [&](auto edge) { taken_.push_back({edge[0].low, edge[0].high}); });
  }

  MaybeChange fill(std::size_t most_edges) {
    for (const Loop& loop : findLoops(half_edges_)) {
      if (loop.size() > most_edges || !fillOne(loop)) ++left_;
    }
    const int sheets = reopenSheets();
    if (fills_.empty()) return {};
    std::size_t triangles = 0;
    for (const Fill& fill : fills_) triangles += fill.triangles;
    std::string left = left_ > 0 ? fmt::format("; {} left: larger than asked, or not flat enough", left_) : "";
    if (sheets > 0) left += fmt::format("; {} left open that would enclose nothing", counted(sheets, "sheet"));
    return MeshChange{
        "filled-holes", static_cast<int>(fills_.size()),
        fmt::format("filled {} with {}; the first is at {}{}", counted(static_cast<int>(fills_.size()), "hole"),
                    counted(static_cast<int>(triangles), "triangle"), vertexPlace(mesh_, fills_[0].rim_vertex), left)};
  }

 private:
  struct Fill {
    std::int32_t rim_vertex;
    std::size_t first_triangle, triangles;
  };

  bool fillOne(const Loop& loop) {
    std::vector<Vec3> rim;
    for (const std::int32_t v : loop) rim.push_back(mesh_.vertices[static_cast<std::size_t>(v)]);
    if (!isFlatEnough(rim)) return false;
    const std::vector<CornerTriple> triples = triangulate(rim);
    if (triples.empty() || !diagonalsAreFree(loop, triples)) return false;
    fills_.push_back({loop[0], mesh_.triangles.size(), triples.size()});
    ++last_group_;  // what fills a hole is smooth in itself
    for (const auto& [a, b, c] : triples) {
      const auto v = [&](int i) { return loop[static_cast<std::size_t>(i)]; };
      mesh_.triangles.push_back({v(a), v(b), v(c)});
      if (!mesh_.triangle_normals.empty()) mesh_.triangle_normals.push_back({-1, -1, -1});
      if (!mesh_.smoothing_groups.empty()) mesh_.smoothing_groups.push_back(last_group_);
    }
    return true;
  }

  // The rim of a sheet is a loop too. Filled, a flat sheet would be two faces on top of each other: such pieces stay
  // open. Returns how many fills were taken back.
  int reopenSheets() {
    if (fills_.empty()) return 0;
    const std::vector<HalfEdge> half_edges = sortedHalfEdges(mesh_.triangles);
    const MeshTopology topology = findTopology(mesh_, half_edges);
    const MeshPieces pieces = findPieces(mesh_, half_edges, topology);
    std::vector<bool> drop(mesh_.triangles.size());
    const auto isSheet = [&](const Fill& fill) {
      const std::int32_t piece = topology.piece_of[fill.first_triangle];
      if (!pieces.list[static_cast<std::size_t>(piece)].hasNoThickness()) return false;
      std::fill_n(drop.begin() + static_cast<std::ptrdiff_t>(fill.first_triangle), fill.triangles, true);
      return true;
    };
    const auto sheets = static_cast<int>(std::erase_if(fills_, isSheet));
    if (sheets > 0) dropTriangles(mesh_, drop);
    return sheets;
  }

  // A diagonal that is an edge already would make the surface branch there.
  bool diagonalsAreFree(const Loop& loop, const std::vector<CornerTriple>& triples) {
    const auto n = static_cast<int>(loop.size());
    std::vector<VertexPair> fresh;
    for (const CornerTriple& triple : triples) {
      for (std::size_t i = 0; i < 3; ++i) {
        const int a = triple[i], b = triple[(i + 1) % 3];
        const bool on_rim = (a + 1) % n == b || (b + 1) % n == a;
        if (on_rim || a > b) continue;
        const auto [low, high] = std::minmax(loop[static_cast<std::size_t>(a)], loop[static_cast<std::size_t>(b)]);
        fresh.push_back({low, high});
      }
    }
    const auto taken = [&](const VertexPair& e) {
      return std::binary_search(taken_.begin(), taken_.end(), e) || filled_edges_.count(e);
    };
    if (std::any_of(fresh.begin(), fresh.end(), taken)) return false;
    filled_edges_.insert(fresh.begin(), fresh.end());
    return true;
  }

  TriangleMesh& mesh_;
  std::vector<HalfEdge> half_edges_;
  std::vector<VertexPair> taken_;  // sorted
  std::set<VertexPair> filled_edges_;
  std::vector<Fill> fills_;
  std::int32_t last_group_ = 0;
  int left_ = 0;
};

}  // namespace

MaybeChange fillHoles(TriangleMesh& mesh, int most_edges) {
  return HoleFiller(mesh).fill(static_cast<std::size_t>(most_edges));
}

}  // namespace pincer::contact
