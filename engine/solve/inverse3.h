// inverse3: the inverse of a 3 x 3 block within a larger matrix, by its adjugate; a third of what elimination costs.
#pragma once
#include <cmath>

namespace pincer::engine {

// out = A^-1, row-major with `stride` and `out_stride` per row; out may be A. False, with out
// undefined, if A is singular or not finite.
template <int stride, int out_stride = stride>
[[gnu::always_inline]] inline bool invert3(const double* A, double* out) {
  const double* const a = A;
  const double* const b = A + stride;
  const double* const c = A + 2 * stride;
  const double bc[3] = {b[1] * c[2] - b[2] * c[1], b[2] * c[0] - b[0] * c[2], b[0] * c[1] - b[1] * c[0]};
  const double ca[3] = {c[1] * a[2] - c[2] * a[1], c[2] * a[0] - c[0] * a[2], c[0] * a[1] - c[1] * a[0]};
  const double ab[3] = {a[1] * b[2] - a[2] * b[1], a[2] * b[0] - a[0] * b[2], a[0] * b[1] - a[1] * b[0]};
  const double inverse = 1 / (a[0] * bc[0] + a[1] * bc[1] + a[2] * bc[2]);
  if (!std::isfinite(inverse)) return false;
  for (int i = 0; i < 3; ++i) {
    out[out_stride * i] = inverse * bc[i];
    out[out_stride * i + 1] = inverse * ca[i];
    out[out_stride * i + 2] = inverse * ab[i];
  }
  return true;
}

// The same of a symmetric A; nothing below its diagonal is read.
template <int stride, int out_stride = stride>
[[gnu::always_inline]] inline bool invertSymmetric3(const double* A, double* out) {
  const double a = A[0], b = A[1], c = A[2], d = A[stride + 1], e = A[stride + 2], f = A[2 * stride + 2];
  const double df = d * f - e * e, ec = e * c - b * f, be = b * e - d * c;
  const double inverse = 1 / (a * df + b * ec + c * be);
  if (!std::isfinite(inverse)) return false;
  out[0] = inverse * df;
  out[1] = out[out_stride] = inverse * ec;
  out[2] = out[2 * out_stride] = inverse * be;
  out[out_stride + 1] = inverse * (a * f - c * c);
  out[out_stride + 2] = out[2 * out_stride + 1] = inverse * (b * c - a * e);
  out[2 * out_stride + 2] = inverse * (a * d - b * b);
  return true;
}

}  // namespace pincer::engine
