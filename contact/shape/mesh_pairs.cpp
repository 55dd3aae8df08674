#include "pincer/contact/shape/mesh_pairs.h"

#include <type_traits>

#include "pincer/contact/shape/contact_candidates.h"
#include "pincer/contact/shape/edge_on_facet.h"
#include "pincer/contact/shape/edge_on_solid.h"
#include "pincer/contact/shape/mesh_rules.h"
#include "pincer/contact/shape/smooth_lead.h"
#include "pincer/contact/shape/solid_walls.h"
#include "pincer/contact/shape/tolerances.h"
#include "pincer/contact/smooth_mesh.h"

namespace pincer::contact {
namespace {

// How far in front of one of the solid's faces, of its depth across an edge of the solid, the point of the
// mesh's edge may be: edges of 70 degrees.
constexpr double kBesideFace = 0.35;

// Finds the candidates of a mesh on a solid, in the mesh's frame A. Normals point from the solid to the mesh.
class MeshOnSolid {
 public:
  MeshOnSolid(const Mesh& mesh, const PosedSolid& solid, const MeshScale& scale)
      : features_(mesh.surface->features()), solid_(solid), scale_(scale), rounding_(roundingOf(solid)) {}

  void find() {
    Vec3 low, high;
    const double reach = rounding_ + scale_.margin;
    for (int k = 0; k < 3; ++k) {
      low[k] = solid_.support(-Vec3::Unit(k))[k] - reach;
      high[k] = solid_.support(Vec3::Unit(k))[k] + reach;
    }
    features_.visitBox(low, high, [&](std::int32_t t) { look(t, low, high); });
  }
  ContactCandidates& candidates() { return candidates_; }

 private:
  void look(std::int32_t t, const Vec3& low, const Vec3& high) {
    if (!features_.meetsBox(t, low, high)) return;
    const FlatTriangle triangle = features_.triangle(t);
    at_ = t;
    faceAlong(triangle.n);
    const double height = triangle.n.dot(lowest_ - triangle.p[0]);
    if (height > scale_.margin) return;
    if (height > scale_.deepest()) lookAtFace(triangle);
    for (int i = 0; i < 3; ++i) {
      if (triangle.ownsCorner(i)) lookAtCorner(triangle.corner(i), triangle.vertex(i));
      if (triangle.ownsEdge(i))
        lookAtEdge({triangle, i, 3 * static_cast<std::uint32_t>(t) + static_cast<std::uint32_t>(i)});
    }
  }

  void offer(const PairPoint& point, bool is_way_out) {
    if (!(point.phi < scale_.margin && point.phi > scale_.deepest())) return;
    is_way_out ? candidates_.add({point, at_}) : candidates_.addRefused({point, at_});
  }

  // The solid's facet that faces against `n`, and its point on that side: the same for all triangles of a flat face.
  void faceAlong(const Vec3& n) {
    if ((n - faced_).squaredNorm() < kOneNormal * kOneNormal) return;
    faced_ = n;
    lowest_ = solid_.support(-n) - rounding_ * n;
    facet_.count = 0;
  }
  void placeFacet() {
    if (facet_.count > 0) return;
    facetOf(solid_.shape, solid_.inwards(-faced_), facet_);
    for (int k = 0; k < facet_.count; ++k) {
      Vec3& p = facet_.corners[static_cast<std::size_t>(k)].p;
      p = solid_.place(p) - rounding_ * faced_;
    }
  }

  void lookAtFace(const FlatTriangle& triangle) {
    placeFacet();
    for (int k = 0; k < facet_.count; ++k) {
      const FacetCorner& corner = facet_.corners[static_cast<std::size_t>(k)];
      const Vec3& q = corner.p;
      const double phi = triangle.n.dot(q - triangle.p[0]);
      if (!(phi < scale_.margin) || !triangle.isUnder(q, scale_.slack())) continue;
      const PairPoint point{q - 0.5 * phi * triangle.n, -triangle.n, phi, meshFeatureOf(kMeshCornerOfB, corner.vertex)};
      if (!(phi < -scale_.slack())) {
        offer(point, true);
        continue;
      }
      const MeshFeatures::Nearest s = features_.nearest(q, -1.1 * phi);
      if (s.found && s.distance < 0) offer(point, scale_.isWayOut(phi, s.distance));
    }
  }

