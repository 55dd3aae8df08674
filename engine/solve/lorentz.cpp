#include "pincer/engine/solve/lorentz.h"

namespace pincer::engine {

double stepToBoundary(const double* v, const double* dv, int rows) {
  // det(v + t dv) = c + 2 b t + a t^2, c > 0; its smallest positive root, written so that nothing cancels
  const double a = dv[kNormalRow] * dv[kNormalRow] - tangentNorm2(dv, rows);
  const double b = v[kNormalRow] * dv[kNormalRow] - tangentDot(v, dv, rows);
  const double norm = lorentzNorm(v, rows);
  const double c = norm * norm;
  const double discriminant = b * b - a * c;
  double t = 1e3;
  if (discriminant >= 0) {
    const double root = b > 0 ? -(b + std::sqrt(discriminant)) : -b + std::sqrt(discriminant);
    for (const double candidate : {root / a, c / root})
      if (candidate > 0) t = std::min(t, candidate);
  }
  if (dv[kNormalRow] < 0) t = std::min(t, -v[kNormalRow] / dv[kNormalRow]);
  return t;
}

NesterovTodd::NesterovTodd(const double* x, const double* z, int rows) {
  const double x_norm = lorentzNorm(x, rows);
  const double z_norm = lorentzNorm(z, rows);
  beta = std::sqrt(z_norm / x_norm);
  const double cosine = (tangentDot(x, z, rows) + x[kNormalRow] * z[kNormalRow]) / (x_norm * z_norm);
  const double inverse = 1 / (2 * std::sqrt(0.5 * (1 + cosine)));
  for (int k = 0; k < rows; ++k) v[k] = (z[k] / z_norm - x[k] / x_norm) * inverse;
  v[kNormalRow] = (z[kNormalRow] / z_norm + x[kNormalRow] / x_norm) * inverse + 1;
  const double half = 1 / std::sqrt(2 * v[kNormalRow]);
  for (int k = 0; k < rows; ++k) v[k] *= half;
}

void NesterovTodd::apply(const double* a, int rows, double* Na) const {
  const double along = 2 * (tangentDot(v, a, rows) + v[kNormalRow] * a[kNormalRow]);
  const double normal = beta * (along * v[kNormalRow] - a[kNormalRow]);
  for (int k = 0; k < rows; ++k) Na[k] = beta * (along * v[k] + a[k]);
  Na[kNormalRow] = normal;
}

void NesterovTodd::applyInverse(const double* a, int rows, double* Na) const {
  const double along = 2 * (v[kNormalRow] * a[kNormalRow] - tangentDot(v, a, rows));
  const double normal = (along * v[kNormalRow] - a[kNormalRow]) / beta;
  for (int k = 0; k < rows; ++k) Na[k] = (a[k] - along * v[k]) / beta;
  Na[kNormalRow] = normal;
}

}  // namespace pincer::engine
