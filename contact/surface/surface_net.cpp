#include "contact/surface/surface_net.h"

#include <algorithm>
#include <bit>

#include "contact/surface/edge_cubic.h"
#include "contact/surface/large_pages.h"

namespace pincer::contact {

namespace {

Vec3& firstHandle(Patch& p, int edge) { return edge == 0 ? p.b210 : edge == 1 ? p.b021 : p.b102; }
Vec3& secondHandle(Patch& p, int edge) { return edge == 0 ? p.b120 : edge == 1 ? p.b012 : p.b201; }

// The ends of edge i of triangle t, as seen along it.
std::array<EdgeEnd, 2> edgeEnds(const SurfaceNet& net, std::int32_t t, int i) {
  const int next = (i + 1) % 3;
  const Vec3 &p0 = net.vertex(t, i), &p1 = net.vertex(t, next), left0 = net.normal(t, i), left1 = net.normal(t, next);
  const Neighbour other = net.neighbour(t, i);
  if (other.triangle < 0) return {EdgeEnd{p0, left0, left0}, EdgeEnd{p1, left1, left1}};
  const Vec3 right0 = net.normal(other.triangle, (other.edge + 1) % 3), right1 = net.normal(other.triangle, other.edge);
  return {EdgeEnd{p0, left0, right0}, EdgeEnd{p1, left1, right1}};
}

// Whether the triangle is the first of an edge's: as that one sees it the edge is computed, so that the two sides share it to the last bit.
bool isFirst(std::int32_t triangle, const Neighbour& other) { return other.triangle < 0 || triangle < other.triangle; }

// The ends of smooth edge i, as its first triangle sees it.
struct SmoothEdge {
  const Vec3 *p0, *p1, *n0, *n1;
  Vec3 *first, *second;  // handles
};
SmoothEdge smoothEdge(Patch& p, int i, bool is_first) {
  const std::array<const Vec3*, 3> corners = {&p.b300, &p.b030, &p.b003}, normals = {&p.n200, &p.n020, &p.n002};
  const auto here = static_cast<std::size_t>(i), next = static_cast<std::size_t>((i + 1) % 3);
  const auto [from, to] = is_first ? std::pair(here, next) : std::pair(next, here);
  Vec3 &first = firstHandle(p, i), &second = secondHandle(p, i);
  return {corners[from], corners[to], normals[from], normals[to], is_first ? &first : &second, is_first ? &second : &first};
}

void setSmoothEdge(const SmoothEdge& e) {
  const auto [first, second] = smoothHandles(*e.p0, *e.p1, *e.n0, *e.n1);
  *e.first = first;
  *e.second = second;
}

// Two side by side.
void setSmoothEdges(const SmoothEdge& a, const SmoothEdge& b) {
  const auto [first, second] = smoothHandles(VecPair(*a.p0, *b.p0), VecPair(*a.p1, *b.p1), VecPair(*a.n0, *b.n0), VecPair(*a.n1, *b.n1));
  *a.first = first.first();
  *b.first = first.second();
  *a.second = second.first();
  *b.second = second.second();
}

void setSharpEdge(const SurfaceNet& net, std::int32_t triangle, int i, SurfaceCell& cell) {
  const Neighbour other = cell.neighbours[static_cast<std::size_t>(i)];
  const bool is_first = isFirst(triangle, other);
  const auto [from, to] = is_first ? edgeEnds(net, triangle, i) : edgeEnds(net, other.triangle, other.edge);
  const auto [first, second] = edgeHandles(from, to);
  firstHandle(cell.patch, i) = is_first ? first : second;
  secondHandle(cell.patch, i) = is_first ? second : first;
}

void setEdges(const SurfaceNet& net, std::int32_t triangle, SurfaceCell& cell) {
  const auto smooth = [&](int i) { return smoothEdge(cell.patch, i, isFirst(triangle, cell.neighbours[static_cast<std::size_t>(i)])); };
  const auto set = [&](int i) {
    cell.sharp[static_cast<std::size_t>(i)] ? setSharpEdge(net, triangle, i, cell) : setSmoothEdge(smooth(i));
  };
  set(0);
  if (!cell.sharp[1] && !cell.sharp[2]) return setSmoothEdges(smooth(1), smooth(2));
  set(1);
  set(2);
}

void setMiddleNormals(Patch& p) {
  p.n110 = middleNormal(p.b300, p.b030, p.n200, p.n020);
  const VecPair middles = middleNormal(VecPair(p.b030, p.b003), VecPair(p.b003, p.b300), VecPair(p.n020, p.n002), VecPair(p.n002, p.n200));
  p.n011 = middles.first();
  p.n101 = middles.second();
}

// A handle lies in its end's tangent plane, whatever the other side of the edge has there.
void setPublishedEdges(Patch& p) {
  for (int i = 0; i < 3; ++i) {
    const auto curve = edgeCurve(p, i);
    const auto normals = edgeNormals(p, i);
    const Vec3 d = curve[3] - curve[0];
    firstHandle(p, i) = curve[0] + (d - d.dot(normals[0]) * normals[0]) / 3;
    secondHandle(p, i) = curve[3] - (d - d.dot(normals[2]) * normals[2]) / 3;
  }
}

void setStraightEdges(Patch& p) {
  for (int i = 0; i < 3; ++i) {
    const auto curve = edgeCurve(p, i);
    firstHandle(p, i) = curve[0] + (curve[3] - curve[0]) / 3;
    secondHandle(p, i) = curve[3] - (curve[3] - curve[0]) / 3;
  }
}

// Vlachos et al.: the centre lies as far beyond the handles' mean as that lies beyond the flat triangle's, halved.
void setCentre(Patch& p) {
  const Vec3 handles = (p.b210 + p.b120 + p.b021 + p.b012 + p.b102 + p.b201) / 6;
  p.b111 = handles + (handles - (p.b300 + p.b030 + p.b003) / 3) / 2;
}

// Where the smooth edge from the corner `P` with normal `n` to the middle of the side across has come to after 2/3 of the way, over the
// triangle's middle. `side` and `normals` are the control points across.
template <class Vec>
Vec placeOnMedian(const Vec& P, const Vec& n, const std::array<Vec, 4>& side, const std::array<Vec, 3>& normals) {
  const Vec M = (side[0] + 3 * side[1] + 3 * side[2] + side[3]) / 8, n_M = (normals[0] + 2 * normals[1] + normals[2]).normalized();
  const auto [first, second] = smoothHandles(P, M, n, n_M);
  return (P + 6 * first + 12 * second + 8 * M) / 27;
}

template <std::size_t N>
std::array<VecPair, N> sideBySide(const std::array<Vec3, N>& a, const std::array<Vec3, N>& b) {
  return [&]<std::size_t... I>(std::index_sequence<I...>) { return std::array<VecPair, N>{VecPair(a[I], b[I])...}; }
  (std::make_index_sequence<N>{});
}

// So that the patch's middle is the medians' mean: on spheres no further off than its edges; with Vlachos' centre it is the worst place.
// Returns whether there is one: not where a side's normals are opposite.
bool setCentreByMedians(Patch& p) {
  const VecPair places = placeOnMedian(VecPair(p.b300, p.b030), VecPair(p.n200, p.n020), sideBySide(edgeCurve(p, 1), edgeCurve(p, 2)),
                                       sideBySide(edgeNormals(p, 1), edgeNormals(p, 2)));
  const Vec3 middle = (places.first() + places.second() + placeOnMedian(p.b003, p.n002, edgeCurve(p, 0), edgeNormals(p, 0))) / 3;
  const Vec3 corners = p.b300 + p.b030 + p.b003, handles = p.b210 + p.b120 + p.b021 + p.b012 + p.b102 + p.b201;
  p.b111 = (27 * middle - corners - 3 * handles) / 6;
  return p.b111.allFinite();
}

// FNV-1a over what the patches depend on.
class Fingerprint {
 public:
  void add(std::uint64_t word) { hash_ = (hash_ ^ word) * 0x100000001b3ull; }
  void add(const Vec3& v) {
    for (int k = 0; k < 3; ++k) add(std::bit_cast<std::uint64_t>(v[k]));
  }
  void add(const std::array<std::int32_t, 3>& numbers) {
    for (const std::int32_t i : numbers) add(static_cast<std::uint64_t>(i));
  }
  std::uint64_t value() const { return hash_ ^ hash_ >> 32; }

