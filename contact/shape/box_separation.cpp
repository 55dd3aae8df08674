// Two boxes: the separating axis theorem, all fifteen directions.
#include <cmath>
#include <limits>

#include "pincer/contact/shape/separation.h"
#include "pincer/contact/shape/tolerances.h"

namespace pincer::contact {

// Half widths along each axis are sums of |R_ij| half_j; edges nearly parallel add no direction of their own.
Separation separateBoxes(const PosedSolid& a, const PosedSolid& b) {
  constexpr double kBetterFace = 1e-10;  // of the size: faces win over edges that are no further apart
  const Vec3 half_a = std::get<Box>(a.shape).half, half_b = std::get<Box>(b.shape).half;
  const Vec3 d = a.p - b.p;
  const Mat3 C = a.R.transpose() * b.R;
  const Mat3 absC = C.cwiseAbs();
  const Vec3 d_a = a.inwards(d), d_b = b.inwards(d);
  Separation best;
  best.gap = -std::numeric_limits<double>::infinity();
  const double tolerance = kBetterFace * (half_a.maxCoeff() + half_b.maxCoeff());
  const auto offer = [&](const Vec3& n, double along, double gap) {
    if (gap > best.gap + tolerance) best = {along < 0 ? Vec3(-n) : n, gap};
  };
  for (int i = 0; i < 3; ++i) offer(b.R.col(i), d_b[i], std::abs(d_b[i]) - half_b[i] - absC.col(i).dot(half_a));
  for (int i = 0; i < 3; ++i) offer(a.R.col(i), d_a[i], std::abs(d_a[i]) - half_a[i] - absC.row(i).dot(half_b));
  for (int i = 0; i < 3; ++i) {
    const int i1 = (i + 1) % 3, i2 = (i + 2) % 3;
    for (int j = 0; j < 3; ++j) {
      const int j1 = (j + 1) % 3, j2 = (j + 2) % 3;
      const double sine2 = C(i1, j) * C(i1, j) + C(i2, j) * C(i2, j);
      if (!(sine2 > kNoAngle * kNoAngle)) continue;
      const double along = C(i1, j) * d_a[i2] - C(i2, j) * d_a[i1];  // (a_i x b_j) . d
      const double reach =
          half_a[i1] * absC(i2, j) + half_a[i2] * absC(i1, j) + half_b[j1] * absC(i, j2) + half_b[j2] * absC(i, j1);
      const double sine = std::sqrt(sine2);
      const double gap = (std::abs(along) - reach) / sine;
      if (gap > best.gap + tolerance) offer(a.R.col(i).cross(b.R.col(j)).normalized(), along, gap);
    }
  }
  return best;
}

}  // namespace pincer::contact
