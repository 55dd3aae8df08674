// four_lanes: four boxes or balls with normal cones side by side, tested at once in single precision.
//
// The tests are those of normal_cone.h without square roots. Rounding is covered by what every distance is widened by
// (`widening`) and by kShare of every square, so that what the tests in double precision hold, these hold too.
#pragma once
#include <array>
#include <cstdint>

#include "pincer/contact/surface/normal_cone.h"
#include "pincer/contact/surface/outward_float.h"
#include "pincer/contact/surface/tolerances.h"

namespace pincer::contact {

constexpr int kLanes = 4;                              // numbers of single precision in 16 bytes
using Lanes = float __attribute__((vector_size(16)));  // one instruction for all four
using LaneMask = std::int32_t __attribute__((vector_size(16)));

inline Lanes inAllLanes(float x) { return Lanes{x, x, x, x}; }
inline Lanes greaterOf(Lanes a, Lanes b) { return a > b ? a : b; }

// A point that lanes are compared with.
struct LanesPoint {
  static constexpr float kShare = 1e-6f;  // of a square [-]: eight epsilons of single precision

  explicit LanesPoint(const Vec3& p) : x{toLanes(p[0]), toLanes(p[1]), toLanes(p[2])} {}
  static Lanes toLanes(double x) { return inAllLanes(static_cast<float>(x)); }

  std::array<Lanes, 3> x;  // [m]
};

struct LaneCones {
  std::array<Lanes, 3> axis;
  Lanes cosine, sine;  // as in FacingTest

  void set(int lane, const FacingTest& cone) {
    for (std::size_t k = 0; k < 3; ++k) axis[k][lane] = cone.axis[k];
    cosine[lane] = cone.cosine;
    sine[lane] = cone.sine;
  }
  FacingTest at(int lane) const {
    FacingTest cone;
    for (std::size_t k = 0; k < 3; ++k) cone.axis[k] = axis[k][lane];
    cone.cosine = cosine[lane];
    cone.sine = sine[lane];
    return cone;
  }
  // FacingTest::mayFace.
  LaneMask mayFace(Lanes along, Lanes distance2, Lanes R) const {
    const Lanes along2 = along * along, rounding = LanesPoint::kShare * distance2;
    const Lanes across2 = greaterOf(distance2 - along2, Lanes{});
    const Lanes reached = R + sine * along, cosine2 = cosine * cosine;
    const LaneMask inside = (distance2 <= R * R + rounding) | (cosine < 0);
    const LaneMask in_front = (along >= 0) | (sine * sine * across2 + rounding > cosine2 * along2);
    const LaneMask near = (reached >= 0) & (cosine2 * across2 <= reached * reached + rounding);
    return inside | (in_front & near);
  }
};

// Cones that lie within half of the angle at which two contacts count as two about one of up to three normals.
class ConesAlong {
 public:
  ConesAlong() = default;
  // Of those that aren't zero, which are unit.
  explicit ConesAlong(const std::array<Vec3, 3>& normals) {
    for (const Vec3& n : normals) {
      if (!n.isZero(0)) normals_[static_cast<std::size_t>(count_++)] = {toLanes(n[0]), toLanes(n[1]), toLanes(n[2])};
    }
  }
  LaneMask hold(const LaneCones& cones) const {
    if (count_ == 0) return LaneMask{};
    // cos(a - b) with a the angle given, b the cone's: the axis is no further off than a - b
    const Lanes least = kCosine * cones.cosine + kSine * cones.sine + 2 * LanesPoint::kShare;
    LaneMask held{};
    for (int i = 0; i < count_; ++i) {
      const auto& n = normals_[static_cast<std::size_t>(i)];
      held |= cones.axis[0] * n[0] + cones.axis[1] * n[1] + cones.axis[2] * n[2] >= least;
    }
    return held & (cones.cosine >= kCosine);
  }

 private:
  static constexpr float kCosine = static_cast<float>(kHalfApart), kSine = static_cast<float>(kHalfApartSine);
  static Lanes toLanes(double x) { return LanesPoint::toLanes(x); }

  std::array<std::array<Lanes, 3>, 3> normals_;
  int count_ = 0;
};

}  // namespace pincer::contact
