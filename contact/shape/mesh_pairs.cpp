#include "contact/shape/mesh_pairs.h"

#include <algorithm>
#include <cmath>

#include "contact/shape/closed_forms.h"
#include "contact/shape/contact_candidates.h"
#include "contact/shape/direction.h"
#include "contact/shape/facet_overlap.h"
#include "contact/shape/separation.h"
#include "contact/surface/smooth_mesh.h"

namespace pincer::contact {
namespace {

constexpr double kDeepest = 0.25;  // of the smaller body's radius: deeper features belong to the far side
constexpr double kSameSide = 0.5;  // cosine: surfaces that face alike don't touch
constexpr double kSlack = 1e-6;    // of the size, or sine: on the border of a triangle, of a normal's range

using FlatTriangle = MeshFeatures::Triangle;

enum : std::uint32_t { kMeshCornerOfA = 0, kMeshCornerOfB = 1, kMeshEdges = 2 };
std::uint32_t featureOf(std::uint32_t kind, std::uint32_t name) { return kind << 30 | (name & 0x3fffffff); }

const Vec3& cornerOf(const FlatTriangle& t, int i) { return t.p[static_cast<std::size_t>(i % 3)]; }

bool isOver(const FlatTriangle& t, const Vec3& q, double slack) {
  for (int i = 0; i < 3; ++i) {
    const Vec3 edge = cornerOf(t, i + 1) - cornerOf(t, i);
    if (t.n.cross(edge).dot(q - cornerOf(t, i)) < -slack * edge.norm()) return false;
  }
  return true;
}

// Directions, unit and across the edge, into the two triangles that an owned edge joins.
struct EdgeSides {
  Vec3 own, other;

  EdgeSides(const FlatTriangle& t, int i) : own(t.n.cross(cornerOf(t, i + 1) - cornerOf(t, i)).normalized()) {
    const Vec3 e = (cornerOf(t, i + 1) - cornerOf(t, i)).normalized(), d = t.beyond[static_cast<std::size_t>(i)] - cornerOf(t, i);
    other = (d - e.dot(d) * e).normalized();
  }
  // Whether both triangles lie on n's side of the edge: nothing nearer is to be found on them.
  bool lieAbove(const Vec3& n) const { return n.dot(own) >= -kSlack && n.dot(other) >= -kSlack; }
};

// Finds the candidates of a mesh on a solid, in the mesh's frame A.
class MeshOnSolid {
 public:
  MeshOnSolid(const Mesh& mesh, const PosedSolid& solid, double margin)
      : mesh_(mesh.surface->triangles()),
        features_(mesh.surface->features()),
        solid_(solid),
        margin_(margin),
        rounding_(roundingOf(solid.shape)) {
    size_ = std::min(mesh.surface->boundingRadius(), boundingRadius(solid.shape));
    deepest_ = -kDeepest * size_;
  }

  void find() {
    Vec3 low, high;
    for (int k = 0; k < 3; ++k) {
      const double reach = rounding_ + margin_;
      low[k] = solid_.support(-Vec3::Unit(k))[k] - reach;
      high[k] = solid_.support(Vec3::Unit(k))[k] + reach;
    }
    features_.visitBox(low, high, kMostTriangles, [&](std::int32_t t) { look(t); });
  }
  const ContactCandidates& candidates() const { return candidates_; }

 private:
  void look(std::int32_t t) {
    const FlatTriangle triangle = features_.triangle(mesh_, t);
    const double height = triangle.n.dot(solid_.support(-triangle.n) - triangle.p[0]) - rounding_;
    if (height > margin_) return;
    if (height > deepest_) lookAtFace(triangle);
    for (int i = 0; i < 3; ++i) {
      if (triangle.ownsCorner(i)) lookAtCorner(triangle, i);
      if (triangle.ownsEdge(i)) lookAtEdge(triangle, i, 3 * static_cast<std::uint32_t>(t) + static_cast<std::uint32_t>(i));
    }
  }

  void add(const Vec3& p, const Vec3& n, double phi, std::uint32_t feature) {
    if (phi < margin_ && phi > deepest_) candidates_.add({p, n, phi, feature});
  }

  void lookAtFace(const FlatTriangle& triangle) {
    Facet facet;
    facetOf(solid_.shape, solid_.inwards(-triangle.n), facet);
    for (int k = 0; k < facet.count; ++k) {
      const FacetCorner& corner = facet.corners[static_cast<std::size_t>(k)];
      const Vec3 q = solid_.place(corner.p) - rounding_ * triangle.n;
      const double phi = triangle.n.dot(q - triangle.p[0]);
      if (phi < margin_ && isOver(triangle, q, kSlack * size_))
        add(q - 0.5 * phi * triangle.n, -triangle.n, phi, featureOf(kMeshCornerOfB, corner.vertex));
    }
  }

