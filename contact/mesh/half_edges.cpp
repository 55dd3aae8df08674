#include "pincer/contact/mesh/half_edges.h"

#include <algorithm>
#include <tuple>

#include "pincer/contact/functions/invariants.h"

namespace pincer::contact {

namespace {

HalfEdge halfEdge(std::span<const std::array<std::int32_t, 3>> triangles, std::size_t t, std::size_t side) {
  const std::int32_t a = triangles[t][side], b = triangles[t][(side + 1) % 3];
  return {std::min(a, b), std::max(a, b), static_cast<std::int32_t>(t), static_cast<std::int8_t>(side), a < b};
}

template <class Visit>
void forEachHalfEdge(std::span<const std::array<std::int32_t, 3>> triangles, Visit&& visit) {
  for (std::size_t t = 0; t < triangles.size(); ++t) {
    PINCER_ASSERT(std::min({triangles[t][0], triangles[t][1], triangles[t][2]}) >= 0);
    if (namesAVertexTwice(triangles[t])) continue;
    for (std::size_t i = 0; i < 3; ++i) visit(halfEdge(triangles, t, i));
  }
}

std::size_t vertexLimit(std::span<const std::array<std::int32_t, 3>> triangles) {
  std::int32_t limit = 0;
  for (const auto& [a, b, c] : triangles) limit = std::max({limit, a + 1, b + 1, c + 1});
  return static_cast<std::size_t>(limit);
}

}  // namespace

// A counting sort by the lower vertex, then each vertex's few half-edges.
std::vector<HalfEdge> sortedHalfEdges(std::span<const std::array<std::int32_t, 3>> triangles) {
  std::vector<std::size_t> begin(vertexLimit(triangles) + 1);
  forEachHalfEdge(triangles, [&](const HalfEdge& h) { ++begin[static_cast<std::size_t>(h.low) + 1]; });
  for (std::size_t v = 1; v < begin.size(); ++v) begin[v] += begin[v - 1];
  std::vector<HalfEdge> list(begin.back());
  std::vector<std::size_t> end(begin.begin(), begin.end() - 1);
  forEachHalfEdge(triangles, [&](const HalfEdge& h) { list[end[static_cast<std::size_t>(h.low)]++] = h; });
  for (std::size_t v = 0; v < end.size(); ++v) {
    std::sort(list.begin() + static_cast<std::ptrdiff_t>(begin[v]), list.begin() + static_cast<std::ptrdiff_t>(end[v]),
              [](const HalfEdge& x, const HalfEdge& y) {
                return std::tie(x.high, x.triangle, x.side) < std::tie(y.high, y.triangle, y.side);
              });
  }
  return list;
}

std::span<const HalfEdge> edgeAt(std::span<const HalfEdge> half_edges, std::size_t first) {
  PINCER_ASSERT(first < half_edges.size());
  std::size_t end = first + 1;
  while (end < half_edges.size() && half_edges[end].low == half_edges[first].low &&
         half_edges[end].high == half_edges[first].high)
    ++end;
  return half_edges.subspan(first, end - first);
}

}  // namespace pincer::contact
