#include "pincer/tasks/judge/exact/rigid_body.h"

#include <cmath>

#include "pincer/contact/functions/invariants.h"
#include "pincer/tasks/judge/exact/runge_kutta.h"

namespace pincer::exact {

Quat freeRotation(const Vec3& moments, const Vec3& w_B, double time) {
  PINCER_ASSERT(moments.minCoeff() > 0);
  using State = Eigen::Matrix<double, 7, 1>;  // (w, q as x y z w)
  const auto slope = [&](double, const State& y) {
    const Vec3 w = y.head<3>();
    const Quat spin(0, w.x(), w.y(), w.z());
    State dy;
    dy.head<3>() = moments.cwiseProduct(w).cross(w).cwiseQuotient(moments);
    dy.tail<4>() = 0.5 * (Quat(y.tail<4>()) * spin).coeffs();
    return dy;
  };
  const int steps = static_cast<int>(std::lround(time / 2e-5));
  State y;
  y << w_B, 0, 0, 0, 1;
  for (int i = 0; i < steps; ++i) y = rungeKutta(y, 0, time / steps, slope);
  return Quat(y.tail<4>()).normalized();
}

Quat symmetricTop(double I, double I3, const Vec3& w, double time) {
  const Vec3 L(I * w.x(), I * w.y(), I3 * w.z());
  return quatFromRotationVector(time / I * L) * quatFromRotationVector({0, 0, time * w.z() * (1 - I3 / I)});
}

double HeavyTop::slowPrecession(double angle) const {
  const double L3 = I3 * w3, c = math::cos(angle);
  PINCER_ASSERT(L3 * L3 >= 4 * I * mass * g * lever * c);  // slower tops fall
  return 2 * mass * g * lever / (L3 + std::sqrt(L3 * L3 - 4 * I * mass * g * lever * c));
}

Vec3 HeavyTop::axisAfter(double time, double angle, double heading_rate) const {
  const double L3 = I3 * w3, s0 = math::sin(angle), Lz = I * heading_rate * s0 * s0 + L3 * math::cos(angle);
  const auto slope = [&](double, const Vec3& y) {  // (a, a', f)
    const double s = math::sin(y[0]), c = math::cos(y[0]), rate = (Lz - L3 * c) / (I * s * s);
    return Vec3(y[1], rate * rate * s * c - L3 / I * rate * s + mass * g * lever / I * s, rate);
  };
  const int steps = static_cast<int>(std::lround(time / 2e-5));
  Vec3 y(angle, 0, 0);
  for (int i = 0; i < steps; ++i) y = rungeKutta(y, 0, time / steps, slope);
  return {math::sin(y[0]) * math::cos(y[2]), math::sin(y[0]) * math::sin(y[2]), math::cos(y[0])};
}

double precessionOfEulersDisk(double R, double b, double inclination, double g) {
  const double s = math::sin(inclination), c = math::cos(inclination);
  const double diameter = (3 * R * R + 4 * b * b) / 12, axis = R * R / 2;  // moments of inertia per mass
  return std::sqrt(g * (R * c - b * s) / (s * (diameter * c - axis * b / R * s)));
}

}  // namespace pincer::exact
