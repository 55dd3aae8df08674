#include "pincer/contact/shape/mesh_mesh.h"

#include "pincer/contact/shape/contact_candidates.h"
#include "pincer/contact/shape/mesh_rules.h"
#include "pincer/contact/shape/posed_solid.h"
#include "pincer/contact/shape/tolerances.h"
#include "pincer/contact/smooth_mesh.h"

namespace pincer::contact {
namespace {

// One mesh seen from the other: R, p take the other's frame into this one's.
struct SeenMesh {
  const MeshFeatures& features;
  Mat3 R;
  Vec3 p;

  Vec3 place(const Vec3& q) const { return R * q + p; }
};

// In the frame of a.
class MeshOnMesh {
 public:
  MeshOnMesh(const Mesh& a, const Mesh& b, const Pose& X_AB, const MeshScale& scale)
      : a_(a.surface->features()),
        b_(b.surface->features()),
        R_(X_AB.q.toRotationMatrix()),
        p_(X_AB.p),
        scale_(scale) {}

  void find() {
    const SeenMesh b_from_a{b_, R_.transpose(), -(R_.transpose() * p_)}, a_from_b{a_, R_, p_};
    visitNear(a_, b_from_a, [&](std::int32_t t, const FlatTriangle& triangle) {
      lookAtCorners(triangle, a_, b_from_a, kMeshCornerOfA);
      for (int i = 0; i < 3; ++i) {
        if (triangle.ownsEdge(i))
          lookAtEdge(triangle, i, 3 * static_cast<std::uint32_t>(t) + static_cast<std::uint32_t>(i), b_from_a);
      }
    });
    visitNear(b_, a_from_b, [&](std::int32_t, const FlatTriangle& triangle) {
      lookAtCorners(triangle, b_, a_from_b, kMeshCornerOfB);
    });
  }
  ContactCandidates& candidates() { return candidates_; }

 private:
  // Triangles of `mesh` whose box, as the other sees it, meets the other's surface.
  template <class Visit>
  void visitNear(const MeshFeatures& mesh, const SeenMesh& other, Visit visit) {
    const Vec3 low = other.features.tree().low(), high = other.features.tree().high();
    const Vec3 centre = other.R.transpose() * (0.5 * (low + high) - other.p);
    const Vec3 half = other.R.transpose().cwiseAbs() * (0.5 * (high - low)) + Vec3::Constant(scale_.margin);
    mesh.visitOwners(centre - half, centre + half, [&](std::int32_t t) {
      const FlatTriangle triangle = mesh.triangle(t);
      const Vec3 q0 = other.place(triangle.p[0]), q1 = other.place(triangle.p[1]), q2 = other.place(triangle.p[2]);
      const Vec3 reach = Vec3::Constant(scale_.margin);
      if (!other.features.tree().meetsBox(q0.cwiseMin(q1).cwiseMin(q2) - reach, q0.cwiseMax(q1).cwiseMax(q2) + reach))
        return;
      visit(t, triangle);
    });
  }

  // In the frame of a.
  void offer(const PairPoint& point, bool is_way_out) {
    if (!(point.phi < scale_.margin && point.phi > scale_.deepest())) return;
    is_way_out ? candidates_.add({point}) : candidates_.addRefused({point});
  }

  void lookAtCorners(const FlatTriangle& triangle, const MeshFeatures& own, const SeenMesh& other, std::uint32_t kind) {
    for (int i = 0; i < 3; ++i) {
      if (triangle.ownsCorner(i)) lookAtCorner(triangle.corner(i), triangle.vertex(i), own, other, kind);
    }
  }

  // In the other's frame n points from the other to the corner.
  void lookAtCorner(const Vec3& p, std::int32_t vertex, const MeshFeatures& own, const SeenMesh& other,
                    std::uint32_t kind) {
    const Vec3 q = other.place(p);
    const MeshFeatures::Nearest s = other.features.nearest(q, std::max(scale_.margin, -scale_.deepest()));
    if (!s.found || !(s.distance < scale_.margin)) return;
    const auto counts = [&](const Vec3& n) { return own.liesAbove(vertex, other.R.transpose() * n, kConeSlack); };
    Vec3 n = Vec3::Zero();
    double phi = -kInfinity;
    if (s.distance < scale_.slack()) {
      const Vec3 reach = Vec3::Constant(4 * std::max(-s.distance, 0.0) + MeshScale::kLonger * scale_.size);
      other.features.visitBox(q - reach, q + reach, [&](std::int32_t t) {
        const FlatTriangle face = other.features.triangle(t);
        const double height = face.n.dot(q - face.p[0]);
        if (!(std::abs(height) < std::abs(phi)) || height > scale_.slack()) return;
        if (face.isUnder(q, scale_.slack()) && counts(face.n)) phi = height, n = face.n;
      });
    }
    if (phi == -kInfinity) {
      if (s.distance < -scale_.slack() || !counts(s.n)) return;
      phi = s.distance;
      n = s.n;
    }
    const bool of_a = kind == kMeshCornerOfA;
    const Vec3 p_mid = of_a ? Vec3(p - 0.5 * phi * (other.R.transpose() * n)) : Vec3(q - 0.5 * phi * n);
    const PairPoint point{p_mid, of_a ? Vec3(other.R.transpose() * n) : Vec3(-n), phi,
                          meshFeatureOf(kind, static_cast<std::uint32_t>(vertex))};
    const bool is_way_out = scale_.isWayOut(phi, s.distance);
    if (is_way_out || s.distance < 0) offer(point, is_way_out);
  }

