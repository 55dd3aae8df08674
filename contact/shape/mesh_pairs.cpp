#include "contact/shape/mesh_pairs.h"

#include <type_traits>

#include "contact/shape/contact_candidates.h"
#include "contact/shape/edge_on_solid.h"
#include "contact/shape/mesh_rules.h"
#include "contact/shape/solid_walls.h"
#include "contact/surface/smooth_mesh.h"

namespace pincer::contact {
namespace {

// How far in front of one of the solid's faces, of its depth across an edge of the solid, the point of the mesh's edge may be: edges of 70 degrees.
constexpr double kBesideFace = 0.35;

// Finds the candidates of a mesh on a solid, in the mesh's frame A. Normals point from the solid to the mesh.
class MeshOnSolid {
 public:
  MeshOnSolid(const Mesh& mesh, const PosedSolid& solid, const MeshScale& scale)
      : features_(mesh.surface->features()), solid_(solid), scale_(scale), rounding_(roundingOf(solid.shape)) {}

  void find() {
    Vec3 low, high;
    const double reach = rounding_ + scale_.margin;
    for (int k = 0; k < 3; ++k) {
      low[k] = solid_.support(-Vec3::Unit(k))[k] - reach;
      high[k] = solid_.support(Vec3::Unit(k))[k] + reach;
    }
    features_.visitBox(low, high, kMostTriangles, [&](std::int32_t t) { look(t, low, high); });
  }
  ContactCandidates& candidates() { return candidates_; }

 private:
  void look(std::int32_t t, const Vec3& low, const Vec3& high) {
    if (!features_.meetsBox(t, low, high)) return;
    const FlatTriangle triangle = features_.triangle(t);
    const double height = triangle.n.dot(solid_.support(-triangle.n) - triangle.p[0]) - rounding_;
    if (height > scale_.margin) return;
    if (height > scale_.deepest()) lookAtFace(triangle);
    for (int i = 0; i < 3; ++i) {
      if (triangle.ownsCorner(i)) lookAtCorner(triangle.corner(i), triangle.vertices[static_cast<std::size_t>(i)]);
      if (triangle.ownsEdge(i)) lookAtEdge(triangle, i, 3 * static_cast<std::uint32_t>(t) + static_cast<std::uint32_t>(i));
    }
  }

  void offer(const PairPoint& point, bool is_way_out) {
    if (!(point.phi < scale_.margin && point.phi > scale_.deepest())) return;
    is_way_out ? candidates_.add(point) : candidates_.addRefused(point);
  }

  void lookAtFace(const FlatTriangle& triangle) {
    Facet facet;
    facetOf(solid_.shape, solid_.inwards(-triangle.n), facet);
    for (int k = 0; k < facet.count; ++k) {
      const FacetCorner& corner = facet.corners[static_cast<std::size_t>(k)];
      const Vec3 q = solid_.place(corner.p) - rounding_ * triangle.n;
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
        visitWalls(solid, p_B, [&](const Vec3& n_B, double height) {
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

  void lookAtEdge(const FlatTriangle& triangle, int i, std::uint32_t name) {
    const Vec3 &p0 = triangle.corner(i), &p1 = triangle.corner(i + 1);
    const double length = (p1 - p0).norm();
    const Vec3 e = (p1 - p0) / length, across = triangle.beyond[static_cast<std::size_t>(i)] - p1;
    const Vec3 n_other = (p0 - p1).cross(across).normalized();
    const auto gapAt = [&](const Vec3& n) { return n.dot(p0 - solid_.support(n)) - rounding_; };
    if (gapAt(-triangle.n) > scale_.margin || gapAt(-n_other) > scale_.margin) return;
    const Vec3 t = e.cross(triangle.n), t_other = n_other.cross(e);  // out of the two faces
    const EdgeContacts found = edgeOnSolid(p0, e, -(triangle.n - kEdgeSlack * t).normalized(),
                                           -(n_other - kEdgeSlack * t_other).normalized(), solid_, scale_.deepest());
    for (int k = 0; k < found.count; ++k) {
      const EdgeContact& s = found.all[static_cast<std::size_t>(k)];
      const double phi = s.gap - rounding_, along = e.dot(s.p - p0);
      if (!(phi < scale_.margin) || along < -scale_.slack() || along > length + scale_.slack()) continue;
      const Vec3 p = p0 + along * e;
      const PairPoint point{p - 0.5 * phi * s.n, s.n, phi, meshFeatureOf(kMeshEdges, name)};
      phi < -scale_.slack() ? offerOverlap(point, p, -std::max(s.n.dot(triangle.n), s.n.dot(n_other))) : offer(point, true);
    }
  }

  // Of an edge's point `p`, and of the solid's opposite to it: in the solid, and behind the two faces of the mesh's edge; `slope` as
  // MeshScale::isBehindFaces has it.
  void offerOverlap(const PairPoint& point, const Vec3& p, double slope) {
    const double phi = point.phi, in_solid = nearest(p).distance;
    const MeshFeatures::Nearest in_mesh = features_.nearest(p - phi * point.n_W, -1.1 * phi);
    const bool is_way_out = in_solid < scale_.slack() - kBesideFace * phi && scale_.isWayOut(phi, in_solid) && in_mesh.found &&
                            scale_.isBehindFaces(in_mesh.distance, phi, slope);
    if (is_way_out || in_solid < 0 || (in_mesh.found && in_mesh.distance < 0)) offer(point, is_way_out);
  }

  const MeshFeatures& features_;
  const PosedSolid& solid_;
  MeshScale scale_;
  double rounding_;
  ContactCandidates candidates_;
};

}  // namespace

void collideMeshWithConvex(const Mesh& mesh, const Pose& X_WA, const Shape& solid, const Pose& X_WB, double margin, PairPoints& out) {
  out.count = 0;
  const double radius_a = mesh.surface->boundingRadius(), radius_b = boundingRadius(solid);
  const double furthest = radius_a + radius_b + margin;
  if (!((X_WA.p - X_WB.p).squaredNorm() < furthest * furthest)) return;
  const Quat q = X_WA.q.conjugate() * X_WB.q;
  const PosedSolid posed{solid, q.toRotationMatrix(), X_WA.q.conjugate() * (X_WB.p - X_WA.p)};
  MeshOnSolid search(mesh, posed, {std::min(radius_a, radius_b), margin});
  search.find();
  search.candidates().keepBest(X_WA, out);
}

}  // namespace pincer::contact