  // Normals point from the solid to the mesh.
  NearestPoint nearest(const Vec3& p) const {
    NearestPoint s = std::visit(
        [&](const auto& solid) -> NearestPoint {
          if constexpr (std::is_same_v<std::decay_t<decltype(solid)>, Mesh>)
            return {p, Vec3::UnitZ(), 0};
          else
            return nearestPoint(solid, solid_.inwards(p - solid_.p));
        },
        solid_.shape);
    s.n_B = solid_.outwards(s.n_B);
    return s;
  }

  void lookAtCorner(const FlatTriangle& triangle, int i) {
    const Vec3& p = cornerOf(triangle, i);
    const NearestPoint s = nearest(p);
    if (triangle.n.dot(s.n_B) > kSameSide) return;
    add(p - 0.5 * s.distance * s.n_B, s.n_B, s.distance,
        featureOf(kMeshCornerOfA, static_cast<std::uint32_t>(triangle.vertices[static_cast<std::size_t>(i)])));
  }

  // The distance from a convex solid is convex along the edge: its ends tell whether it is least between them.
  void lookAtEdge(const FlatTriangle& triangle, int i, std::uint32_t name) {
    const Vec3 &p0 = cornerOf(triangle, i), &p1 = cornerOf(triangle, i + 1);
    const Vec3 middle = 0.5 * (p0 + p1);
    const double length = (p1 - p0).norm();
    const Vec3 e = (p1 - p0) / length;
    if (nearest(middle).distance > margin_ + 0.5 * length) return;
    const double out0 = -nearest(p0).n_B.dot(e), out1 = nearest(p1).n_B.dot(e);
    if (out0 < -kSlack || out1 < -kSlack || (out0 < kSlack && out1 < kSlack)) return;

    const Shape segment = Capsule{0, 0.5 * length};
    const PosedSolid edge{segment, frameFromNormal(e), middle};
    const double size = std::min(size_, length);
    const Separation s = separate(edge, solid_, size, nullptr);
    const double phi = s.gap - rounding_;
    if (!(phi < margin_ && phi > deepest_) || !EdgeSides(triangle, i).lieAbove(s.n)) return;
    PairPoints found;
    overlapFacets(edge, solid_, s, size, margin_, found);
    std::uint32_t place = 0;
    for (int k = 0; k < found.count; ++k) {
      const PairPoint& point = found.points[static_cast<std::size_t>(k)];
      const bool is_end = point.feature >> 28 == 0;  // of the edge: a corner of the mesh
      if (!is_end) add(point.p_W, point.n_W, point.phi, featureOf(kMeshEdges, 4 * name + place++));
    }
  }

  const TriangleMesh& mesh_;
  const MeshFeatures& features_;
  const PosedSolid& solid_;
  double margin_, rounding_, size_, deepest_;
  ContactCandidates candidates_;
};

bool spheresTouch(const Shape& a, const Pose& X_WA, const Shape& b, const Pose& X_WB, double margin) {
  const double furthest = boundingRadius(a) + boundingRadius(b) + margin;
  return (X_WA.p - X_WB.p).squaredNorm() < furthest * furthest;
}

void keepInWorld(const ContactCandidates& candidates, const Pose& X_WF, PairPoints& out) {
  candidates.keepBest(out);
  for (int i = 0; i < out.count; ++i) {
    PairPoint& point = out.points[static_cast<std::size_t>(i)];
    point.p_W = X_WF * point.p_W;
    point.n_W = X_WF.q * point.n_W;
  }
}

}  // namespace

void collideMeshWithConvex(const Mesh& mesh, const Pose& X_WA, const Shape& solid, const Pose& X_WB, double margin, PairPoints& out) {
  out.count = 0;
  if (!spheresTouch(mesh, X_WA, solid, X_WB, margin)) return;
  const Quat q = X_WA.q.conjugate() * X_WB.q;
  const PosedSolid posed{solid, q.toRotationMatrix(), X_WA.q.conjugate() * (X_WB.p - X_WA.p)};
  MeshOnSolid search(mesh, posed, margin);
  search.find();
  keepInWorld(search.candidates(), X_WA, out);
}

}  // namespace pincer::contact
