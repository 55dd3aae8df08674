#include "pincer/contact/shape/wander.h"

#include <algorithm>
#include <cmath>

#include "pincer/contact/finger_query.h"

namespace pincer::contact {
namespace {

using Mat2 = Eigen::Matrix2d;

constexpr double kFurthest = 100;  // 1 / kappa: beyond, a place is flat; tilts then fade within seconds, chosen [m]

// 1 / kappa of the eigenvalue a; none where the surface is hollow: a flat pad doesn't stay there.
double radiusOf(double a, double h) {
  if (a * kFurthest < -1) return 0;
  return a * kFurthest > 1 ? std::max(1 / a - h, 0.0) : kFurthest;
}

}  // namespace

Mat3 wanderAt(const Shape& shape, const SurfaceContact& main, double r, double step, const SurfaceTracker& tracker,
              PatchCache& cache) {
  const Mat3 R = frameFromNormal(main.n_B);
  const double h = main.phi + r;
  const Vec3 c_B = main.p_BS + h * main.n_B;
  Mat2 A;
  for (int k = 0; k < 2; ++k) {
    SurfaceTracker beside = tracker;
    const Vec3 n_B = querySphere(shape, c_B + step * R.col(k), r, 0, beside, cache).main().n_B;
    A.col(k) = R.leftCols<2>().transpose() * (n_B - main.n_B) / step;
  }
  const double mean = 0.5 * (A(0, 0) + A(1, 1)), half = 0.5 * (A(0, 0) - A(1, 1)), shear = 0.5 * (A(0, 1) + A(1, 0));
  const double apart = std::sqrt(half * half + shear * shear);  // of the eigenvalues from their mean
  const double more = radiusOf(mean - apart, h), less = radiusOf(mean + apart, h);
  Mat2 unit = Mat2::Zero();  // e_1 e_1^T - e_2 e_2^T, of the larger eigenvalue first
  if (apart > 0) unit << half / apart, shear / apart, shear / apart, -half / apart;
  const Mat2 radii = 0.5 * (more + less) * Mat2::Identity() + 0.5 * (less - more) * unit;
  Eigen::Matrix<double, 3, 2> across;
  across << R.col(1), -R.col(0);  // n x t1, n x t2
  return across * radii * across.transpose();
}

}  // namespace pincer::contact
