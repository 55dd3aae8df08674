#include "pincer/contact/functions/invariants.h"
#include "pincer/contact/shape/closed_forms.h"
#include "pincer/contact/shape/direction.h"

namespace pincer::contact {
namespace {

Vec3 signsOf(const Vec3& v) { return {signOf(v.x()), signOf(v.y()), signOf(v.z())}; }

int indexOfLargest(const Vec3& v) {
  const int i = v.z() >= v.y() ? 2 : 1;
  return v[i] >= v.x() ? i : 0;
}

NearestPoint nearestFace(const Vec3& p_BC, const Vec3& beyond, const Vec3& signs) {
  const int i = indexOfLargest(beyond);
  NearestPoint s{p_BC, Vec3::Zero(), beyond[i]};
  s.p_BS[i] -= signs[i] * beyond[i];
  s.n_B[i] = signs[i];
  return s;
}

}  // namespace

NearestPoint nearestPoint(const Box& box, const Vec3& p_BC) {
  PINCER_ASSERT(box.half.minCoeff() > 0);
  const Vec3 signs = signsOf(p_BC);
  const Vec3 beyond = p_BC.cwiseAbs() - box.half;
  const Vec3 outside = signs.cwiseProduct(beyond.cwiseMax(0));
  const auto [n, distance] = directionOf<Vec3>(outside, Vec3::Zero());
  if (distance == 0) return nearestFace(p_BC, beyond, signs);
  return {p_BC - outside, n, distance};
}

}  // namespace pincer::contact
