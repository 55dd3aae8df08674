// normal_cone: all directions within an angle of an axis, for telling where a surface may face a point.
//
//   cone = { n : n . a >= cos alpha |n| },   a  unit axis, alpha <= 90 degrees;  wider ones hold every direction
//
// A ball of radius R about m, whose surface normals lie in the cone, may have a
// point x with C - x along its normal only if
//
//   |D| <= R,   or   angle(a, D) <= alpha + asin(R / |D|),   D = C - m
//
// for the angle between a and C - x is at least that between a and D, less asin(R / |D|). The
// latter is, with a . D and what D has across a,
//
//   cos alpha |D - (a . D) a| - sin alpha (a . D) <= R,   where angle(a, D) - alpha < 90 degrees
// Source: D. E. Johnson, E. Cohen, "Spatialized normal cone hierarchies", I3D 2001.
#pragma once
#include <algorithm>
#include <array>
#include <span>

#include "pincer/contact/math.h"

namespace pincer::contact {

struct NormalCone {
  Vec3 axis = Vec3::Zero();  // zero: every direction
  double cosine = -1;        // of alpha

  bool isFull() const { return cosine < 0; }
};

// The cone about the mean direction of `normals`, none of which need be unit.
inline NormalCone coneOf(std::span<const Vec3> normals) {
  Vec3 sum = Vec3::Zero();
  for (const Vec3& n : normals) sum += n;
  const double length = sum.norm();
  if (!(length > 0)) return {};
  const Vec3 axis = sum / length;
  double cosine = 1;
  for (const Vec3& n : normals) cosine = std::min(cosine, axis.dot(n) / n.norm());
  if (!(cosine >= 0)) return {};
  return {axis, cosine};
}

// A cone that holds both.
inline NormalCone joined(const NormalCone& a, const NormalCone& b) {
  if (a.isFull() || b.isFull()) return {};
  const Vec3 sum = a.axis + b.axis;
  const double length = sum.norm();
  if (!(length > 0)) return {};
  const Vec3 axis = sum / length;
  double cosine = 1;
  for (const NormalCone& part : {a, b}) {
    // of half the angle between the axes, which is at most 90 degrees
    const double c = std::clamp(axis.dot(part.axis), 0.0, 1.0);
    const double s = std::sqrt(1 - c * c), part_s = std::sqrt(std::max(0.0, 1 - part.cosine * part.cosine));
    cosine = std::min(cosine, c * part.cosine - s * part_s);
  }
  if (!(cosine >= 0)) return {};
  return {axis, cosine};
}

// The test above, in single precision, rounded outwards.
struct FacingTest {
  std::array<float, 3> axis;
  float cosine, sine;

  FacingTest() = default;
  explicit FacingTest(const NormalCone& cone) {
    // of the stored axis; it covers |D|, which is at most what D has across a, along it, and R
    constexpr double kRounding = 1e-6;
    for (int k = 0; k < 3; ++k) axis[static_cast<std::size_t>(k)] = static_cast<float>(cone.axis[k]);
    cosine = static_cast<float>(cone.cosine - kRounding);
    sine = static_cast<float>(std::sqrt(std::max(0.0, 1 - cone.cosine * cone.cosine)) + kRounding);
  }
  bool isFull() const { return cosine < 0; }
  // True if a point of the ball may face C; `along` = a.D, or -a.D for one that has C straight behind it.
  bool mayFace(double along, double distance2, double R) const {
    if (distance2 <= R * R || isFull()) return true;
    const double across = std::sqrt(std::max(0.0, distance2 - along * along));
    return cosine * along + sine * across > 0 && cosine * across - sine * along <= R;
  }
  // By how much the ball has to grow at least for that [m]: by as much as C has to move.
  double approach(double along, double distance2, double R) const {
    if (distance2 <= R * R || isFull()) return 0;
    const double across = std::sqrt(std::max(0.0, distance2 - along * along)), distance = std::sqrt(distance2);
    const double outside =
        cosine * along + sine * across > 0 ? std::min(distance, cosine * across - sine * along) : distance;
    return std::max(0.0, outside - R);
  }
};

}  // namespace pincer::contact
