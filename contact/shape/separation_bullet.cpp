// Bullet's GJK and EPA, double precision, in units of the solids' size: its tolerances are absolute.
#include <BulletCollision/CollisionShapes/btConvexInternalShape.h>
#include <BulletCollision/NarrowPhaseCollision/btGjkEpa2.h>

#include "contact/shape/separation.h"

namespace pincer::contact {
namespace {

static_assert(sizeof(btScalar) == sizeof(double));

class CoreShape final : public btConvexInternalShape {
 public:
  CoreShape(const Shape& shape, double size, bool inset) : shape_(shape), per_size_(1 / size), inset_(inset) {
    m_shapeType = CUSTOM_CONVEX_SHAPE_TYPE;
    m_collisionMargin = 0;
  }
  btVector3 localGetSupportingVertexWithoutMargin(const btVector3& d) const override {
    const Vec3 direction(d.x(), d.y(), d.z());
    const Vec3 p = per_size_ * (inset_ ? insetOf(shape_, direction) : supportOf(shape_, direction));
    return {p.x(), p.y(), p.z()};
  }
  btVector3 localGetSupportingVertex(const btVector3& d) const override { return localGetSupportingVertexWithoutMargin(d); }
  void batchedUnitVectorGetSupportingVertexWithoutMargin(const btVector3* d, btVector3* out, int count) const override {
    for (int i = 0; i < count; ++i) out[i] = localGetSupportingVertexWithoutMargin(d[i]);
  }
  void calculateLocalInertia(btScalar, btVector3& inertia) const override { inertia.setZero(); }  // never asked
  const char* getName() const override { return "core"; }

 private:
  const Shape& shape_;
  double per_size_;
  bool inset_;
};

btTransform transformOf(const PosedSolid& s, double size) {
  const Mat3& R = s.R;
  const Vec3 p = s.p / size;
  return btTransform(btMatrix3x3(R(0, 0), R(0, 1), R(0, 2), R(1, 0), R(1, 1), R(1, 2), R(2, 0), R(2, 1), R(2, 2)),
                     btVector3(p.x(), p.y(), p.z()));
}

Vec3 vectorOf(const btVector3& v) { return {v.x(), v.y(), v.z()}; }

}  // namespace

DirectionGuess guessDirection(const PosedSolid& a, const PosedSolid& b, double size, Guess kind) {
  constexpr double kApart = 1e-9;  // of the size: nearer than that a direction is noise
  const btTransform X_a = transformOf(a, size), X_b = transformOf(b, size);
  const Vec3 between = a.inwards(a.p - b.p) / size;
  const btVector3 start(between.x(), between.y(), between.z());  // start and answer are in the frame of a
  const CoreShape core_a(a.shape, size, kind == Guess::kInset), core_b(b.shape, size, kind == Guess::kInset);
  btGjkEpaSolver2::sResults results;
  const bool found = kind == Guess::kOverlap
                         ? btGjkEpaSolver2::Penetration(&core_a, X_a, &core_b, X_b, start, results, false)
                         : btGjkEpaSolver2::Distance(&core_a, X_a, &core_b, X_b, start, results) && results.distance > kApart;
  const Vec3 n = vectorOf(results.normal);
  if (!found || !n.allFinite() || !(n.squaredNorm() > 0.5)) return {};
  return {a.outwards(n.normalized()), true};
}

}  // namespace pincer::contact