 private:
  std::uint64_t hash_ = 0xcbf29ce484222325ull;
};

std::vector<std::array<std::int32_t, 3>> packed(const Neighbours& neighbours) {
  std::vector<std::array<std::int32_t, 3>> codes(neighbours.size());
  for (std::size_t t = 0; t < codes.size(); ++t) {
    for (std::size_t i = 0; i < 3; ++i) {
      const auto [triangle, edge] = neighbours[t][i];
      codes[t][i] = triangle < 0 ? -1 : 8 * triangle + edge;
    }
  }
  return codes;
}

double halfDiagonal(const std::vector<Vec3>& points) {
  Vec3 low = points.front(), high = low;
  for (const Vec3& p : points) {
    low = low.cwiseMin(p);
    high = high.cwiseMax(p);
  }
  return 0.5 * (high - low).norm();
}

// Numbers the corner normals so that equal ones of a vertex or of a triangle have one number.
class NormalNumbers {
 public:
  NormalNumbers(const TriangleMesh& mesh, const CornerNormals& corners) : latest_(mesh.vertices.size(), -1) {
    numbers.resize(mesh.triangles.size());
    for (std::size_t t = 0; t < numbers.size(); ++t) {
      for (std::size_t i = 0; i < 3; ++i) {
        std::int32_t& latest = latest_[static_cast<std::size_t>(mesh.triangles[t][i])];
        const Vec3& n = corners.normals[t][i];
        std::int32_t number = findAtVertex(latest, n);
        if (number < 0) {
          for (std::size_t j = 0; j < i; ++j) number = is(numbers[t][j], n) ? numbers[t][j] : number;
          if (number < 0) {
            number = static_cast<std::int32_t>(distinct.size());
            distinct.push_back(n);
          }
          seen_.push_back({number, latest});
          latest = static_cast<std::int32_t>(seen_.size()) - 1;
        }
        numbers[t][i] = number;
      }
    }
  }

