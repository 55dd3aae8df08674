#include "pincer/contact/surface/surface_search.h"

#include <algorithm>
#include <initializer_list>
#include <limits>
#include <span>

#include "pincer/contact/functions/invariants.h"
#include "pincer/contact/surface/edge_cubic.h"
#include "pincer/contact/surface/lone_contact.h"
#include "pincer/contact/surface/outward_float.h"

namespace pincer::contact {

namespace {

constexpr int kMaxVisits = 2000;  // leaves of the tree in one search

// Where the segment from `a` to `b` meets the triangle, if it does. Source: T. Moeller,
// B. Trumbore, J. Graphics Tools 2(1), 1997.
bool meets(const Vec3& a, const Vec3& b, const Vec3& p0, const Vec3& p1, const Vec3& p2) {
  const Vec3 e1 = p1 - p0, e2 = p2 - p0, d = b - a, x = d.cross(e2), from = a - p0;
  const double det = e1.dot(x);
  if (det == 0) return false;
  const double u = from.dot(x) / det, v = d.dot(from.cross(e1)) / det, s = e2.dot(from.cross(e1)) / det;
  return u >= 0 && v >= 0 && u + v <= 1 && s >= 0 && s <= 1;
}

// The normals that contact on a triangle, and on its sharp edges, may have.
class ConeFinder {
 public:
  explicit ConeFinder(const SurfaceNet& net) : net_(net), kind_(net.mesh().vertices.size(), kSmooth) {
    for (std::int32_t t = 0; t < net.size(); ++t) {
      for (int i = 0; i < 3; ++i) {
        if (!net.isSharp(t, i)) continue;
        const char kind = net.neighbour(t, i).triangle < 0 ? kBorder : kSharp;
        for (const int corner : {i, (i + 1) % 3}) kindAt(t, corner) = std::max(kindAt(t, corner), kind);
      }
    }
    has_few_wide_ = hasFewWide();
  }

  // The patch's own normals, and those of its sharp edges and corners but where these are apart.
  NormalCone onFace(std::int32_t t, const Patch& p) {
    normals_ = {p.n200, p.n020, p.n002, p.n110, p.n011, p.n101, facetOf(t)};
    for (int i = 0; i < 3; ++i) {
      if (kindAt(t, i) == kSharp && !(has_few_wide_ && isWideAt(t, i))) addNormalsAt(t, i);
      const Neighbour other = net_.neighbour(t, i);
      if (net_.isSharp(t, i) && other.triangle >= 0 && !isApart(t, i, other)) addSide(other.triangle, other.edge);
    }
    return coneBeside(t, {0, 1, 2});
  }
  // The normals of both sides of a sharp edge, and all at its ends.
  NormalCone onEdge(std::int32_t t, int i, Neighbour other) {
    normals_ = {facetOf(t), facetOf(other.triangle)};
    addSide(t, i);
    addSide(other.triangle, other.edge);
    for (const int corner : {i, (i + 1) % 3}) addNormalsAt(t, corner);
    return coneBeside(t, {i, (i + 1) % 3});
  }
  // True if the normals there are too many directions for the patches beside to be gentle (lone_contact.h) with them,
  // and such edges are so few that each may be a part of its own.
  bool isApart(std::int32_t t, int i, Neighbour other) const { return has_few_wide_ && isWideOn(t, i, other); }
  bool hasBorder() const { return has_border_; }  // among what was looked at

 private:
  static constexpr char kSmooth = 0, kSharp = 1, kBorder = 2;  // kinds of vertices; a border counts first