  // Directions, unit and across the edge, into the two triangles that an owned edge joins.
  struct EdgeSides {
    Vec3 own, other;

    Vec3 n_own, n_other;  // their normals

    EdgeSides(const FlatTriangle& t, int i, const Vec3& e) : own(t.n.cross(e)), n_own(t.n) {
      const Vec3 d = t.beyond[static_cast<std::size_t>(i)] - t.corner(i);
      other = (d - e.dot(d) * e).normalized();
      n_other = other.cross(e);
    }
    // How steep `n`, out of the solid, is on the flatter of the two (cosine): a point below the edge
    // along n lies so much of its way behind it.
    double leastSlope(const Vec3& n) const { return std::min(n.dot(n_own), n.dot(n_other)); }
    // True if both triangles lie on n's side of the edge.
    bool lieAbove(const Vec3& n) const { return n.dot(own) >= -kEdgeSlack && n.dot(other) >= -kEdgeSlack; }
  };

  void lookAtEdge(const FlatTriangle& ta, int i, std::uint32_t name, const SeenMesh& b) {
    const Vec3 &a0 = ta.corner(i), &a1 = ta.corner(i + 1);
    const Vec3 q0 = b.place(a0), q1 = b.place(a1), reach = Vec3::Constant(scale_.margin);
    if (!b_.nearest(0.5 * (q0 + q1), 0.5 * (q1 - q0).norm() + scale_.margin).found) return;
    const Vec3 low = q0.cwiseMin(q1) - reach, high = q0.cwiseMax(q1) + reach;
    const Vec3 e = (a1 - a0).normalized();
    const EdgeSides sides(ta, i, e);
    b_.visitOwners(low, high, [&](std::int32_t t) {
      if (!b_.meetsBox(t, low, high)) return;
      const FlatTriangle tb = b_.triangle(t);
      for (int j = 0; j < 3; ++j) {
        if (tb.ownsEdge(j))
          lookAtEdges(a0, a1, e, sides, tb, j, name, 3 * static_cast<std::uint32_t>(t) + static_cast<std::uint32_t>(j));
      }
    });
  }

  void lookAtEdges(const Vec3& a0, const Vec3& a1, const Vec3& e, const EdgeSides& sides, const FlatTriangle& tb, int j,
                   std::uint32_t name_a, std::uint32_t name_b) {
    const Vec3 b0 = R_ * tb.corner(j) + p_, f_long = R_ * (tb.corner(j + 1) - tb.corner(j));
    const double length_a = (a1 - a0).norm(), length_b = f_long.norm();
    const Vec3 f = f_long / length_b, across = e.cross(f), d = b0 - a0;
    const double sine2 = across.squaredNorm();
    if (!(sine2 > kNoAngle * kNoAngle)) return;
    const double s = d.cross(f).dot(across) / sine2, t = d.cross(e).dot(across) / sine2;
    const double slack = scale_.slack();
    if (s < -slack || s > length_a + slack || t < -slack || t > length_b + slack) return;
    Vec3 n = across / std::sqrt(sine2);
    const EdgeSides sides_b(tb, j, (tb.corner(j + 1) - tb.corner(j)) / length_b);
    const Vec3 n_B = R_.transpose() * n;
    const bool up = sides.lieAbove(n) && sides_b.lieAbove(-n_B);
    if (!up && !(sides.lieAbove(-n) && sides_b.lieAbove(n_B))) return;
    if (!up) n = -n;
    const Vec3 on_a = a0 + s * e, on_b = b0 + t * f;
    const double phi = n.dot(on_a - on_b);
    if (!(phi < scale_.margin && phi > scale_.deepest())) return;
    const PairPoint point{0.5 * (on_a + on_b), n, phi,
                          meshFeatureOf(kMeshEdges, name_a * 0x9e3779b1u ^ name_b * 0x85ebca6bu)};
    if (!(phi < -slack)) return offer(point, true);
    const MeshFeatures::Nearest in_b = b_.nearest(R_.transpose() * (on_a - p_), -1.1 * phi),
                                in_a = a_.nearest(on_b, -1.1 * phi);
    const bool is_way_out = in_a.found && in_b.found &&
                            scale_.isBehindFaces(in_a.distance, phi, sides.leastSlope(-n)) &&
                            scale_.isBehindFaces(in_b.distance, phi, sides_b.leastSlope(R_.transpose() * n));
    const bool is_inside = (in_a.found && in_a.distance < 0) || (in_b.found && in_b.distance < 0);
    if (is_way_out || is_inside) offer(point, is_way_out);
  }

  const MeshFeatures& a_;
  const MeshFeatures& b_;
  Mat3 R_;
  Vec3 p_;  // of b's origin in a
  MeshScale scale_;
  ContactCandidates candidates_;
};

}  // namespace

void collideMeshes(const Mesh& a, const Pose& X_WA, const Mesh& b, const Pose& X_WB, double margin,
                   const LastPoints& last, PairPoints& out) {
  out.count = 0;
  const double radius_a = a.surface->boundingRadius(), radius_b = b.surface->boundingRadius();
  const double furthest = radius_a + radius_b + margin;
  if (!((X_WA.p - X_WB.p).squaredNorm() < furthest * furthest)) return;
  const Pose X_AB{X_WA.q.conjugate() * X_WB.q, X_WA.q.conjugate() * (X_WB.p - X_WA.p)};
  MeshOnMesh search(a, b, X_AB, {std::min(radius_a, radius_b), margin});
  search.find();
  search.candidates().keepBest(last).place(X_WA, out);
}

}  // namespace pincer::contact
