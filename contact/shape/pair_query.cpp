#include "pincer/contact/pair_query.h"

#include <limits>

#include "pincer/contact/finger_query.h"
#include "pincer/contact/functions/invariants.h"
#include "pincer/contact/polytope.h"
#include "pincer/contact/shape/convex_features.h"
#include "pincer/contact/shape/convex_pairs.h"
#include "pincer/contact/shape/direction.h"
#include "pincer/contact/shape/extreme_points.h"
#include "pincer/contact/shape/mesh_mesh.h"
#include "pincer/contact/shape/mesh_pairs.h"
#include "pincer/contact/shape/point_choice.h"
#include "pincer/contact/shape/support.h"
#include "pincer/contact/smooth_mesh.h"

namespace pincer::contact {
namespace {

double radiusOf(const Sphere& s) { return s.radius; }
double radiusOf(const Box& b) { return b.half.norm(); }
double radiusOf(const Capsule& c) { return c.radius + c.half_length; }
double radiusOf(const Cylinder& c) { return std::sqrt(c.radius * c.radius + c.half_length * c.half_length); }
// the round part reaches as far
double radiusOf(const CylinderWithFlat& c) { return radiusOf(Cylinder{c.radius, c.half_length}); }
// no ball holds a half-space or dish
double radiusOf(const HalfSpace&) { return kInfinity; }
double radiusOf(const Dish&) { return kInfinity; }
double radiusOf(const Mesh& m) { return m.surface->boundingRadius(); }
double radiusOf(const Convex& c) { return c.hull->boundingRadius(); }

bool isSphere(const Shape& shape) { return std::holds_alternative<Sphere>(shape); }
bool isMesh(const Shape& shape) { return std::holds_alternative<Mesh>(shape); }
bool isSupport(const Shape& shape) {
  return std::holds_alternative<HalfSpace>(shape) || std::holds_alternative<Dish>(shape);
}

void addPoint(const PairPoint& point, PairPoints& out) {
  PINCER_ASSERT(out.count < kMaxPairPoints);
  out.points[out.count++] = point;
}

// n out of the support.
template <class Support>
void collideWithSupport(const Shape& solid, const SolidFrame& A, const Support& support, double margin,
                        const LastPoints& last, PairPoints& out) {
  // the others have 12 points at most
  if (isMesh(solid) && !(support.gap(Vec3::Zero()) - boundingRadius(solid) < margin)) return;
  ExtremePointStore store;
  const ExtremePoints extreme = extremePoints(solid, support.steepest(), store);
  const PointChoice choice(extreme, support, margin, last);
  for (int k = 0; k < choice.count(); ++k) {
    const auto [i, phi] = choice[k];
    const Vec3 n_W = support.normalInWorld(extreme.points[i], A);
    const Vec3 p_W = A.p_WA + A.toWorld(extreme.points[i]) - (extreme.rounding + 0.5 * phi) * n_W;
    addPoint({p_W, n_W, phi, extreme.featureOf(i)}, out);
  }
}

void collideWithSupport(const Shape& solid, const Pose& X_WA, const Shape& support, const Pose& X_WB, double margin,
                        const LastPoints& last, PairPoints& out) {
  const SolidFrame A(X_WA);
  if (const auto* dish = std::get_if<Dish>(&support))
    return collideWithSupport(solid, A, BowlSupport(*dish, X_WB, A), margin, last, out);
  collideWithSupport(solid, A, PlaneSupport(HalfSpace{}, X_WB, A), margin, last, out);
}

// Two spheres, and a sphere on a half-space, in the world: heaps of them are all that some scenes are. n out of b.
PairPoint betweenSpheres(const Sphere& a, const Vec3& p_WA, const Sphere& b, const Pose& X_WB) {
  const auto [n_W, length] = directionOf<Vec3>(p_WA - X_WB.p, X_WB.q * Vec3::UnitZ());
  const double phi = length - b.radius - a.radius;
  return {X_WB.p + (b.radius + 0.5 * phi) * n_W, n_W, phi, 0};
}

PairPoint onPlane(const Sphere& a, const Vec3& p_WA, const Pose& X_WB) {
  const Vec3 n_W = X_WB.q * Vec3::UnitZ();
  const double phi = n_W.dot(p_WA - X_WB.p) - a.radius;
  return {p_WA - (a.radius + 0.5 * phi) * n_W, n_W, phi, 0};
}

void addWithin(double margin, const PairPoint& point, PairPoints& out) {
  if (point.phi < margin) addPoint(point, out);
}

// n out of b.
void collideSphere(const Sphere& a, const Pose& X_WA, const Shape& b, const Pose& X_WB, double margin,
                   PatchCache& cache, PairPoints& out) {
  if (const auto* sphere = std::get_if<Sphere>(&b))
    return addWithin(margin, betweenSpheres(a, X_WA.p, *sphere, X_WB), out);
  if (std::holds_alternative<HalfSpace>(b)) return addWithin(margin, onPlane(a, X_WA.p, X_WB), out);
  const Vec3 p_BC = X_WB.q.conjugate() * (X_WA.p - X_WB.p);
  // a closed form costs no more than its bound
  if (isMesh(b) && !(lowerBoundOfGap(b, p_BC, a.radius) < margin)) return;
  SurfaceTracker whole_mesh;
  const SurfaceContact s = querySphere(b, p_BC, a.radius, margin, whole_mesh, cache).main();
  addWithin(margin, {X_WB * (s.p_BS + 0.5 * s.phi * s.n_B), X_WB.q * s.n_B, s.phi, 0}, out);
}

void flip(PairPoints& points) {
  for (int i = 0; i < points.count; ++i) points.points[i].n_W = -points.points[i].n_W;
}

}  // namespace

double boundingRadius(const Shape& shape) {
  return std::visit([](const auto& s) { return radiusOf(s); }, shape);
}

void preparePair(const Shape& a, const Shape& b) {
  const bool flat = !isSphere(a) && !isSphere(b) && !isSupport(a) && !isSupport(b);
  for (const Shape* shape : {&a, &b}) {
    if (flat && isMesh(*shape)) std::get<Mesh>(*shape).surface->features();
  }
}

void collideShapes(const Shape& a, const Pose& X_WA, const Shape& b, const Pose& X_WB, double margin, PatchCache& cache,
                   PairPoints& out, const LastPoints& last) {
  out.count = 0;
  if (isSupport(a) && isSupport(b)) return;
  PINCER_ASSERT(isUnitIfFinite(X_WA.q) && isUnitIfFinite(X_WB.q));
  PINCER_ASSERT(!(margin < 0));
  if (isSphere(a)) return collideSphere(std::get<Sphere>(a), X_WA, b, X_WB, margin, cache, out);
  if (isConvex(a) && isConvex(b) && !isSphere(b) && a.index() <= b.index())
    return collideConvex(a, X_WA, b, X_WB, margin, last, out);
  if (isMesh(a) && isConvex(b) && !isSphere(b))
    return collideMeshWithConvex(std::get<Mesh>(a), X_WA, b, X_WB, margin, last, cache, out);
  if (isMesh(a) && isMesh(b)) return collideMeshes(std::get<Mesh>(a), X_WA, std::get<Mesh>(b), X_WB, margin, last, out);
  if (isSupport(b)) return collideWithSupport(a, X_WA, b, X_WB, margin, last, out);
  collideShapes(b, X_WB, a, X_WA, margin, cache, out, last.flipped());
  flip(out);
}

}  // namespace pincer::contact
