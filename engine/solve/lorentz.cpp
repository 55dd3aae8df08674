#include "pincer/engine/solve/lorentz.h"

namespace pincer::engine {
namespace {

[[gnu::always_inline]] inline double stepOf(const double* v, const double* dv, int rows) {
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

}  // namespace

double stepToBoundary(const double* v, const double* dv, int rows) {
  double step = 0;
  withRows(rows, [&](auto count) { step = stepOf(v, dv, count); });
  return step;
}

}  // namespace pincer::engine