  char& kindAt(std::int32_t t, int corner) {
    return kind_[static_cast<std::size_t>(
        net_.mesh().triangles[static_cast<std::size_t>(t)][static_cast<std::size_t>(corner)])];
  }
  Vec3 facetOf(std::int32_t t) const {
    return (net_.vertex(t, 1) - net_.vertex(t, 0)).cross(net_.vertex(t, 2) - net_.vertex(t, 0)).normalized();
  }
  // At a border it may be any normal.
  NormalCone coneBeside(std::int32_t t, std::initializer_list<int> corners) {
    const bool is_at_border =
        std::any_of(corners.begin(), corners.end(), [&](int corner) { return kindAt(t, corner) == kBorder; });
    has_border_ = has_border_ || is_at_border;
    return is_at_border ? NormalCone{} : coneOf(normals_);
  }
  void addNormal(const Vec3& n) { normals_.push_back(n); }
  void addNormalsAt(std::int32_t t, int corner) {
    net_.visitCorners({t, corner}, [&](const CellCorner& c) { addNormal(net_.normal(c.triangle, c.corner)); });
  }
  bool isWideOn(std::int32_t t, int i, Neighbour other) const {
    std::array<Vec3, 4> sides = {net_.normal(t, i), net_.normal(t, (i + 1) % 3),
                                 net_.normal(other.triangle, other.edge),
                                 net_.normal(other.triangle, (other.edge + 1) % 3)};
    return isWide(sides) || isWideAt(t, i) || isWideAt(t, (i + 1) % 3);
  }
  // Memory is promised per triangle: of a rough mesh, where nearly all edges are sharp, none is a part of its own.
  bool hasFewWide() const {
    constexpr std::int32_t kAlwaysFew = 4096;  // edges: 0.3 MB at most
    const std::int32_t most = std::max(kAlwaysFew, net_.size() / 10);
    std::int32_t wide = 0;
    for (std::int32_t t = 0; t < net_.size() && wide <= most; ++t) {
      for (int i = 0; i < 3; ++i) {
        const Neighbour other = net_.neighbour(t, i);
        wide += other.triangle > t && net_.isSharp(t, i) && isWideOn(t, i, other);
      }
    }
    return wide <= most;
  }
  static bool isWide(std::span<const Vec3> normals) { return !(coneOf(normals).cosine >= LoneContact::kCosBeta); }
  bool isWideAt(std::int32_t t, int corner) const {
    std::vector<Vec3> normals;
    net_.visitCorners({t, corner}, [&](const CellCorner& c) { normals.push_back(net_.normal(c.triangle, c.corner)); });
    return isWide(normals);
  }
  void addSide(std::int32_t t, int i) {
    const int k = (i + 1) % 3;
    addNormal(middleNormal(net_.vertex(t, i), net_.vertex(t, k), net_.normal(t, i), net_.normal(t, k)));
  }

  const SurfaceNet& net_;
  std::vector<char> kind_;  // per vertex
  std::vector<Vec3> normals_;
  bool has_border_ = false;
  bool has_few_wide_ = false;
};

bool isConcave(const SurfaceNet& net, std::int32_t t, int i, Neighbour other) {
  const Vec3 facet = (net.vertex(t, 1) - net.vertex(t, 0)).cross(net.vertex(t, 2) - net.vertex(t, 0));
  return facet.dot(net.vertex(other.triangle, (other.edge + 2) % 3) - net.vertex(t, i)) > 0;
}

// Infinity at a concave crease that isn't apart.
double hollowOf(const SurfaceNet& net, std::int32_t t, const SurfaceCell& cell, const ConeFinder& cones) {
  double hollow = 0;
  for (int i = 0; i < 3; ++i) {
    const Neighbour other = cell.neighbours[static_cast<std::size_t>(i)];
    const bool is_crease = cell.sharp[static_cast<std::size_t>(i)] && other.triangle >= 0;
    if (is_crease && isConcave(net, t, i, other) && !cones.isApart(t, i, other)) return kInfinity;
    hollow = std::max(hollow, concaveCurvature(cell.patch, i));
  }
  return hollow;
}

// The patch lies in the hull of its control points, and distance from a convex set is a convex function.
double bulgeOf(const Patch& patch) {
  double bulge2 = 0;
  for (const Vec3& p : controlPoints(patch)) {
    bulge2 = std::max(bulge2, closestOnTriangle(patch.b300, patch.b030, patch.b003, p).distance2);
  }
  return std::sqrt(bulge2);
}

// The tree's items: bounds of patches or of sharp edges.
struct SearchItems {
  std::vector<FacingBox> boxes;
  std::vector<PatchBounds> parts;

