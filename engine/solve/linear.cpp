#include "pincer/engine/solve/linear.h"

#include <cmath>
#include <type_traits>
#include <utility>

#include "pincer/contact/functions/invariants.h"

namespace pincer::engine {
namespace {

constexpr int kUsual = 6;

int pivotRow(const double* column, int k, int n) {
  int best = k;
  for (int i = k + 1; i < n; ++i)
    if (std::abs(column[i]) > std::abs(column[best])) best = i;
  return best;
}

void swapRows(double* A, int n, int i, int k) {
  if (i == k) return;
  for (int j = 0; j < n; ++j) std::swap(A[i + j * n], A[k + j * n]);
}

// y -= a x over rows [from, to)
void subtractScaled(double* y, double a, const double* x, int from, int to) {
  for (int i = from; i < to; ++i) y[i] -= a * x[i];
}

// In line for the six freedoms of a body, the size that nearly all have.
template <class Size>
[[gnu::always_inline]] inline bool factorise(double* A, Size n) {
  for (int k = 0; k < n; ++k) {
    double* const column = A + k * n;
    const double pivot = column[k];
    if (!(pivot > 0) || !std::isfinite(pivot)) return false;
    const double inverse = 1 / pivot;
    for (int j = k + 1; j < n; ++j) subtractScaled(A + j * n, column[j] * inverse, column, j, n);
    for (int i = k + 1; i < n; ++i) column[i] *= inverse;
  }
  return true;
}

template <class Size>
[[gnu::always_inline]] inline void solve(const double* LDLT, Size n, double* b) {
  for (int k = 0; k < n; ++k) {
    subtractScaled(b, b[k], LDLT + k * n, k + 1, n);
    b[k] /= LDLT[k + k * n];
  }
  for (int k = n - 1; k >= 0; --k) {
    for (int i = k + 1; i < n; ++i) b[k] -= LDLT[i + k * n] * b[i];
  }
}

}  // namespace

bool factoriseLu(double* A, int n, int* pivots) {
  for (int k = 0; k < n; ++k) {
    double* const column = A + k * n;
    pivots[k] = pivotRow(column, k, n);
    swapRows(A, n, pivots[k], k);
    const double pivot = column[k];
    if (!(std::abs(pivot) > 0) || !std::isfinite(pivot)) return false;
    const double inverse = 1 / pivot;
    for (int i = k + 1; i < n; ++i) column[i] *= inverse;
    for (int j = k + 1; j < n; ++j) subtractScaled(A + j * n, A[k + j * n], column, k + 1, n);
  }
  return true;
}

void solveLu(const double* LU, int n, const int* pivots, double* b) {
  for (int k = 0; k < n; ++k) {
    PINCER_ASSERT(k <= pivots[k] && pivots[k] < n);
    std::swap(b[k], b[pivots[k]]);
  }
  for (int k = 0; k < n; ++k) subtractScaled(b, b[k], LU + k * n, k + 1, n);
  for (int k = n - 1; k >= 0; --k) {
    b[k] /= LU[k + k * n];
    subtractScaled(b, b[k], LU + k * n, 0, k);
  }
}

bool factoriseLdlt(double* A, int n) {
  return n == kUsual ? factorise(A, std::integral_constant<int, kUsual>()) : factorise(A, n);
}

void solveLdlt(const double* LDLT, int n, double* b) {
  n == kUsual ? solve(LDLT, std::integral_constant<int, kUsual>(), b) : solve(LDLT, n, b);
}

}  // namespace pincer::engine
