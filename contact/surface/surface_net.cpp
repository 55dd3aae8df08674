#include "pincer/contact/surface/surface_net.h"

#include <algorithm>
#include <bit>

#include "pincer/contact/functions/invariants.h"
#include "pincer/contact/surface/edge_cubic.h"
#include "pincer/contact/surface/large_pages.h"
#include "pincer/contact/surface/smooth_patch.h"

namespace pincer::contact {

namespace {

Vec3& firstHandle(Patch& p, int edge) { return edge == 0 ? p.b210 : edge == 1 ? p.b021 : p.b102; }
Vec3& secondHandle(Patch& p, int edge) { return edge == 0 ? p.b120 : edge == 1 ? p.b012 : p.b201; }
Vec3& middleNormalOf(Patch& p, int edge) { return edge == 0 ? p.n110 : edge == 1 ? p.n011 : p.n101; }

// The ends of edge i of triangle t, as seen along it.
std::array<EdgeEnd, 2> edgeEnds(const SurfaceNet& net, std::int32_t t, int i) {
  const int next = (i + 1) % 3;
  const Vec3 &p0 = net.vertex(t, i), &p1 = net.vertex(t, next), left0 = net.normal(t, i), left1 = net.normal(t, next);
  const Neighbour other = net.neighbour(t, i);
  if (other.triangle < 0) return {EdgeEnd{p0, left0, left0}, EdgeEnd{p1, left1, left1}};
  const Vec3 right0 = net.normal(other.triangle, (other.edge + 1) % 3), right1 = net.normal(other.triangle, other.edge);
  return {EdgeEnd{p0, left0, right0}, EdgeEnd{p1, left1, right1}};
}

void setEdge(Patch& p, int i, const Vec3& first, const Vec3& second, const Vec3& normal) {
  firstHandle(p, i) = first;
  secondHandle(p, i) = second;
  middleNormalOf(p, i) = normal;
}

// The middle of an edge: its place [m], its normal of any length.
template <class Vec>
struct Middle {
  Vec M, N;
};
template <class Vec>
Middle<Vec> middleOf(const Vec& p0, const Vec& p1, const Handles<Vec>& handles, const Vec& n0, const Vec& n1,
                     const Vec& normal) {
  return {0.125 * ((p0 + p1) + 3 * (handles.first + handles.second)), (n0 + n1) + 2 * normal};
}
Middle<Vec3> middleOf(const Patch& p, int i) {
  const auto curve = edgeCurve(p, i);
  const auto normals = edgeNormals(p, i);
  return middleOf<Vec3>(curve[0], curve[3], {curve[1], curve[2]}, normals[0], normals[2], normals[1]);
}

// Of a patch's edges, two side by side.
struct Middles {
  Middle<Vec3> first;
  Middle<VecPair> others;
};
Middles middlesOf(const Patch& p) {
  const Middle<Vec3> second = middleOf(p, 1), third = middleOf(p, 2);
  return {middleOf(p, 0), {VecPair(second.M, third.M), VecPair(second.N, third.N)}};
}

// All edges as if they were smooth.
Middles setSmoothEdges(Patch& p) {
  const Handles<Vec3> handles = smoothHandles(p.b300, p.b030, p.n200, p.n020);
  const Vec3 normal = middleNormal(p.b300, p.b030, p.n200, p.n020);
  const VecPair p0(p.b030, p.b003), p1(p.b003, p.b300), n0(p.n020, p.n002), n1(p.n002, p.n200);
  const Handles<VecPair> others = smoothHandles(p0, p1, n0, n1);
  const VecPair normals = middleNormal(p0, p1, n0, n1);
  setEdge(p, 0, handles.first, handles.second, normal);
  setEdge(p, 1, others.first.first(), others.second.first(), normals.first());
  setEdge(p, 2, others.first.second(), others.second.second(), normals.second());
  return {middleOf(p.b300, p.b030, handles, p.n200, p.n020, normal), middleOf(p0, p1, others, n0, n1, normals)};
}

// True if the triangle is the first of an edge's: as that one sees it the edge is computed, so
// that the two sides share it to the last bit.
bool isFirst(std::int32_t triangle, const Neighbour& other) { return other.triangle < 0 || triangle < other.triangle; }

void setSharpEdge(const SurfaceNet& net, std::int32_t triangle, int i, SurfaceCell& cell) {
  const Neighbour other = cell.neighbours[static_cast<std::size_t>(i)];
  const bool is_first = isFirst(triangle, other);
  const auto [from, to] = is_first ? edgeEnds(net, triangle, i) : edgeEnds(net, other.triangle, other.edge);
  const auto [first, second] = edgeHandles(from, to);
  firstHandle(cell.patch, i) = is_first ? first : second;
  secondHandle(cell.patch, i) = is_first ? second : first;
}

Middles setSharpEdges(const SurfaceNet& net, std::int32_t triangle, SurfaceCell& cell) {
  for (int i = 0; i < 3; ++i) {
    if (cell.sharp[static_cast<std::size_t>(i)]) setSharpEdge(net, triangle, i, cell);
  }
  return middlesOf(cell.patch);
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

// By what the median from the corner `P` with normal `n` to the middle of the side across is bent after 2/3 of its way
// [m]: 27 times its place there is 9 P + 18 M + 6 (5 sigma N - 4 rho n).
template <class Vec>
Vec bendOfMedian(const Vec& P, const Vec& n, const Middle<Vec>& across) {
  const auto [rho, sigma] = edgeBends(Vec(across.M - P), n, across.N, across.N.squaredNorm());
  return 5 * sigma * across.N - 4 * rho * n;
}

// So that the patch's middle is the medians' mean: on spheres no further off than its edges; with Vlachos' centre it is
// the worst place. Returns whether there is one: not where a side's normals are opposite.
bool setCentreByMedians(Patch& p, const Middles& middles) {
  const VecPair bends = bendOfMedian(VecPair(p.b300, p.b030), VecPair(p.n200, p.n020), middles.others);
  const Vec3 bend = bends.first() + bends.second() + bendOfMedian(p.b003, p.n002, middles.first);
  const Vec3 corners = p.b300 + p.b030 + p.b003, handles = p.b210 + p.b120 + p.b021 + p.b012 + p.b102 + p.b201;
  p.b111 = (14 * corners - 3 * handles + 8 * bend) / 24;
  return p.b111.allFinite();
}

// Of an edge or median whose ends' normals weigh 1 : w, how much less it is bent. (On a cone its middle is then exact.)
double flattening(double w) { return 4 * w / ((1 + w) * (1 + w)); }

// The first end of the edge outweighs the second by `excess`.
void weighEdge(Patch& p, int i, double excess) {
  const auto curve = edgeCurve(p, i);
  const auto normals = edgeNormals(p, i);
  const double w = 1 + std::abs(excess), more = 0.5 * (w - 1), less = 0.5 * (1 / w - 1);
  const double first = excess > 0 ? more : less, second = excess > 0 ? less : more, bend = flattening(w);
  const Vec3 third = (curve[3] - curve[0]) / 3;
  setEdge(p, i, curve[0] + third + bend * (curve[1] - curve[0] - third),
          curve[3] - third + bend * (curve[2] - curve[3] + third),
          normals[1] + (first * normals[0] + second * normals[2]));
}

// First over second end, from what is kept of an edge.
double ratioOf(float excess) {
  return excess < 0 ? 1 / (1 - static_cast<double>(excess)) : 1 + static_cast<double>(excess);
}

// With the corners' weights as the triangle's edges have them.
[[gnu::noinline]] bool setCentreByMedians(Patch& p, const std::array<float, 3>& excess) {
  const std::array<double, 3> corner = {1, 1 / ratioOf(excess[0]), ratioOf(excess[2])};
  const std::array<Vec3, 3> P = {p.b300, p.b030, p.b003}, n = {p.n200, p.n020, p.n002};
  Vec3 bend = Vec3::Zero(), corners = P[0] + P[1] + P[2];
  for (std::size_t i = 0; i < 3; ++i) {
    const double across = 0.5 * (corner[(i + 1) % 3] + corner[(i + 2) % 3]);
    bend += flattening(across / corner[i]) * bendOfMedian(P[i], n[i], middleOf(p, static_cast<int>((i + 1) % 3)));
  }
  const Vec3 handles = p.b210 + p.b120 + p.b021 + p.b012 + p.b102 + p.b201;
  p.b111 = (14 * corners - 3 * handles + 8 * bend) / 24;
  return p.b111.allFinite();
}

bool areEven(const std::array<float, 3>& excess) { return excess[0] == 0 && excess[1] == 0 && excess[2] == 0; }

[[gnu::noinline]] void weighEdges(Patch& p, const std::array<float, 3>& excess) {
  for (int i = 0; i < 3; ++i) {
    if (excess[static_cast<std::size_t>(i)] != 0) weighEdge(p, i, excess[static_cast<std::size_t>(i)]);
  }
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

Patch smoothPatch(const std::array<Vec3, 3>& corners, const std::array<Vec3, 3>& normals) {
  Patch p;
  p.b300 = corners[0];
  p.b030 = corners[1];
  p.b003 = corners[2];
  p.n200 = normals[0];
  p.n020 = normals[1];
  p.n002 = normals[2];
  const Middles middles = setSmoothEdges(p);
  if (!setCentreByMedians(p, middles)) setCentre(p);
  return p;
}

SurfaceNet::SurfaceNet(TriangleMesh mesh, double crease_angle, bool use_file_normals, SurfaceVariant variant)
    : variant_(variant),
      is_flat_(variant == SurfaceVariant::facet || variant == SurfaceVariant::force),
      mesh_(std::move(mesh)),
      length_(halfDiagonal(mesh_.vertices)) {
  const Neighbours neighbours = findNeighbours(mesh_);
  links_.resize(neighbours.size());
  for (std::size_t t = 0; t < links_.size(); ++t) {
    for (std::size_t i = 0; i < 3; ++i) {
      const auto [other, edge] = neighbours[t][i];
      links_[t].across[i] = other < 0 ? -1 : 8 * other + edge;
      PINCER_ASSERT(other < 0 || neighbours[at(other)][at(edge)].triangle == static_cast<std::int32_t>(t));  // and back
    }
  }
  if (variant != SurfaceVariant::facet) {
    const CornerNormals corners = findCornerNormals(mesh_, neighbours, crease_angle, use_file_normals);
    NormalNumbers numbers(mesh_, corners);
    normals_ = std::move(numbers.distinct);
    if (variant == SurfaceVariant::smooth) weights_ = findEdgeWeights(mesh_, neighbours, corners);
    PINCER_ASSERT(std::all_of(normals_.begin(), normals_.end(), [](const Vec3& n) { return isUnit(n); }));
    for (std::size_t t = 0; t < links_.size(); ++t) links_[t].normals = numbers.numbers[t];
  }
  for (std::int32_t t = 0; t < size(); ++t) {
    for (int i = 0; i < 3; ++i) {
      if (neighbour(t, i).triangle >= 0 && haveOtherNormals(t, i)) links_[at(t)].across[at(i)] += 4;
    }
  }
  mesh_.normals = {};
  mesh_.triangle_normals = {};
  mesh_.vertices.shrink_to_fit();
  mesh_.triangles.shrink_to_fit();
  normals_.shrink_to_fit();
  preferLargePages(mesh_.vertices);
  preferLargePages(mesh_.triangles);
  preferLargePages(links_);
  preferLargePages(normals_);
  Fingerprint fingerprint;
  fingerprint.add(static_cast<std::uint64_t>(variant));
  for (const Vec3& v : mesh_.vertices) fingerprint.add(v);
  for (const Vec3& n : normals_) fingerprint.add(n);
  for (const auto& triangle : mesh_.triangles) fingerprint.add(triangle);
  for (const Links& links : links_) fingerprint.add(links.normals);
  for (const auto& weights : weights_) {
    for (const float w : weights) fingerprint.add(std::bit_cast<std::uint32_t>(w));
  }
  fingerprint_ = fingerprint.value();
}

Vec3 SurfaceNet::facetNormal(std::int32_t triangle) const {
  const Vec3& p = vertex(triangle, 0);
  return (vertex(triangle, 1) - p).cross(vertex(triangle, 2) - p).normalized();
}

// True if the two sides of an inner edge do.
bool SurfaceNet::haveOtherNormals(std::int32_t triangle, int edge) const {
  const Neighbour other = neighbour(triangle, edge);
  const int next = (edge + 1) % 3, other_next = (other.edge + 1) % 3;
  if (is_flat_)
    return normal(triangle, edge) != normal(other.triangle, other_next) ||
           normal(triangle, next) != normal(other.triangle, other.edge);
  const auto &numbers = links_[at(triangle)].normals,
             &others = links_[at(other.triangle)].normals;  // equal normals of a vertex share theirs
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
  Middles middles = setSmoothEdges(p);
  const bool is_weighted = !weights_.empty() && !areEven(weights_[at(triangle)]);
  if (is_flat_) {
    cell.sharp = {true, true, true};
    setStraightEdges(p);
  } else {
    cell.sharp = {isSharp(triangle, 0), isSharp(triangle, 1), isSharp(triangle, 2)};
    if (is_weighted) weighEdges(p, weights_[at(triangle)]);
    if (cell.sharp[0] || cell.sharp[1] || cell.sharp[2]) middles = setSharpEdges(*this, triangle, cell);
    if (variant_ == SurfaceVariant::smooth_published) setPublishedEdges(p);
  }
  const bool has_medians =
      variant_ == SurfaceVariant::smooth &&
      (is_weighted ? setCentreByMedians(p, weights_[at(triangle)]) : setCentreByMedians(p, middles));
  if (!has_medians) setCentre(p);
}

inline void SurfaceNet::fetchAround(std::int32_t triangle) const {
  for (const std::int32_t code : links_[at(triangle)].across) {
    if (code < 0) continue;
    __builtin_prefetch(&mesh_.triangles[at(code / 8)]);
    __builtin_prefetch(&links_[at(code / 8)]);
  }
}

// Who comes here goes on to a neighbour, or over it: what those are built from is fetched from memory meanwhile, their
// numbers first, then what the neighbours' lead to, and the numbers of those beyond.
void SurfaceNet::fill(std::int32_t triangle, PatchCache::Place& place) const {
  constexpr std::array<std::size_t, 3> kOpposite = {2, 0, 1};  // the corner across an edge
  fetchAround(triangle);
  place.net = fingerprint_;
  place.triangle = triangle;
  build(triangle, place.cell);
  for (const std::int32_t code : links_[at(triangle)].across) {
    if (code < 0) continue;
    const std::size_t corner = kOpposite[at(code % 4)];
    __builtin_prefetch(&mesh_.vertices[at(mesh_.triangles[at(code / 8)][corner])]);
    __builtin_prefetch(normals_.data() + links_[at(code / 8)].normals[corner]);
    fetchAround(code / 8);
  }
}

std::size_t SurfaceNet::memoryBytes() const {
  return bytesOf(mesh_.vertices) + bytesOf(mesh_.triangles) + bytesOf(links_) + bytesOf(weights_) + bytesOf(normals_);
}

}  // namespace pincer::contact
