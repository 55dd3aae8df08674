#include "pincer/contact/surface/edge_cubic.h"

namespace pincer::contact {

namespace {

// |nA x nB| below which the sides' cross product has no reliable direction: 3 degrees
constexpr double kParallel = 0.05;
constexpr double kSteepest = 0.3;  // T.g of a handle that still leads along the edge

// Unit tangent of a crease at one of its ends, along `g`.
Vec3 creaseTangent(const EdgeEnd& end, const Vec3& g) {
  const Vec3 cross = end.left.cross(end.right);
  const Vec3 mean = end.left + end.right;
  Vec3 T = g;
  if (cross.norm() > kParallel) {
    T = cross.normalized();
    if (T.dot(g) < 0) T = -T;
  } else if (mean.norm() > 1) {
    const Vec3 n = mean.normalized();
    T = (g - g.dot(n) * n).normalized();
  }
  return T.dot(g) > kSteepest ? T : g;
}

}  // namespace

EdgeHandles edgeHandles(const EdgeEnd& from, const EdgeEnd& to) {
  if (from.left == from.right && to.left == to.right) return smoothHandles(from.p, to.p, from.left, to.left);
  const double d = (to.p - from.p).norm();
  const Vec3 g = (to.p - from.p) / d;
  const auto handle = [&](const EdgeEnd& end) -> Vec3 {
    const Vec3 T = creaseTangent(end, g);
    return 2 * d / (3 * (1 + T.dot(g))) * T;
  };
  return {from.p + handle(from), to.p - handle(to)};
}

Vec3 middleNormalWithout(const Vec3&, const Vec3&, const Vec3& n0, const Vec3& n1) {
  const Vec3 sum = n0 + n1;
  return canMirror(1, sum.squaredNorm()) ? sum.normalized() : n0;
}

VecPair middleNormalWithout(const VecPair& p0, const VecPair& p1, const VecPair& n0, const VecPair& n1) {
  return {middleNormal(p0.first(), p1.first(), n0.first(), n1.first()),
          middleNormal(p0.second(), p1.second(), n0.second(), n1.second())};
}

}  // namespace pincer::contact