  // One that is in the hull of its control points.
  template <class Points>
  void add(const Vec3& centre, const Points& points, const NormalCone& cone, float hollow, float bulge) {
    PatchBounds part{{static_cast<float>(centre[0]), static_cast<float>(centre[1]), static_cast<float>(centre[2])},
                     0,
                     bulge,
                     hollow,
                     FacingTest(cone)};
    double radius2 = 0;
    Vec3 low = points[0], high = low;
    for (const Vec3& p : points) {
      radius2 = std::max(radius2, (p - part.middle()).squaredNorm());
      low = low.cwiseMin(p);
      high = high.cwiseMax(p);
    }
    part.radius = above(std::sqrt(radius2));
    parts.push_back(part);
    boxes.push_back({{below(low[0]), below(low[1]), below(low[2])},
                     {above(high[0]), above(high[1]), above(high[2])},
                     cone,
                     hollow});
  }
  void append(const SearchItems& others) {
    boxes.insert(boxes.end(), others.boxes.begin(), others.boxes.end());
    parts.insert(parts.end(), others.parts.begin(), others.parts.end());
  }
  void reserve(std::int32_t count) {
    boxes.reserve(static_cast<std::size_t>(count));
    parts.reserve(static_cast<std::size_t>(count));
  }
};

}  // namespace

SurfaceSearch::SurfaceSearch(const SurfaceNet& net, NetInspector& inspector,
                             const std::function<void(double)>& progress)
    : triangles_(net.size()) {
  constexpr double kPatches = 0.6;             // of the time
  constexpr std::int32_t kReported = 1 << 14;  // patches between two reports of progress
  ConeFinder cones(net);
  SearchItems items, edges;
  items.reserve(net.size());
  for (std::int32_t t = 0; t < net.size(); ++t) {
    const SurfaceCell cell = net.build(t);
    const Patch& patch = cell.patch;
    inspector.see(t, patch);
    const float bulge = above(bulgeOf(patch)), hollow = above(hollowOf(net, t, cell, cones));
    const Vec3 centre = (patch.b300 + patch.b030 + patch.b003) / 3;
    items.add(centre, controlPoints(patch), cones.onFace(t, patch), hollow, bulge);
    bulge_ = std::max<double>(bulge_, bulge);
    for (int i = 0; i < 3; ++i) {
      const Neighbour other = cell.neighbours[static_cast<std::size_t>(i)];
      if (!cell.sharp[static_cast<std::size_t>(i)] || other.triangle < t) continue;  // once each; no border
      if (!cones.isApart(t, i, other)) continue;
      const auto curve = edgeCurve(patch, i);
      const float hollow_there = isConcave(net, t, i, other) ? static_cast<float>(kInfinity) : hollow;
      edges.add(0.5 * (curve.front() + curve.back()), curve, cones.onEdge(t, i, other), hollow_there, bulge);
      edge_triangles_.push_back({t, other.triangle});
    }
    if (progress && t % kReported == 0) progress(kPatches * t / net.size());
  }
  items.append(edges);
  edge_triangles_.shrink_to_fit();
  const auto tree_progress = [&](double share) { progress(kPatches + (1 - kPatches) * share); };
  tree_ = FacingTree(items.boxes, progress ? std::function<void(double)>(tree_progress) : nullptr);
  is_closed_ = !cones.hasBorder();
  constexpr double kFlat = 1e-9;  // of the mesh's size
  if (bulge_ < kFlat * net.length()) bulge_ = 0;
  fillGroups(items.parts);
}

void SurfaceSearch::fillGroups(const std::vector<PatchBounds>& parts) {
  constexpr float kNowhere = std::numeric_limits<float>::infinity();  // [m]: no bound reaches it
  const PatchBounds none{{kNowhere, kNowhere, kNowhere}, 0, 0, 0, FacingTest(NormalCone{})};
  const auto& order = tree_.order();
  groups_.resize((order.size() + kLanes - 1) / kLanes);
  for (std::size_t i = 0; i < kLanes * groups_.size(); ++i) {
    groups_[i / kLanes].set(static_cast<int>(i % kLanes),
                            i < order.size() ? parts[static_cast<std::size_t>(order[i])] : none);
  }
}

void SurfaceSearch::PatchGroup::set(int lane, const PatchBounds& part) {
  for (std::size_t k = 0; k < 3; ++k) centre[k][lane] = part.centre[k];
  radius[lane] = part.radius;
  bulge[lane] = part.bulge;
  hollow[lane] = part.hollow;
  cones.set(lane, part.cone);
}

SurfaceSeed SurfaceSearch::nearest(const SurfaceNet& net, PatchCache& cache, const Vec3& p, double bound,
                                   Facing facing) const {
  SurfaceSeed seed{{}, bound, false};
  double bound2 = bound * bound;
  int visits = 0;
  const LanesPoint x(p);
  const Lanes rounded = LanesPoint::toLanes(tree_.rounding(p));
  const auto look = [&](std::int32_t triangle, double bulge) {
    ++visits;
    const FlatPoint flat = closestOnFacet(net, triangle, p);
    const double reach = seed.distance + bulge;
    if (flat.distance2 >= reach * reach) return;
    const double distance2 = (p - place(net.cell(triangle, cache).patch, flat.b[1], flat.b[2])).squaredNorm();
    if (distance2 >= bound2) return;
    bound2 = distance2;
    seed = {{triangle, flat.b}, std::sqrt(distance2), true};
  };
  tree_.visitFacing(p, bound2, facing, [&](std::int32_t leaf) {
    const PatchGroup& patches = group(leaf);
    const LaneMask may_hold = patches.mayHold(x, LanesPoint::toLanes(seed.distance), rounded, facing);
    for (int lane = 0; lane < kLanes; ++lane) {
      if (may_hold[lane]) look(triangleAt(kLanes * leaf + lane), patches.bulge[lane]);
    }
    return visits < kMaxVisits;
  });
  return seed;
}

double SurfaceSearch::wayAlone(const Vec3& p, const Vec3& n, double h, double reach, double least, double most) const {
  if (!is_closed_ || !(h > most)) return 0;
  LoneContact lone(p, n, h, reach, most, tree_.rounding(p));
  tree_.visitWhere(
      [&](const FacingTree::Children& c) { return lone.mayMatter(c.centre(), c.radius, c.hollow, c.cones); },
      [&](std::int32_t leaf) {
        const PatchGroup& patches = group(leaf);
        const LaneMask may_matter = lone.mayMatter(patches.centre, patches.radius, patches.hollow, patches.cones);
        for (int lane = 0; lane < kLanes; ++lane) {
          if (may_matter[lane]) lone.show(patches.at(lane));
        }
        return lone.way() >= least;
      });
  return lone.way() >= least ? lone.way() : 0;
}

std::optional<Foot> SurfaceSearch::minimumOn(const SurfaceNet& net, std::int32_t place, const Vec3& p,
                                             double reach) const {
  PINCER_ASSERT(isIndex(place, tree_.order().size()));
  const std::int32_t triangle = triangleAt(place);
  const FlatPoint flat = closestOnFacet(net, triangle, p);
  const double outer = reach + bulge(place);
  if (flat.distance2 >= outer * outer || !isFlatMinimum(net, triangle, flat, p)) return std::nullopt;
  return Foot{triangle, flat.b};
}

bool SurfaceSearch::isHidden(const SurfaceNet& net, const Vec3& a, const Vec3& b) const {
  bool is_hidden = false;
  tree_.visitInBox(a.cwiseMin(b), a.cwiseMax(b), [&](std::int32_t leaf) {
    const std::int32_t end = std::min(kLanes * (leaf + 1), static_cast<std::int32_t>(tree_.order().size()));
    for (std::int32_t place = kLanes * leaf; place < end && !is_hidden; ++place) {
      const std::int32_t t = tree_.order()[static_cast<std::size_t>(place)];
      is_hidden = t < triangles_ && meets(a, b, net.vertex(t, 0), net.vertex(t, 1), net.vertex(t, 2));
    }
    return !is_hidden;
  });
  return is_hidden;
}

}  // namespace pincer::contact
