// Bullet's EPA, double precision, in units of the solids' size: its tolerances are absolute.
#include <BulletCollision/CollisionShapes/btConvexInternalShape.h>
#include <BulletCollision/NarrowPhaseCollision/btGjkEpa2.h>

#include "pincer/contact/shape/separation.h"

namespace pincer::contact {
namespace {

static_assert(sizeof(btScalar) == sizeof(double));

class CoreShape final : public btConvexInternalShape {
 public:
  CoreShape(const Shape& shape, double size) : shape_(shape), per_size_(1 / size) {
    m_shapeType = CUSTOM_CONVEX_SHAPE_TYPE;
    m_collisionMargin = 0;
  }
  btVector3 localGetSupportingVertexWithoutMargin(const btVector3& d) const override {
    const Vec3 direction(d.x(), d.y(), d.z());
    const Vec3 p = per_size_ * supportOf(shape_, direction);
    return {p.x(), p.y(), p.z()};
  }
  btVector3 localGetSupportingVertex(const btVector3& d) const override {
    return localGetSupportingVertexWithoutMargin(d);
  }
  void batchedUnitVectorGetSupportingVertexWithoutMargin(const btVector3* d, btVector3* out, int count) const override {
    for (int i = 0; i < count; ++i) out[i] = localGetSupportingVertexWithoutMargin(d[i]);
  }
  void calculateLocalInertia(btScalar, btVector3& inertia) const override { inertia.setZero(); }  // never asked
  const char* getName() const override { return "core"; }

 private:
  const Shape& shape_;
  double per_size_;
};

btTransform transformOf(const PosedSolid& s, double size) {
  const Mat3& R = s.R;
  const Vec3 p = s.p / size;
  return btTransform(btMatrix3x3(R(0, 0), R(0, 1), R(0, 2), R(1, 0), R(1, 1), R(1, 2), R(2, 0), R(2, 1), R(2, 2)),
                     btVector3(p.x(), p.y(), p.z()));
}

Vec3 vectorOf(const btVector3& v) { return {v.x(), v.y(), v.z()}; }

}  // namespace

DirectionGuess guessWayOut(const PosedSolid& a, const PosedSolid& b, double size) {
  const Vec3 between = a.inwards(a.p - b.p) / size;
  const btVector3 start(between.x(), between.y(), between.z());  // start and answer are in the frame of a
  const CoreShape core_a(a.shape, size), core_b(b.shape, size);
  btGjkEpaSolver2::sResults results;
  const bool found =
      btGjkEpaSolver2::Penetration(&core_a, transformOf(a, size), &core_b, transformOf(b, size), start, results, false);
  const Vec3 n = vectorOf(results.normal);
  if (!found || !n.allFinite() || !(n.squaredNorm() > 0.5)) return {};
  return {a.outwards(n.normalized()), true};
}

}  // namespace pincer::contact
