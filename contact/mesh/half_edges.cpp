#include "contact/mesh/half_edges.h"

#include <algorithm>
#include <tuple>

namespace pincer::contact {

std::vector<HalfEdge> sortedHalfEdges(std::span<const std::array<std::int32_t, 3>> triangles) {
  std::vector<HalfEdge> list;
  list.reserve(3 * triangles.size());
  for (std::size_t t = 0; t < triangles.size(); ++t) {
    for (std::size_t i = 0; i < 3; ++i) {
      const std::int32_t a = triangles[t][i], b = triangles[t][(i + 1) % 3];
      list.push_back({std::min(a, b), std::max(a, b), static_cast<std::int32_t>(t), static_cast<std::int8_t>(i), a < b});
    }
  }
  std::sort(list.begin(), list.end(), [](const HalfEdge& x, const HalfEdge& y) {
    return std::tie(x.low, x.high, x.triangle, x.side) < std::tie(y.low, y.high, y.triangle, y.side);
  });
  return list;
}

std::span<const HalfEdge> edgeAt(std::span<const HalfEdge> half_edges, std::size_t first) {
  std::size_t end = first + 1;
  while (end < half_edges.size() && half_edges[end].low == half_edges[first].low && half_edges[end].high == half_edges[first].high) ++end;
  return half_edges.subspan(first, end - first);
}

}  // namespace pincer::contact