  NearestPoint nearest(const Vec3& p) const {
    NearestPoint s{};
    onSolid(p, [&](const auto& solid, const Vec3& p_B) { s = nearestPoint(solid, p_B); });
    s.n_B = solid_.outwards(s.n_B);
    s.distance -= solid_.skin;
    return s;
  }

  template <class F>
  void onSolid(const Vec3& p, F f) const {
    std::visit(
        [&](const auto& solid) {
          if constexpr (!std::is_same_v<std::decay_t<decltype(solid)>, Mesh>) f(solid, solid_.inwards(p - solid_.p));
        },
        solid_.shape);
  }

  void lookAtCorner(const Vec3& p, std::int32_t vertex) {
    const NearestPoint s = nearest(p);
    if (!(s.distance < scale_.margin && s.distance > scale_.deepest())) return;
    Vec3 n = s.n_B;
    double phi = s.distance;
    if (s.distance < scale_.slack()) {
      phi = -kInfinity;
      onSolid(p, [&](const auto& solid, const Vec3& p_B) {
        visitWalls(solid, p_B, [&](const Vec3& n_B, double core_height) {
          const double height = core_height - solid_.skin;
          if (!(height > phi)) return;
          const Vec3 out = solid_.outwards(n_B);
          if (features_.liesAbove(vertex, out, kConeSlack)) phi = height, n = out;
        });
      });
    } else if (!features_.liesAbove(vertex, n, kConeSlack)) {
      return;
    }
    const bool is_way_out = scale_.isWayOut(phi, s.distance);
    if (is_way_out || s.distance < 0)
      offer({p - 0.5 * phi * n, n, phi, meshFeatureOf(kMeshCornerOfA, static_cast<std::uint32_t>(vertex))}, is_way_out);
  }

  // A convex edge of the mesh.
  struct Edge {
    Vec3 p, e;  // its begin [m] and direction
    double length;
    Vec3 n, n_other;                   // of the faces that it joins
    std::array<std::int32_t, 2> ends;  // vertices
    std::uint32_t name;

    Edge(const FlatTriangle& t, int i, std::uint32_t edge_name)
        : p(t.corner(i)),
          e(t.corner(i + 1) - p),
          length(e.norm()),
          n(t.n),
          ends{t.vertex(i), t.vertex(i + 1)},
          name(edge_name) {
      n_other = (-e).cross(t.beyond[static_cast<std::size_t>(i)] - t.corner(i + 1)).normalized();
      e /= length;
    }
    // How steep `m` is on the flatter of the two faces, as MeshScale::isBehindFaces has it.
    double slope(const Vec3& m) const { return -std::max(m.dot(n), m.dot(n_other)); }
  };

  void lookAtEdge(const Edge& edge) {
    const auto gapAt = [&](const Vec3& n) { return n.dot(edge.p - solid_.support(n)) - rounding_; };
    if (gapAt(-edge.n) > scale_.margin || gapAt(-edge.n_other) > scale_.margin) return;
    const Vec3 out = edge.e.cross(edge.n), out_other = edge.n_other.cross(edge.e);  // of the two faces
    const EdgeContacts found =
        edgeOnSolid(edge.p, edge.e, -(edge.n - kEdgeSlack * out).normalized(),
                    -(edge.n_other - kEdgeSlack * out_other).normalized(), solid_, scale_.deepest());
    for (int k = 0; k < found.count; ++k) {
      const EdgeContact& s = found.all[static_cast<std::size_t>(k)];
      if (s.gap - rounding_ < scale_.margin) lookAlongEdge(edge, s);
    }
  }