  std::vector<Vec3> distinct;
  std::vector<std::array<std::int32_t, 3>> numbers;

 private:
  struct Seen {
    std::int32_t number, before;  // in seen_, -1: none
  };

  bool is(std::int32_t number, const Vec3& n) const { return distinct[static_cast<std::size_t>(number)] == n; }
  std::int32_t findAtVertex(std::int32_t latest, const Vec3& n) const {
    for (std::int32_t i = latest; i >= 0; i = seen_[static_cast<std::size_t>(i)].before) {
      if (is(seen_[static_cast<std::size_t>(i)].number, n)) return seen_[static_cast<std::size_t>(i)].number;
    }
    return -1;
  }

  std::vector<std::int32_t> latest_;  // per vertex, in seen_
  std::vector<Seen> seen_;
};

template <class T>
std::size_t bytesOf(const std::vector<T>& v) {
  return v.capacity() * sizeof(T);
}

}  // namespace

SurfaceNet::SurfaceNet(TriangleMesh mesh, double crease_angle, bool use_file_normals, SurfaceVariant variant)
    : variant_(variant),
      is_flat_(variant == SurfaceVariant::facet || variant == SurfaceVariant::force),
      mesh_(std::move(mesh)),
      length_(halfDiagonal(mesh_.vertices)) {
  const Neighbours neighbours = findNeighbours(mesh_);
  neighbours_ = packed(neighbours);
  if (variant != SurfaceVariant::facet) {
    const CornerNormals corners = findCornerNormals(mesh_, neighbours, crease_angle, use_file_normals);
    NormalNumbers numbers(mesh_, corners);
    normals_ = std::move(numbers.distinct);
    corner_normals_ = std::move(numbers.numbers);
  }
  for (std::int32_t t = 0; t < size(); ++t) {
    for (int i = 0; i < 3; ++i) {
      if (neighbour(t, i).triangle >= 0 && haveOtherNormals(t, i)) neighbours_[at(t)][at(i)] += 4;
    }
  }
  mesh_.normals = {};
  mesh_.triangle_normals = {};
  mesh_.vertices.shrink_to_fit();
  mesh_.triangles.shrink_to_fit();
  normals_.shrink_to_fit();
  preferLargePages(mesh_.vertices);
  preferLargePages(mesh_.triangles);
  preferLargePages(neighbours_);
  preferLargePages(normals_);
  preferLargePages(corner_normals_);
  Fingerprint fingerprint;
  fingerprint.add(static_cast<std::uint64_t>(variant));
  for (const Vec3& v : mesh_.vertices) fingerprint.add(v);
  for (const Vec3& n : normals_) fingerprint.add(n);
  for (const auto& triangle : mesh_.triangles) fingerprint.add(triangle);
  for (const auto& numbers : corner_normals_) fingerprint.add(numbers);
  fingerprint_ = fingerprint.value();
}

Vec3 SurfaceNet::facetNormal(std::int32_t triangle) const {
  const Vec3& p = vertex(triangle, 0);
  return (vertex(triangle, 1) - p).cross(vertex(triangle, 2) - p).normalized();
}

// Whether the two sides of an inner edge do.
bool SurfaceNet::haveOtherNormals(std::int32_t triangle, int edge) const {
  const Neighbour other = neighbour(triangle, edge);
  const int next = (edge + 1) % 3, other_next = (other.edge + 1) % 3;
  if (is_flat_)
    return normal(triangle, edge) != normal(other.triangle, other_next) || normal(triangle, next) != normal(other.triangle, other.edge);
  const auto &numbers = corner_normals_[at(triangle)],
             &others = corner_normals_[at(other.triangle)];  // equal normals of a vertex share theirs
  return numbers[at(edge)] != others[at(other_next)] || numbers[at(next)] != others[at(other.edge)];
}

[[gnu::flatten]] void SurfaceNet::build(std::int32_t triangle, SurfaceCell& cell) const {
  cell.neighbours = {neighbour(triangle, 0), neighbour(triangle, 1), neighbour(triangle, 2)};
  cell.vertices = mesh_.triangles[at(triangle)];
  Patch& p = cell.patch;
  p.b300 = vertex(triangle, 0);
  p.b030 = vertex(triangle, 1);
  p.b003 = vertex(triangle, 2);
  p.n200 = normal(triangle, 0);
  p.n020 = normal(triangle, 1);
  p.n002 = normal(triangle, 2);
  setMiddleNormals(p);
  if (is_flat_) {
    cell.sharp = {true, true, true};
    setStraightEdges(p);
  } else {
    cell.sharp = {isSharp(triangle, 0), isSharp(triangle, 1), isSharp(triangle, 2)};
    setEdges(*this, triangle, cell);
    if (variant_ == SurfaceVariant::smooth_published) setPublishedEdges(p);
  }
  if (variant_ != SurfaceVariant::smooth || !setCentreByMedians(p)) setCentre(p);
}

// Who comes here goes on to a neighbour: what that is built from is fetched from memory meanwhile, its numbers first, then what they lead to.
void SurfaceNet::fill(std::int32_t triangle, PatchCache::Place& place) const {
  const auto& codes = neighbours_[at(triangle)];
  for (const std::int32_t code : codes) {
    if (code < 0) continue;
    const std::size_t other = at(code / 8);
    __builtin_prefetch(&mesh_.triangles[other]);
    __builtin_prefetch(&neighbours_[other]);
    if (!is_flat_) __builtin_prefetch(&corner_normals_[other]);
  }
  place.net = fingerprint_;
  place.triangle = triangle;
  build(triangle, place.cell);
  for (const std::int32_t code : codes) {
    if (code < 0) continue;
    const std::size_t other = at(code / 8), across = at((code % 4 + 2) % 3);
    __builtin_prefetch(&mesh_.vertices[at(mesh_.triangles[other][across])]);
    if (!is_flat_) __builtin_prefetch(&normals_[at(corner_normals_[other][across])]);
  }
}

std::size_t SurfaceNet::memoryBytes() const {
  return bytesOf(mesh_.vertices) + bytesOf(mesh_.triangles) + bytesOf(neighbours_) + bytesOf(normals_) + bytesOf(corner_normals_);
}

}  // namespace pincer::contact
