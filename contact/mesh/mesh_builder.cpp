#include "pincer/contact/mesh/mesh_builder.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <limits>

#include "pincer/contact/functions/invariants.h"

namespace pincer::contact {

namespace {

// The remedy for faces without area.
constexpr const char* kDelete = "Delete degenerate faces in a mesh editor and export again.";
constexpr std::size_t kEnoughTriangles = 50'000;  // for a finger: facets of 1 mm on a hand-sized object

std::string textOf(const Vec3& p) { return fmt::format("({:g}, {:g}, {:g})", p.x(), p.y(), p.z()); }

// Unit normals keep their bits, so that what was written from a mesh reads back the same.
// Divided first so that no square overflows.
Vec3 unit(const Vec3& n, double largest) {
  constexpr double kRoundOff = 8 * std::numeric_limits<double>::epsilon();  // of a sum of three squares
  if (largest <= 1 && std::abs(n.squaredNorm() - 1) < kRoundOff) return n;
  return (n / largest).normalized();
}

}  // namespace

MeshBuilder::MeshBuilder(const MeshFile& file, const ReadOptions& options, int first_index)
    : file_(file), options_(options), first_index_(static_cast<std::size_t>(first_index)) {
  mesh_.source = file.name();
  if (options.metres_per_unit > 0 && std::isfinite(options.metres_per_unit)) return;
  file.fail(fmt::format("metres per unit = {} must be a finite number above 0: 0.001 for millimetres.",
                        options.metres_per_unit));
}

void MeshBuilder::requireFew(std::size_t triangles, std::int32_t place) const {
  if (triangles <= kMaxTriangles) return;
  file_.failAt(place,
               fmt::format("the mesh has more than {} triangles. Simplify (decimate) it; a finger feels {} as well.",
                           kMaxTriangles, kEnoughTriangles));
}

void MeshBuilder::reserveFaces(std::size_t faces, std::int32_t place) {
  requireFew(faces, place);
  faces_.reserve(faces);
  corners_.reserve(3 * faces);
}

void MeshBuilder::requireRoom(std::size_t count, const char* what, std::int32_t place) const {
  if (count < kMaxVertices) return;
  file_.failAt(place, fmt::format("the mesh has more than {} {}. Simplify (decimate) it.", kMaxVertices, what));
}

void MeshBuilder::addVertex(const Vec3& p, std::int32_t place) {
  requireRoom(vertices(), "vertices", place);
  PINCER_ASSERT(p.allFinite());
  const Vec3 scaled = options_.metres_per_unit * p;
  const double farthest = scaled.cwiseAbs().maxCoeff();
  if (!(farthest <= kMaxCoordinate)) {
    file_.failAt(
        place,
        fmt::format("vertex {} lies {:.3g} m from the origin along an axis; the limit is {} m. Is the unit right?",
                    nextVertex(), farthest, kMaxCoordinate));
  }
  mesh_.vertices.push_back(scaled);
}

void MeshBuilder::addNormal(const Vec3& n, std::int32_t place) {
  requireRoom(normals(), "normals", place);
  PINCER_ASSERT(n.allFinite());
  const double largest = n.cwiseAbs().maxCoeff();
  if (largest == 0) {
    file_.failAt(
        place,
        fmt::format("normal {} is zero and has no direction. Recompute the normals, or export the mesh without them.",
                    nextNormal()));
  }
  mesh_.normals.push_back(unit(n, largest));
}

void MeshBuilder::beginFace(std::int64_t corners, std::int32_t place) {
  if (corners > static_cast<std::int64_t>(kMaxCorners)) {
    file_.failAt(place, fmt::format("face {} has {} corners; the limit is {}. Triangulate the mesh before export.",
                                    nextFace(), corners, kMaxCorners));
  }
  const auto needed = static_cast<std::size_t>(std::max<std::int64_t>(corners, 2));
  triangles_ += needed - 2;
  requireFew(triangles_, place);
  faces_.push_back({corners_.size(), place, group_, part_});
  if (corners >= 3) return;
  leaveOutIfBad(faces_.back(), [&] {
    file_.failAt(place,
                 fmt::format("face {} has {} corners; it needs at least 3. {}", nextFace() - 1, corners, kDelete));
  });
}

void MeshBuilder::addCorner(std::int64_t vertex, std::int64_t normal) {
  PINCER_ASSERT(!faces_.empty());  // begun
  if (faces_.back().is_left_out) return;
  leaveOutIfBad(faces_.back(), [&] { corners_.push_back({inRange(vertex, "vertex"), inRange(normal, "normal")}); });
}

std::int32_t MeshBuilder::inRange(std::int64_t index, const char* what) const {
  if (index >= std::numeric_limits<std::int32_t>::min() / 2 && index <= std::numeric_limits<std::int32_t>::max() / 2) {
    return static_cast<std::int32_t>(index);
  }
  file_.failAt(faces_.back().place,
               fmt::format("face {} uses {} {}; this is out of range: no file has that many. {}", nextFace() - 1, what,
                           index + static_cast<std::int64_t>(first_index_), kCutOffOrJoined));
}

TriangleMesh MeshBuilder::build() {
  if (faces_.empty()) {
    file_.fail(
        fmt::format("the file has {} vertices but no face, so there is nothing to touch. Export the mesh as polygons.",
                    vertices()));
  }
  dropUnusedFeatures();
  mesh_.triangles.reserve(triangles_);
  parts_.reserve(triangles_);
  addPolygons();
  PINCER_ASSERT(mesh_.triangle_normals.empty() || mesh_.triangle_normals.size() == mesh_.triangles.size());
  PINCER_ASSERT(mesh_.smoothing_groups.empty() || mesh_.smoothing_groups.size() == mesh_.triangles.size());
  return std::move(mesh_);
}

void MeshBuilder::addPolygons() {
  for (std::size_t i = 0; i < faces_.size(); ++i) {
    if (faces_[i].is_left_out) continue;
    const std::size_t before = mesh_.triangles.size();
    leaveOutIfBad(faces_[i], [&] { addPolygon(polygon(i)); });
    if (faces_[i].is_left_out) cutOff(before);
  }
  if (!mesh_.triangles.empty()) return;
  file_.fail(
      fmt::format("none of its {} faces can be used, so there is nothing to touch. Export it again.", faces_.size()));
}

void MeshBuilder::cutOff(std::size_t triangles) {
  mesh_.triangles.resize(triangles);
  parts_.resize(triangles);
  if (!mesh_.triangle_normals.empty()) mesh_.triangle_normals.resize(triangles);
  if (!mesh_.smoothing_groups.empty()) mesh_.smoothing_groups.resize(triangles);
}

MeshBuilder::Polygon MeshBuilder::polygon(std::size_t face) const {
  const std::size_t first = faces_[face].first_corner;
  const std::size_t end = face + 1 < faces_.size() ? faces_[face + 1].first_corner : corners_.size();
  return {face + first_index_,
          faces_[face].place,
          faces_[face].group,
          faces_[face].part,
          {corners_.data() + first, end - first}};
}

// Normals that no corner uses, and groups that are all "off", say nothing: programs write "s off" for want of groups.
void MeshBuilder::dropUnusedFeatures() {
  if (std::any_of(corners_.begin(), corners_.end(), [](const Corner& c) { return c.normal >= 0; })) {
    mesh_.triangle_normals.reserve(triangles_);
  } else {
    mesh_.normals.clear();
  }
  if (std::any_of(faces_.begin(), faces_.end(), [](const Face& f) { return f.group != 0; }))
    mesh_.smoothing_groups.reserve(triangles_);
}

void MeshBuilder::addPolygon(const Polygon& face) {
  checkIndices(face);
  if (options_.degenerate == Degenerate::reject) rejectRepeatedVertex(face);
  if (face.corners.size() == 3) return addTriangle(face, {0, 1, 2});
  for (const CornerTriple& triple : triplesOf(face)) addTriangle(face, triple);
}

void MeshBuilder::checkIndices(const Polygon& face) const {
  const auto require = [&](std::int32_t index, std::size_t count, const char* what) {
    if (index < static_cast<std::int64_t>(count)) return;
    file_.failAt(face.place,
                 fmt::format("face {} uses {} {}, but the file has {} (from {}). {}", face.number, what,
                             static_cast<std::size_t>(index) + first_index_, count, first_index_, kCutOffOrJoined));
  };
  for (const Corner& c : face.corners) {
    if (c.vertex < 0) {
      file_.failAt(face.place, fmt::format("face {} uses vertex {}, but the file has {} (from {}). {}", face.number,
                                           c.vertex + static_cast<std::int64_t>(first_index_), vertices(), first_index_,
                                           kCutOffOrJoined));
    }
    require(c.vertex, vertices(), "vertex");
    require(c.normal, normals(), "normal");
  }
}

void MeshBuilder::rejectRepeatedVertex(const Polygon& face) const {
  const auto fail = [&](std::int32_t vertex) {
    file_.failAt(face.place, fmt::format("face {} uses vertex {} at {} m twice. {}", face.number,
                                         static_cast<std::size_t>(vertex) + first_index_,
                                         textOf(mesh_.vertices[static_cast<std::size_t>(vertex)]), kDelete));
  };
  if (face.corners.size() == 3) {  // without the sorting, which would take most of the time
    const std::int32_t a = face.corners[0].vertex, b = face.corners[1].vertex, c = face.corners[2].vertex;
    if (a == b || a == c) fail(a);
    if (b == c) fail(b);
    return;
  }
  std::vector<std::int32_t> used;
  for (const Corner& c : face.corners) used.push_back(c.vertex);
  std::sort(used.begin(), used.end());
  const auto twice = std::adjacent_find(used.begin(), used.end());
  if (twice != used.end()) fail(*twice);
}

std::vector<CornerTriple> MeshBuilder::triplesOf(const Polygon& face) const {
  std::vector<Vec3> points;
  for (const Corner& c : face.corners) points.push_back(at(c));
  std::vector<CornerTriple> triples = triangulate(points);
  if (triples.empty() && options_.degenerate == Degenerate::keep) triples = degenerateTriples(points);
  if (triples.empty()) {
    file_.failAt(
        face.place,
        fmt::format("face {} with {} corners has no area or crosses itself. Triangulate the mesh before export.",
                    face.number, face.corners.size()));
  }
  return triples;
}

// Of a polygon with corners in the same place: its pieces without them, and an empty triangle for each; of a polygon on
// one line a fan of empty triangles. None if the polygon crosses itself.
std::vector<CornerTriple> MeshBuilder::degenerateTriples(const std::vector<Vec3>& points) const {
  const int n = static_cast<int>(points.size());
  std::vector<Vec3> distinct;
  std::vector<int> kept;
  std::vector<CornerTriple> empty, fan;
  bool on_one_line = true;
  for (int i = 0; i < n; ++i) {
    const auto here = static_cast<std::size_t>(i), next = static_cast<std::size_t>((i + 1) % n);
    if (points[here] == points[next]) {
      empty.push_back({i, (i + 1) % n, (i + 2) % n});
    } else {
      distinct.push_back(points[here]);
      kept.push_back(i);
    }
    if (i == 0 || i + 1 == n) continue;
    fan.push_back({0, i, i + 1});
    on_one_line = on_one_line && hasZeroArea(points[0], points[here], points[next]);
  }
  if (on_one_line) return fan;
  if (distinct.size() < 3) return {};
  std::vector<CornerTriple> triples = triangulate(distinct);
  if (triples.empty()) return {};
  for (CornerTriple& triple : triples) {
    for (int& corner : triple) corner = kept[static_cast<std::size_t>(corner)];
  }
  triples.insert(triples.end(), empty.begin(), empty.end());
  return triples;
}

void MeshBuilder::addTriangle(const Polygon& face, const CornerTriple& triple) {
  std::array<std::int32_t, 3> v{}, n{};
  for (std::size_t i = 0; i < 3; ++i) {
    const Corner& c = face.corners[static_cast<std::size_t>(triple[i])];
    v[i] = c.vertex;
    n[i] = c.normal;
  }
  const Vec3 &p0 = mesh_.vertices[static_cast<std::size_t>(v[0])], &p1 = mesh_.vertices[static_cast<std::size_t>(v[1])],
             &p2 = mesh_.vertices[static_cast<std::size_t>(v[2])];
  if (options_.degenerate == Degenerate::reject && hasZeroArea(p0, p1, p2)) {
    const auto number = [&](std::size_t i) { return static_cast<std::size_t>(v[i]) + first_index_; };
    file_.failAt(
        face.place,
        fmt::format("face {} has zero area: its vertices {}, {} and {} at {}, {} and {} m lie on one line. {}",
                    face.number, number(0), number(1), number(2), textOf(p0), textOf(p1), textOf(p2), kDelete));
  }
  mesh_.triangles.push_back(v);
  parts_.push_back(face.part);
  if (mesh_.triangle_normals.capacity() > 0) mesh_.triangle_normals.push_back(n);
  if (mesh_.smoothing_groups.capacity() > 0) mesh_.smoothing_groups.push_back(face.group);
}

}  // namespace pincer::contact
