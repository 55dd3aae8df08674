#include "pincer/contact/polytope.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <map>
#include <numeric>

#include "pincer/contact/error.h"
#include "pincer/contact/functions/invariants.h"
#include "pincer/contact/mesh/union_find.h"
#include "pincer/contact/shape/quick_hull.h"
#include "pincer/contact/surface/convex_hull.h"

namespace pincer::contact {
namespace {

using HullFacet = std::array<int, 3>;

constexpr int kPlaneTries = 5;  // each takes a tenth of what the last one took for one plane

Vec3 normalOf(const std::vector<Vec3>& p, const HullFacet& f) {
  const auto at = [&](int k) -> const Vec3& { return p[static_cast<std::size_t>(f[static_cast<std::size_t>(k)])]; };
  return (at(1) - at(0)).cross(at(2) - at(0));
}

double sizeOf(const std::vector<Vec3>& points) {
  Vec3 low = points.front(), high = points.front();
  for (const Vec3& p : points) low = low.cwiseMin(p), high = high.cwiseMax(p);
  return (high - low).norm();
}

void requirePoints(const std::vector<Vec3>& points, const std::string& source) {
  if (points.size() < 4)
    throw InputError(fmt::format("{}: {} points make no solid. A convex solid needs at least 4, not in one plane.",
                                 source, points.size()));
  for (std::size_t i = 0; i < points.size(); ++i) {
    if (!points[i].allFinite())
      throw InputError(fmt::format("{}: point {} isn't finite. Give numbers in metres.", source, i));
  }
}

[[noreturn]] void rejectFlat(const std::string& source) {
  throw InputError(fmt::format(
      "{}: all points lie in one plane (or nearly so), and their hull has no volume. Add points off that plane.",
      source));
}

using HalfEdges = std::map<std::pair<int, int>, int>;  // from, to -> facet

HalfEdges halfEdgesOf(const std::vector<HullFacet>& facets) {
  HalfEdges edges;
  for (std::size_t f = 0; f < facets.size(); ++f) {
    for (std::size_t k = 0; k < 3; ++k) edges[{facets[f][k], facets[f][(k + 1) % 3]}] = static_cast<int>(f);
  }
  return edges;
}

int thirdCorner(const HullFacet& f, int a, int b) {
  for (const int c : f) {
    if (c != a && c != b) return c;
  }
  return f[0];
}

// Twice the area over the longest side: how far a facet is from having no direction.
double heightOf(const std::vector<Vec3>& p, const HullFacet& f) {
  double longest = 0;
  for (std::size_t k = 0; k < 3; ++k)
    longest =
        std::max(longest, (p[static_cast<std::size_t>(f[(k + 1) % 3])] - p[static_cast<std::size_t>(f[k])]).norm());
  return longest > 0 ? normalOf(p, f).norm() / longest : 0;
}

// Facets that lie in one plane are one face: judged by the larger of two neighbours. A sliver has no direction of its
// own, and would join the faces on either side of it: it goes to the one across its longest side.
std::vector<int> groupsOf(const std::vector<Vec3>& points, const std::vector<HullFacet>& facets, const HalfEdges& edges,
                          double flat) {
  UnionFind groups(facets.size());
  const auto at = [&](int v) -> const Vec3& { return points[static_cast<std::size_t>(v)]; };
  std::vector<bool> sliver(facets.size());
  for (std::size_t f = 0; f < facets.size(); ++f) sliver[f] = heightOf(points, facets[f]) < 10 * flat;
  for (const auto& [ends, f] : edges) {
    const auto other = edges.find({ends.second, ends.first});
    if (other == edges.end() || other->second < f) continue;
    if (sliver[static_cast<std::size_t>(f)] || sliver[static_cast<std::size_t>(other->second)]) continue;
    const HullFacet &a = facets[static_cast<std::size_t>(f)], &b = facets[static_cast<std::size_t>(other->second)];
    const Vec3 na = normalOf(points, a), nb = normalOf(points, b);
    const bool a_is_larger = na.squaredNorm() >= nb.squaredNorm();
    const Vec3& n = a_is_larger ? na : nb;
    const int far = thirdCorner(a_is_larger ? b : a, ends.first, ends.second);
    if (std::abs(n.dot(at(far) - at(ends.first))) <= flat * n.norm()) groups.join(f, other->second);
  }
  for (std::size_t f = 0; f < facets.size(); ++f) {
    if (!sliver[f]) continue;
    std::size_t longest = 0;
    const auto side = [&](std::size_t k) { return (at(facets[f][(k + 1) % 3]) - at(facets[f][k])).norm(); };
    for (std::size_t k = 1; k < 3; ++k) {
      if (side(k) > side(longest)) longest = k;
    }
    const auto other = edges.find({facets[f][(longest + 1) % 3], facets[f][longest]});
    if (other != edges.end()) groups.join(static_cast<std::int32_t>(f), other->second);
  }
  std::vector<int> group(facets.size());
  for (std::size_t f = 0; f < facets.size(); ++f) group[f] = groups.find(static_cast<std::int32_t>(f));
  return group;
}

// The border of a group of facets, as a loop.
std::vector<int> borderOf(const std::vector<HullFacet>& facets, const std::vector<int>& group, int which,
                          const HalfEdges& edges) {
  std::map<int, int> next;
  for (std::size_t f = 0; f < facets.size(); ++f) {
    if (group[f] != which) continue;
    for (std::size_t k = 0; k < 3; ++k) {
      const int a = facets[f][k], b = facets[f][(k + 1) % 3];
      const auto other = edges.find({b, a});
      if (other == edges.end() || group[static_cast<std::size_t>(other->second)] != which) next[a] = b;
    }
  }
  std::vector<int> loop;
  if (next.empty()) return loop;
  int at = next.begin()->first;
  while (loop.size() < next.size()) {
    loop.push_back(at);
    const auto step = next.find(at);
    if (step == next.end()) return {};
    at = step->second;
    if (at == loop.front()) break;
  }
  return loop;
}

}  // namespace

std::shared_ptr<const Polytope> Polytope::hullOf(const std::vector<Vec3>& points, const std::string& source) {
  requirePoints(points, source);
  const std::shared_ptr<Polytope> hull(new Polytope(points, source));
  hull->setInset();
  return hull;
}

std::vector<Vec3> Polytope::cornersOfHull(const std::vector<Vec3>& points, const std::string& source) {
  requirePoints(points, source);
  return std::move(Polytope(points, source).vertices_);
}

Polytope::Polytope(const std::vector<Vec3>& points, const std::string& source) {
  const double flat = kFlat * sizeOf(points);
  const std::vector<HullFacet> facets = quickHull(points);
  // A finely rounded solid may have facets that lie in one plane pair by pair and not as a
  // whole: then less is taken for one plane.
  double one_plane = flat;
  for (int tries = 1;; ++tries, one_plane *= 0.1) {
    vertices_ = points;
    try {
      setFaces(facets, one_plane, source);
      break;
    } catch (const InputError&) {
      if (tries == kPlaneTries) throw;
    }
  }
  if (vertices_.size() > kMaxVertices)
    throw InputError(fmt::format("{}: the hull has {} corners, more than {}. Use fewer points, or a mesh.", source,
                                 vertices_.size(), kMaxVertices));
  setEdges(source);
  PINCER_ASSERT(vertices_.size() + faces_.size() == edges_.size() + 2);  // Euler
  setSurroundings();
  if (!(thickness() > flat)) rejectFlat(source);
}

// How far the middle of the corners is from the nearest face [m].
double Polytope::thickness() const {
  double thickness = kInfinity;
  Vec3 middle = Vec3::Zero();
  for (const Vec3& v : vertices_) middle += v / static_cast<double>(vertices_.size());
  for (const Face& face : faces_) thickness = std::min(thickness, face.d - face.n.dot(middle));
  return thickness;
}

void Polytope::setInset() {
  inset_vertices_ = insetCorners(vertices_, 0.05 * thickness());
  if (inset_vertices_.empty()) inset_vertices_ = vertices_;
  inset_ = leastDepth(inset_vertices_);  // measured: Bullet's grid makes it up to a tenth less than was asked for
}

// How deep inside of every face all of `points` lie [m], 0 if one doesn't.
double Polytope::leastDepth(const std::vector<Vec3>& points) const {
  const auto n = static_cast<Eigen::Index>(points.size());
  Eigen::ArrayX3d columns(n, 3);  // by coordinate: two points at a time, and the same bits as one by one
  for (Eigen::Index i = 0; i < n; ++i) columns.row(i) = points[static_cast<std::size_t>(i)].transpose();
  double least = kInfinity;
  for (const Face& face : faces_) {
    const double highest =
        (columns.col(0) * face.n.x() + columns.col(1) * face.n.y() + columns.col(2) * face.n.z()).maxCoeff();
    least = std::min(least, face.d - highest);
  }
  return std::max(least, 0.0);
}

// Faces with their loops; keeps the corners only, those where three faces meet.
void Polytope::setFaces(const std::vector<HullFacet>& facets, double flat, const std::string& source) {
  faces_.clear();
  corners_.clear();
  const HalfEdges edges = halfEdgesOf(facets);
  const std::vector<int> group = groupsOf(vertices_, facets, edges, flat);
  std::vector<std::vector<int>> loops;
  for (std::size_t f = 0; f < facets.size(); ++f) {
    if (group[f] == static_cast<int>(f)) loops.push_back(borderOf(facets, group, group[f], edges));
  }
  std::vector<int> faces_at(vertices_.size(), 0);
  for (const std::vector<int>& loop : loops) {
    for (const int v : loop) ++faces_at[static_cast<std::size_t>(v)];
  }
  std::vector<int> renamed(vertices_.size(), -1);
  std::vector<Vec3> kept;
  for (std::size_t v = 0; v < vertices_.size(); ++v) {
    if (faces_at[v] < 3) continue;
    renamed[v] = static_cast<int>(kept.size());
    kept.push_back(vertices_[v]);
  }
  vertices_ = std::move(kept);
  for (const std::vector<int>& loop : loops) {
    Face face{Vec3::Zero(), 0, static_cast<int>(corners_.size()), 0};
    for (const int v : loop) {
      if (renamed[static_cast<std::size_t>(v)] >= 0) corners_.push_back(renamed[static_cast<std::size_t>(v)]);
    }
    face.count = static_cast<int>(corners_.size()) - face.first;
    if (face.count < 3) rejectFlat(source);
    const std::span<const int> corners = cornersOf(face);
    const Vec3& p0 = vertices_[static_cast<std::size_t>(corners[0])];
    for (std::size_t k = 1; k + 1 < corners.size(); ++k) {
      face.n += (vertices_[static_cast<std::size_t>(corners[k])] - p0)
                    .cross(vertices_[static_cast<std::size_t>(corners[k + 1])] - p0);
    }
    if (!(face.n.norm() > 0)) rejectFlat(source);
    face.n.normalize();
    for (const int v : corners) face.d += face.n.dot(vertices_[static_cast<std::size_t>(v)]) / face.count;
    faces_.push_back(face);
  }
  if (faces_.size() < 4) rejectFlat(source);
}

void Polytope::setEdges(const std::string& source) {
  std::map<std::pair<int, int>, int> place;  // from, to -> place in corners_
  std::vector<int> face_at(corners_.size());
  for (std::size_t f = 0; f < faces_.size(); ++f) {
    const std::span<const int> loop = cornersOf(faces_[f]);
    for (std::size_t k = 0; k < loop.size(); ++k) {
      const int at = faces_[f].first + static_cast<int>(k);
      place[{loop[k], loop[(k + 1) % loop.size()]}] = at;
      face_at[static_cast<std::size_t>(at)] = static_cast<int>(f);
    }
  }
  loop_edges_.assign(corners_.size(), -1);
  for (const auto& [ends, at] : place) {
    const auto other = place.find({ends.second, ends.first});
    if (other == place.end()) rejectFlat(source);
    if (ends.first > ends.second) continue;
    loop_edges_[static_cast<std::size_t>(at)] = loop_edges_[static_cast<std::size_t>(other->second)] =
        static_cast<int>(edges_.size());
    edges_.push_back({ends.first, ends.second, face_at[static_cast<std::size_t>(at)],
                      face_at[static_cast<std::size_t>(other->second)]});
  }
}

void Polytope::setSurroundings() {
  first_at_vertex_.assign(vertices_.size() + 1, 0);
  for (const Edge& e : edges_)
    ++first_at_vertex_[static_cast<std::size_t>(e.from) + 1], ++first_at_vertex_[static_cast<std::size_t>(e.to) + 1];
  std::partial_sum(first_at_vertex_.begin(), first_at_vertex_.end(), first_at_vertex_.begin());
  vertex_edges_.resize(2 * edges_.size());
  vertex_neighbours_.resize(2 * edges_.size());
  std::vector<int> end(first_at_vertex_.begin(), first_at_vertex_.end() - 1);
  const auto add = [&](int vertex, int edge, int neighbour) {
    const auto at = static_cast<std::size_t>(end[static_cast<std::size_t>(vertex)]++);
    vertex_edges_[at] = edge;
    vertex_neighbours_[at] = neighbour;
  };
  for (std::size_t e = 0; e < edges_.size(); ++e) {
    add(edges_[e].from, static_cast<int>(e), edges_[e].to);
    add(edges_[e].to, static_cast<int>(e), edges_[e].from);
  }
  for (const Vec3& v : vertices_) bounding_radius_ = std::max(bounding_radius_, v.norm());
}

int Polytope::extremeVertex(const Vec3& d) const {
  constexpr std::size_t kScanned = 32;  // up to so many corners a scan is quicker than a climb
  int best = 0;
  double most = d.dot(vertices_[0]);
  if (vertices_.size() <= kScanned) {
    for (std::size_t i = 1; i < vertices_.size(); ++i) {
      const double x = d.dot(vertices_[i]);
      if (x > most) most = x, best = static_cast<int>(i);
    }
    return best;
  }
  for (bool climbs = true; climbs;) {
    climbs = false;
    for (const int i : neighboursAt(best)) {
      const double x = d.dot(vertices_[static_cast<std::size_t>(i)]);
      if (x > most) most = x, best = i, climbs = true;
    }
  }
  return best;
}

}  // namespace pincer::contact