  // Where the edge and the solid's facet that faces it there part; where they cross, also where the two are nearest.
  void lookAlongEdge(const Edge& edge, const EdgeContact& s) {
    const EdgePart part = partOverFacet(edge.p, edge.e, edge.length, s.n, solid_, scale_.slack());
    for (std::uint32_t end = 0; part.found && end < 2; ++end) {
      const double t = part.ends[end].t, phi = part.ends[end].phi - solid_.skin;
      const bool is_corner = t <= 0 || t >= edge.length;
      if (is_corner && features_.liesAbove(edge.ends[t > 0], s.n, kConeSlack)) continue;  // lookAtCorner's
      offerOnEdge(edge, t, s.n, phi, meshFeatureOf(kMeshEdgeEnds, 2 * edge.name + end));
    }
    const double phi_s = s.gap - rounding_, along = edge.e.dot(s.p - edge.p);
    if (part.found &&
        (part.is_over_face || phi_s > std::min(part.ends[0].phi, part.ends[1].phi) - solid_.skin - kSameGap))
      return;
    if (along >= -scale_.slack() && along <= edge.length + scale_.slack())
      offerOnEdge(edge, along, s.n, phi_s, meshFeatureOf(kMeshEdges, edge.name));
  }

  // Overlap counts where the edge's point is in the solid, and the solid's opposite to it
  // behind the two faces of the mesh's edge.
  void offerOnEdge(const Edge& edge, double t, const Vec3& n, double phi, std::uint32_t feature) {
    const Vec3 p = edge.p + t * edge.e;
    const PairPoint point{p - 0.5 * phi * n, n, phi, feature};
    if (!(phi < -scale_.slack())) return offer(point, true);
    const double in_solid = nearest(p).distance;
    const MeshFeatures::Nearest in_mesh = features_.nearest(p - phi * n, -1.1 * phi);
    const bool is_way_out = in_solid < scale_.slack() - kBesideFace * phi && scale_.isWayOut(phi, in_solid) &&
                            in_mesh.found && scale_.isBehindFaces(in_mesh.distance, phi, edge.slope(n));
    if (is_way_out || in_solid < 0 || (in_mesh.found && in_mesh.distance < 0)) offer(point, is_way_out);
  }

  const MeshFeatures& features_;
  const PosedSolid& solid_;
  MeshScale scale_;
  double rounding_;
  Vec3 faced_ = Vec3::Zero(), lowest_;  // see faceAlong
  Facet facet_;           // its corners where they are, on the solid's surface; none until they are asked for
  std::int32_t at_ = -1;  // the triangle that is looked at
  ContactCandidates candidates_;
};

}  // namespace

void collideMeshWithConvex(const Mesh& mesh, const Pose& X_WA, const Shape& solid, const Pose& X_WB, double margin,
                           const LastPoints& last, PatchCache& cache, PairPoints& out) {
  out.count = 0;
  const double radius_a = mesh.surface->boundingRadius(), radius_b = boundingRadius(solid);
  const double furthest = radius_a + radius_b + margin;
  if (!((X_WA.p - X_WB.p).squaredNorm() < furthest * furthest)) return;
  const Quat q = X_WA.q.conjugate() * X_WB.q;
  const PosedSolid posed{solid, q.toRotationMatrix(), X_WA.q.conjugate() * (X_WB.p - X_WA.p)};
  const double size = std::min(radius_a, radius_b), bulge = mesh.surface->bulge();
  MeshOnSolid search(mesh, posed, {size, margin + bulge});
  search.find();
  FoundPoints points = search.candidates().keepBest(last);
  if (bulge > 0) leadToSurface(mesh.surface->net(), cache, posed, size, margin, points);
  points.place(X_WA, out);
}

void collidePadWithMesh(const Shape& core, double rounding, const Pose& X_BF, const Mesh& mesh, double margin,
                        PairPoints& out) {
  out.count = 0;
  const PosedSolid pad{core, X_BF.q.toRotationMatrix(), X_BF.p, rounding};
  MeshOnSolid search(mesh, pad, {std::min(mesh.surface->boundingRadius(), boundingRadius(core) + rounding), margin});
  search.find();
  search.candidates().keepBest().place(Pose{}, out);
  for (int i = 0; i < out.count; ++i) out.points[static_cast<std::size_t>(i)].n_W *= -1;
}

}  // namespace pincer::contact
